// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/access.h"

#include <gtest/gtest.h>

#include <set>

namespace ovimap {
namespace {

HttpRequest request_of(std::map<std::string, std::string> headers, const std::string& path = "/") {
  HttpRequest request;
  request.method = "GET";
  request.path = path;
  request.headers = std::move(headers);
  return request;
}

int refused(const AccessRule& rule, const HttpRequest& request) {
  const auto refusal = rule.refusal(request);
  return refusal ? refusal->status : 0;
}

TEST(AccessRuleTest, WithoutTokenOnlyThisMachineIsAnswered) {
  const AccessRule open("");
  EXPECT_EQ(refused(open, request_of({{"host", "127.0.0.1:8080"}})), 0);
  EXPECT_EQ(refused(open, request_of({{"host", "localhost:8080"}})), 0);
  EXPECT_EQ(refused(open, request_of({{"host", "[::1]:8080"}})), 0);
  EXPECT_EQ(refused(open, request_of({{"host", "rebound.example:8080"}})), 403);
  EXPECT_EQ(refused(open, request_of({})), 403);
}

TEST(AccessRuleTest, OtherPagesAreRefused) {
  const AccessRule open("");
  EXPECT_EQ(
      refused(open, request_of({{"host", "127.0.0.1:80"}, {"origin", "http://evil.example"}})),
      403);
  EXPECT_EQ(refused(open, request_of({{"host", "127.0.0.1:80"}, {"origin", "null"}})), 403);
  EXPECT_EQ(
      refused(open, request_of({{"host", "127.0.0.1:80"}, {"origin", "http://127.0.0.1:80"}})), 0);
}

TEST(AccessRuleTest, TheTokenIsDemanded) {
  const AccessRule rule("secret");
  const std::string host = "192.168.1.5:8080";
  EXPECT_EQ(refused(rule, request_of({{"host", host}})), 401);
  EXPECT_EQ(refused(rule, request_of({{"host", host}, {"authorization", "Bearer secret"}})), 0);
  EXPECT_EQ(refused(rule, request_of({{"host", host}, {"authorization", "Bearer secre"}})), 401);
  EXPECT_EQ(refused(rule, request_of({{"host", host}, {"authorization", "Bearer secret2"}})), 401);
  EXPECT_EQ(refused(rule, request_of({{"host", host}, {"cookie", "a=b; ovimap_token=secret"}})), 0);
  EXPECT_EQ(refused(rule, request_of({{"host", host}, {"cookie", "xovimap_token=secret"}})), 401);
  EXPECT_EQ(refused(rule, request_of({{"host", host}, {"cookie", "ovimap_token="}})), 401);
}

TEST(AccessRuleTest, TheAddressWithTheTokenSetsACookie) {
  const AccessRule rule("secret");
  HttpRequest request = request_of({{"host", "h"}});
  request.query["token"] = "secret";
  const auto reply = rule.refusal(request);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->status, 303);
  EXPECT_NE(reply->headers.at("Set-Cookie").find("HttpOnly"), std::string::npos);
  request.path = "/api/map";
  EXPECT_EQ(refused(rule, request), 401);
  request.path = "/";
  request.query["token"] = "wrong";
  EXPECT_EQ(refused(rule, request), 401);
}

TEST(AccessRuleTest, TokensAreLongAndNew) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(random_token());
  EXPECT_EQ(tokens.size(), 100u);
  EXPECT_EQ(tokens.begin()->size(), 32u);
}

TEST(AccessRuleTest, KnowsLoopback) {
  for (const char* host : {"127.0.0.1", "localhost", "::1", "127.1.2.3"})
    EXPECT_TRUE(is_loopback(host)) << host;
  for (const char* host : {"0.0.0.0", "::", "192.168.0.1", "", "localhost.example"})
    EXPECT_FALSE(is_loopback(host)) << host;
}

TEST(RateLimitTest, AdmitsABurstAndThenARate) {
  RateLimit limit(10, 5);
  const RateLimit::Clock::time_point start{};
  int admitted = 0;
  for (int i = 0; i < 20; ++i) admitted += limit.admits("a", start);
  EXPECT_EQ(admitted, 5);
  EXPECT_TRUE(limit.admits("b", start));
  EXPECT_FALSE(limit.admits("a", start + std::chrono::milliseconds(50)));
  EXPECT_TRUE(limit.admits("a", start + std::chrono::milliseconds(150)));
  for (int i = 0; i < 10000; ++i) limit.admits(std::to_string(i), start);  // forgets, and goes on
  EXPECT_TRUE(limit.admits("c", start + std::chrono::hours(1)));
}

}  // namespace
}  // namespace ovimap
