// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/http_head.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// The status of a refusal; 0: the head is taken.
int refused(const std::string& head) {
  const auto parsed = parse_head(head);
  const auto* refusal = std::get_if<HttpReply>(&parsed);
  if (refusal != nullptr) {
    EXPECT_TRUE(refusal->ends_connection) << head;
  }
  return refusal ? refusal->status : 0;
}

int refused_with(const std::string& headers, const std::string& first = "POST /a HTTP/1.1") {
  return refused(first + "\r\nHost: localhost\r\n" + headers + "\r\n");
}

TEST(HttpHeadTest, ReadsARequest) {
  const auto parsed = parse_head(
      "POST /api/in%20stances/%zz?level=1&name=a+b%2B&&flag&level=2 HTTP/1.1\r\nHost: localhost\r\n"
      "X-Name:  a b \r\nContent-Length: 12\r\n\r\n");
  const auto& request = std::get<HttpRequest>(parsed);
  EXPECT_EQ(request.method, "POST");
  EXPECT_EQ(request.path, "/api/in stances/%zz");
  EXPECT_EQ(request.query.at("level"), "1");
  EXPECT_EQ(request.query.at("name"), "a b+");
  EXPECT_EQ(request.query.at("flag"), "");
  EXPECT_EQ(request.parameters.count("level"), 2u) << "the first counts where one is wanted";
  EXPECT_EQ(request.header("x-name"), "a b");
  EXPECT_EQ(request.content_length, 12u);
  EXPECT_TRUE(request.keep_alive);
}

TEST(HttpHeadTest, OldClientsGetOneReply) {
  const auto parsed = parse_head("GET / HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
  EXPECT_FALSE(std::get<HttpRequest>(parsed).keep_alive);
  EXPECT_FALSE(std::get<HttpRequest>(parsed).chunks);
}

TEST(HttpHeadTest, RefusesWhatOthersCouldReadInAnotherWay) {
  EXPECT_EQ(refused_with("Content-Length: 5\r\n"), 0);
  EXPECT_EQ(refused_with("Content-Length: 5\r\nContent-Length: 5\r\n"), 400);
  EXPECT_EQ(refused_with("Content-Length: 5\r\nContent-Length: 6\r\n"), 400);
  EXPECT_EQ(refused_with("Content-Length: 5, 5\r\n"), 400);
  EXPECT_EQ(refused_with("Content-Length: +5\r\n"), 400);
  EXPECT_EQ(refused_with("Content-Length: -5\r\n"), 400);
  EXPECT_EQ(refused_with("Content-Length:\r\n"), 400);
  EXPECT_EQ(refused_with("Content-Length: 99999999999999999999999\r\n"), 400);
  EXPECT_EQ(refused_with("Content-Length: 5\r\nTransfer-Encoding: chunked\r\n"), 400);
  EXPECT_EQ(refused_with("Transfer-Encoding: chunked\r\nContent-Length: 5\r\n"), 400);
  EXPECT_EQ(refused_with("Transfer-Encoding: chunked\r\n"), 411);
  EXPECT_EQ(refused_with("Transfer-Encoding: xchunked\r\n"), 411);
  EXPECT_EQ(refused_with("Host: other\r\n"), 400);
  EXPECT_EQ(refused("GET / HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(refused_with("X : a\r\n"), 400);
  EXPECT_EQ(refused_with("X: a\r\n folded\r\n"), 400);
  EXPECT_EQ(refused_with("X: a\rb\r\n"), 400);
  EXPECT_EQ(refused_with("X: a\nY: b\r\n"), 400);
  EXPECT_EQ(refused_with(std::string("X: a\0b\r\n", 8)), 400);
  EXPECT_EQ(refused_with("no colon\r\n"), 400);
  EXPECT_EQ(refused_with(": a\r\n"), 400);
}

TEST(HttpHeadTest, BodiesDoNotGoWithGet) {
  for (const char* method : {"GET", "HEAD"}) {
    EXPECT_EQ(refused_with("Content-Length: 5\r\n", method + std::string(" / HTTP/1.1")), 400);
    EXPECT_EQ(refused_with("Content-Length: 0\r\n", method + std::string(" / HTTP/1.1")), 0);
  }
}

TEST(HttpHeadTest, KnowsItsVersions) {
  EXPECT_EQ(refused_with("", "GET / HTTP/2.0"), 505);
  EXPECT_EQ(refused_with("", "GET / HTTP/9.9"), 505);
  EXPECT_EQ(refused_with("", "GET /"), 400);
  EXPECT_EQ(refused_with("", "GET http://localhost/ HTTP/1.1"), 400);
  EXPECT_NE(refused("PRI * HTTP/2.0\r\n\r\n"), 0);
  EXPECT_NE(refused("\r\n\r\n"), 0);
  EXPECT_NE(refused(""), 0);
}

TEST(HttpHeadTest, HeadsAreBounded) {
  const HeadLimits limits;
  EXPECT_EQ(refused_with("", "GET /" + std::string(limits.line_bytes, 'a') + " HTTP/1.1"), 414);
  EXPECT_EQ(refused_with("X: " + std::string(limits.bytes, 'a') + "\r\n"), 431);
  std::string many;
  for (std::size_t i = 0; i < limits.headers; ++i) many += "X: a\r\n";
  EXPECT_EQ(refused_with(many), 431);
  EXPECT_FALSE(refusal_of_unfinished("GET / HTTP/1.1\r\nX: a", limits));
  EXPECT_EQ(refusal_of_unfinished(std::string(limits.line_bytes, 'a'), limits)->status, 414);
  const std::string line = "GET / HTTP/1.1\r\n";
  EXPECT_EQ(refusal_of_unfinished(line + std::string(limits.bytes, 'a'), limits)->status, 431);
  EXPECT_EQ(refusal_of_unfinished(line + many + many, limits)->status, 431);
}

TEST(HttpHeadTest, EncodesWhatAddressesCannotHold) {
  const std::string token = "a b&c=d%e#f;g\"h\\i/j?k~l";
  const std::string encoded = percent_encoded(token);
  EXPECT_EQ(encoded.find_first_of(" &=#;\"\\/?"), std::string::npos);
  EXPECT_EQ(percent_decoded(encoded), token);
  EXPECT_EQ(percent_decoded("%4"), "%4");
  EXPECT_EQ(percent_decoded("%+1%-1%0x"), "%+1%-1%0x");
}

TEST(HttpHeadTest, WritesReplies) {
  const HttpReply reply = text_reply(200, "text/plain", "abc");
  EXPECT_EQ(reply_head(reply, {}, true),
            "HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 3\r\n"
            "Connection: keep-alive\r\n\r\n");
}

}  // namespace
}  // namespace ovimap
