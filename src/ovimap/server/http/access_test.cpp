// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/access.h"

#include <gtest/gtest.h>

#include <set>

#include "ovimap/base/error.h"

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
  const AccessRule open({});
  EXPECT_EQ(refused(open, request_of({{"host", "127.0.0.1:8080"}})), 0);
  EXPECT_EQ(refused(open, request_of({{"host", "localhost:8080"}})), 0);
  EXPECT_EQ(refused(open, request_of({{"host", "[::1]:8080"}})), 0);
  EXPECT_EQ(refused(open, request_of({{"host", "rebound.example:8080"}})), 403);
  EXPECT_EQ(refused(open, request_of({})), 403);
}

TEST(AccessRuleTest, NamesThatOnlyLookLocalAreRefused) {
  const AccessRule open({.token = "", .host_names = {"map.example"}});
  for (const char* host : {"127.0.0.1.rebind.example",
                           "127.0.0.1.rebind.example:80",
                           "[::1].evil",
                           "[::1]evil:80",
                           "127.0.0.1@evil.example",
                           "localhost.evil.example",
                           "127.evil.example",
                           "127.1",
                           "[::1",
                           "::1",
                           "[127.0.0.1]",
                           "localhost:",
                           "localhost:80x",
                           "localhost:80:80",
                           "localhost:123456",
                           " localhost",
                           "",
                           "0.0.0.0",
                           "xmap.example",
                           "map.example.evil"})
    EXPECT_EQ(refused(open, request_of({{"host", host}})), 403) << host;
  for (const char* host : {"LocalHost", "127.9.8.7:1", "[::1]", "[0:0:0:0:0:0:0:1]:80",
                           "map.example", "MAP.example:8080"})
    EXPECT_EQ(refused(open, request_of({{"host", host}})), 0) << host;
}

TEST(AccessRuleTest, OtherPagesAreRefused) {
  const AccessRule open({});
  EXPECT_EQ(
      refused(open, request_of({{"host", "127.0.0.1:80"}, {"origin", "http://evil.example"}})),
      403);
  EXPECT_EQ(refused(open, request_of({{"host", "127.0.0.1:80"}, {"origin", "null"}})), 403);
  EXPECT_EQ(
      refused(open, request_of({{"host", "127.0.0.1:80"}, {"origin", "http://127.0.0.1:80"}})), 0);
}

TEST(AccessRuleTest, WhatBrowsersSayOfOtherPagesCounts) {
  const AccessRule open({});
  const auto asked = [&](const char* site, const char* mode, const char* path) {
    return refused(
        open,
        request_of({{"host", "localhost:8080"}, {"sec-fetch-site", site}, {"sec-fetch-mode", mode}},
                   path));
  };
  EXPECT_EQ(asked("cross-site", "no-cors", "/api/export.glb"), 403);
  EXPECT_EQ(asked("same-site", "no-cors", "/api/rooms"), 403);  // another port of this machine
  EXPECT_EQ(asked("cross-site", "navigate", "/api/rooms"), 403);
  EXPECT_EQ(asked("cross-site", "navigate", "/"), 0) << "a link to the page is followed";
  EXPECT_EQ(asked("same-origin", "cors", "/api/rooms"), 0);
  EXPECT_EQ(asked("none", "navigate", "/api/rooms"), 0) << "typed by a person";
}

TEST(AccessRuleTest, TheTokenIsDemanded) {
  const AccessRule rule({.token = "secret", .host_names = {}});
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
  const AccessRule rule({.token = "secret", .host_names = {}});
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

TEST(AccessRuleTest, AnyTokenFitsIntoItsCookie) {
  const std::string token = "a;b c\"%41,d";
  const AccessRule rule({.token = token, .host_names = {}, .encrypted = true});
  HttpRequest request = request_of({{"host", "h"}});
  request.query["token"] = token;
  const std::string set = rule.refusal(request)->headers.at("Set-Cookie");
  EXPECT_NE(set.find("; Secure"), std::string::npos);
  const std::string cookie = set.substr(0, set.find(';'));
  EXPECT_EQ(refused(rule, request_of({{"host", "h"}, {"cookie", cookie}}, "/api/map")), 0);
}

TEST(AccessRuleTest, TokensMustFitIntoHeaders) {
  for (const char* token : {"secret", "a b", "%;\"~"}) EXPECT_NO_THROW(check_token(token)) << token;
  for (const char* token : {"", " a", "a ", "a\nb", "a\r\nSet-Cookie: b", "\xc3\xa9", "a\x7f"})
    EXPECT_THROW(check_token(token), Error) << token;
}

TEST(AccessRuleTest, TokensAreLongAndNew) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(random_token());
  EXPECT_EQ(tokens.size(), 100u);
  EXPECT_EQ(tokens.begin()->size(), 32u);
}

TEST(AccessRuleTest, KnowsLoopback) {
  for (const char* host : {"127.0.0.1", "localhost", "LOCALHOST", "::1", "[::1]", "127.1.2.3"})
    EXPECT_TRUE(is_loopback(host)) << host;
  for (const char* host : {"0.0.0.0", "::", "192.168.0.1", "", "localhost.example",
                           "127.evil.example", "127.", "127.1", "[::1", "[127.0.0.1]", "::1.evil"})
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
}

TEST(RateLimitTest, KnowsABoundedNumberOfClients) {
  RateLimit limit(0.001, 1);
  const RateLimit::Clock::time_point start{};
  EXPECT_TRUE(limit.admits("steady", start));
  for (std::size_t i = 0; i < 10 * RateLimit::kMostClients; ++i) {
    EXPECT_TRUE(limit.admits(std::to_string(i), start));
    if (i % 1000 == 0) {
      EXPECT_FALSE(limit.admits("steady", start));  // who goes on asking is not forgotten
    }
    ASSERT_LE(limit.known(), RateLimit::kMostClients);
  }
}

TEST(RateLimitTest, CountsANetworkOfIpv6AsOneClient) {
  EXPECT_EQ(client_of("2001:db8:1:2::5"), client_of("2001:db8:1:2:ffff::1"));
  EXPECT_NE(client_of("2001:db8:1:2::5"), client_of("2001:db8:1:3::5"));
  EXPECT_NE(client_of("10.0.0.1"), client_of("10.0.0.2"));
}

}  // namespace
}  // namespace ovimap
