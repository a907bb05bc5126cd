// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Encrypted connections, with a certificate made for the test.
#include <gtest/gtest.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <csignal>

#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/server/front/server_fixture.h"

namespace ovimap {
namespace {

template <auto kFree>
struct Freed {
  template <class Thing>
  void operator()(Thing* thing) const {
    kFree(thing);
  }
};
using Key = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Freed<X509_free>>;
using File = std::unique_ptr<FILE, Freed<std::fclose>>;

/// A key, and a certificate for localhost that it signs itself, in PEM files.
void write_certificate(const std::filesystem::path& certificate, const std::filesystem::path& key) {
  const Key own(EVP_EC_gen("P-256"));
  const Certificate made(X509_new());
  X509_set_version(made.get(), 2);
  ASN1_INTEGER_set(X509_get_serialNumber(made.get()), 1);
  X509_gmtime_adj(X509_getm_notBefore(made.get()), -3600);
  X509_gmtime_adj(X509_getm_notAfter(made.get()), 3600);
  X509_set_pubkey(made.get(), own.get());
  X509_NAME* name = X509_get_subject_name(made.get());
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>("localhost"), -1, -1, 0);
  X509_set_issuer_name(made.get(), name);
  X509_sign(made.get(), own.get(), EVP_sha256());
  PEM_write_X509(File(std::fopen(certificate.c_str(), "w")).get(), made.get());
  PEM_write_PrivateKey(File(std::fopen(key.c_str(), "w")).get(), own.get(), nullptr, nullptr, 0,
                       nullptr, nullptr);
}

/// A client that trusts the certificate and nothing else.
class TlsClient {
 public:
  TlsClient(int port, const std::filesystem::path& trusted, int newest = TLS1_3_VERSION)
      : context_(SSL_CTX_new(TLS_client_method())) {
    SSL_CTX_load_verify_locations(context_.get(), trusted.c_str(), nullptr);
    SSL_CTX_set_verify(context_.get(), SSL_VERIFY_PEER, nullptr);
    SSL_CTX_set_security_level(context_.get(), 0);  // old versions are refused by the server alone
    SSL_CTX_set_max_proto_version(context_.get(), newest);
    connection_.reset(BIO_new_ssl_connect(context_.get()));
    BIO_set_conn_hostname(connection_.get(), ("127.0.0.1:" + std::to_string(port)).c_str());
    connected_ = BIO_do_connect(connection_.get()) == 1 && BIO_do_handshake(connection_.get()) == 1;
  }

  bool connected() const { return connected_; }
  std::optional<fixture::HttpAnswer> get(const std::string& path) {
    const std::string request =
        "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    BIO_write(connection_.get(), request.data(), static_cast<int>(request.size()));
    std::string bytes, piece(1 << 14, '\0');
    for (int count = 1; count > 0;) {
      count = BIO_read(connection_.get(), piece.data(), static_cast<int>(piece.size()));
      bytes.append(piece, 0, static_cast<std::size_t>(std::max(count, 0)));
      const auto answer = fixture::parsed_answer(bytes);
      if (answer && answer->body.size() >= std::stoul(answer->field("content-length"))) break;
    }
    return fixture::parsed_answer(bytes);
  }

 private:
  std::unique_ptr<SSL_CTX, Freed<SSL_CTX_free>> context_;
  std::unique_ptr<BIO, Freed<BIO_free_all>> connection_;
  bool connected_ = false;
};

class TlsTest : public MapFolder {
 protected:
  TlsTest() {
    std::signal(SIGPIPE, SIG_IGN);  // OpenSSL's clients write to sockets that may be closed
    save_map(root_ / "room.ovimap", random_document(40, 3));
    write_certificate(certificate_, key_);
    config_.tls_certificate = certificate_;
    config_.tls_key = key_;
    served_.encoder = "none";
  }

  const std::filesystem::path certificate_ = root_ / "cert.pem", key_ = root_ / "key.pem";
  ServerConfig config_;
  ServedMapConfig served_;
};

TEST_F(TlsTest, AnswersOverTls) {
  config_.token = "secret";
  fixture::RunningServer running(root_ / "room.ovimap", config_, served_);
  EXPECT_TRUE(running.server().address().starts_with("https://"));
  EXPECT_EQ(TlsClient(running.port(), certificate_).get("/api/map")->status, 401);
  const auto opened = TlsClient(running.port(), certificate_).get("/?token=secret");
  EXPECT_EQ(opened->status, 303);
  EXPECT_NE(opened->field("set-cookie").find("; Secure"), std::string::npos);
  EXPECT_TRUE(TlsClient(running.port(), certificate_, TLS1_2_VERSION).connected());
  EXPECT_FALSE(TlsClient(running.port(), certificate_, TLS1_1_VERSION).connected());
  const fixture::RawConnection plain(running.port());
  plain.send("GET /api/map HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_FALSE(plain.receive_all().starts_with("HTTP/"));
}

TEST_F(TlsTest, SaysWhatIsWrongWithTheCertificate) {
  ServedMap map(root_ / "room.ovimap", served_);
  config_.port = 0;
  EXPECT_GT(HttpServer(map, config_).port(), 0);
  config_.tls_key = root_ / "room.ovimap";
  EXPECT_NE(fault_of([&] { HttpServer(map, config_); }).find("room.ovimap"), std::string::npos);
  config_.tls_key = "";
  EXPECT_NE(fault_of([&] { HttpServer(map, config_); }).find("--tls-key"), std::string::npos);
  config_.tls_certificate = config_.tls_key = root_ / "none.pem";
  EXPECT_NE(fault_of([&] { HttpServer(map, config_); }).find("none.pem"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
