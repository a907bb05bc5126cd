// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/http_io.h"

#include <utility>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Fault = boost::system::error_code;
using TlsStream = asio::ssl::stream<tcp::socket>;

constexpr std::chrono::milliseconds kPauseWithoutFiles{100};

/// "1.2.3.4" also for a client that comes to a socket of both kinds.
std::string text_of(const tcp::endpoint& client) {
  const asio::ip::address address = client.address();
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).to_string();
  return address.to_string();
}

auto ending_in(Wire::Done done) {
  return [done = std::move(done)](Fault fault, std::size_t bytes = 0) { done(!fault, bytes); };
}

template <class Stream>
class SocketWire : public Wire {
 public:
  SocketWire(Stream stream, std::string address)
      : stream_(std::move(stream)),
        deadline_(stream_.get_executor()),
        address_(std::move(address)) {}

  void shake_hands(Done done) override {
    if constexpr (kEncrypted)
      stream_.async_handshake(asio::ssl::stream_base::server, ending_in(std::move(done)));
    else
      asio::post(stream_.get_executor(), [done = std::move(done)] { done(true, 0); });
  }
  void read_some(std::span<char> into, Done done) override {
    stream_.async_read_some(asio::buffer(into.data(), into.size()), ending_in(std::move(done)));
  }
  void wait_for_end(std::function<void()> gone) override {
    stream_.lowest_layer().async_wait(tcp::socket::wait_read,
                                      [this, gone = std::move(gone)](Fault fault) {
                                        if (!fault && has_ended()) gone();
                                      });
  }
  void write(std::string_view first, std::string_view second, Done done) override {
    const std::array<asio::const_buffer, 2> both = {asio::buffer(first), asio::buffer(second)};
    asio::async_write(stream_, both, ending_in(std::move(done)));
  }
  void end_sending(Done done) override {
    // TLS has no half: a body still on its way would be a fault after our ending.
    Fault ignored;
    if constexpr (!kEncrypted) stream_.shutdown(tcp::socket::shutdown_send, ignored);
    asio::post(stream_.get_executor(), [done = std::move(done)] { done(true, 0); });
  }
  void close() override {
    Fault ignored;
    clear_deadline();
    stream_.lowest_layer().close(ignored);
  }
  void set_deadline(std::chrono::milliseconds time, std::function<void()> late) override {
    deadline_.expires_after(time);
    // One that ran out already cannot be cancelled, but counts no more.
    deadline_.async_wait([this, number = ++deadlines_, late = std::move(late)](Fault fault) {
      if (!fault && number == deadlines_) late();
    });
  }
  void clear_deadline() override {
    deadline_.cancel();
    ++deadlines_;
  }
  const std::string& remote_address() const override { return address_; }

 private:
  static constexpr bool kEncrypted = std::is_same_v<Stream, TlsStream>;

  /// Of a socket that has something to say: its end or a fault.
  bool has_ended() {
    char byte = 0;
    const ssize_t got =
        ::recv(stream_.lowest_layer().native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
  }

  Stream stream_;
  asio::steady_timer deadline_;
  const std::string address_;
  std::uint64_t deadlines_ = 0;
};

asio::ssl::context tls_of(const IoConfig& config) {
  asio::ssl::context tls(asio::ssl::context::tls_server);
  tls.set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_sslv3 |
                  asio::ssl::context::no_tlsv1 | asio::ssl::context::no_tlsv1_1);
  SSL_CTX_set_mode(tls.native_handle(), SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_options(tls.native_handle(), SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
  Fault fault;
  tls.use_certificate_chain_file(config.certificate.string(), fault);
  if (fault)
    throw Error(concat("'", config.certificate.string(), "' is no certificate in PEM (",
                       fault.message(), ")"));
  tls.use_private_key_file(config.key.string(), asio::ssl::context::pem, fault);
  if (fault)
    throw Error(concat("'", config.key.string(), "' is not the private key of '",
                       config.certificate.string(), "' in PEM (", fault.message(), ")"));
  return tls;
}

}  // namespace

struct IoLoop::Sockets {
  explicit Sockets(const IoConfig& config) {
    if (!config.certificate.empty()) tls = std::make_unique<asio::ssl::context>(tls_of(config));
    listen(config);
  }

  void listen(const IoConfig& config) {
    Fault fault;
    tcp::resolver resolver(io);
    const bool bracketed = config.host.starts_with('[') && config.host.ends_with(']');
    const auto found =
        resolver.resolve(bracketed ? config.host.substr(1, config.host.size() - 2) : config.host,
                         std::to_string(config.port),
                         tcp::resolver::passive | tcp::resolver::numeric_service, fault);
    for (const auto& entry : found)
      if (try_to_listen(entry.endpoint())) return;
    throw Error(concat("cannot listen at ", config.host, ":", config.port,
                       "; the port is taken, or the host is none of this machine's: try --port 0 "
                       "for a free one"));
  }

  bool try_to_listen(const tcp::endpoint& at) {
    Fault fault, ignored;
    acceptor.close(ignored);
    acceptor.open(at.protocol(), fault);
    if (at.address().is_v6()) acceptor.set_option(asio::ip::v6_only(false), ignored);
    if (!fault) acceptor.set_option(tcp::acceptor::reuse_address(true), fault);
    if (!fault) acceptor.bind(at, fault);
    if (!fault) acceptor.listen(tcp::acceptor::max_listen_connections, fault);
    if (!fault) port = acceptor.local_endpoint(fault).port();
    return !fault;
  }

  void accept() {
    acceptor.async_accept([this](Fault fault, tcp::socket socket) {
      if (!acceptor.is_open()) return;
      if (!fault) hand_over(std::move(socket));
      if (!fault || fault == asio::error::connection_aborted) return accept();
      pause.expires_after(kPauseWithoutFiles);  // until others are closed
      pause.async_wait([this](Fault) {
        if (acceptor.is_open()) accept();
      });
    });
  }

  void hand_over(tcp::socket socket) {
    Fault fault;
    const tcp::endpoint client = socket.remote_endpoint(fault);
    if (fault) return;  // gone already
    socket.set_option(tcp::no_delay(true), fault);
    if (tls)
      accepted(std::make_unique<SocketWire<TlsStream>>(TlsStream(std::move(socket), *tls),
                                                       text_of(client)));
    else
      accepted(std::make_unique<SocketWire<tcp::socket>>(std::move(socket), text_of(client)));
  }

  asio::io_context io{1};
  std::unique_ptr<asio::ssl::context> tls;
  tcp::acceptor acceptor{io};
  int port = 0;
  asio::steady_timer pause{io};
  std::function<void(std::unique_ptr<Wire>)> accepted;
};

IoLoop::IoLoop(const IoConfig& config) : sockets_(std::make_unique<Sockets>(config)) {}

IoLoop::~IoLoop() = default;

int IoLoop::port() const {
  return sockets_->port;
}

void IoLoop::run(std::function<void(std::unique_ptr<Wire>)> accepted) {
  sockets_->accepted = std::move(accepted);
  sockets_->accept();
  sockets_->io.run();
}

void IoLoop::post(std::function<void()> job) {
  asio::post(sockets_->io, std::move(job));
}

std::shared_ptr<void> IoLoop::stay() {
  return std::make_shared<asio::executor_work_guard<asio::io_context::executor_type>>(
      sockets_->io.get_executor());
}

void IoLoop::stop_accepting() {
  Fault ignored;
  sockets_->acceptor.close(ignored);
  sockets_->pause.cancel();
}

}  // namespace ovimap
