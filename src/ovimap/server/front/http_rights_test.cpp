// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/front/http_server_fixture.h"

namespace ovimap {
namespace {

TEST_F(HttpServerTest, KeepsOtherPagesOut) {
  serve();
  auto client = running_->client();
  EXPECT_EQ(client.get("/api/map", {{"Host", "rebound.example"}})->status, 403);
  EXPECT_EQ(client.get("/api/map", {{"Origin", "http://evil.example"}})->status, 403);
  const auto reply = client.get("/api/map");
  EXPECT_EQ(reply->field("access-control-allow-origin"), "");
  EXPECT_NE(reply->field("content-security-policy").find("script-src 'self'"), std::string::npos);
}

TEST_F(HttpServerTest, DemandsTheToken) {
  ServerConfig config;
  config.token = "secret";
  serve(config);
  auto client = running_->client();
  EXPECT_EQ(client.get("/api/map")->status, 401);
  EXPECT_EQ(client.get("/")->status, 401);
  const auto opened = client.get("/?token=secret");
  EXPECT_EQ(opened->status, 303);
  EXPECT_EQ(client.get("/api/map", {{"Cookie", "ovimap_token=secret"}})->status, 200);
  EXPECT_EQ(client.get("/api/map", {{"Authorization", "Bearer secret"}})->status, 200);
  EXPECT_NE(running_->server().address().find("?token=secret"), std::string::npos);
  config.token = "a b&c=%41;d";
  serve(config);
  const std::string address = running_->server().address();
  const auto opened_again = running_->client().get(address.substr(address.find("/?")));
  const std::string cookie = opened_again->field("set-cookie");
  const std::string pair = cookie.substr(0, cookie.find(';'));
  EXPECT_EQ(running_->client().get("/api/map", {{"Cookie", pair}})->status, 200);
}

TEST_F(HttpServerTest, DoesNotOpenUpWithoutToken) {
  ServedMapConfig served;
  served.encoder = "none";
  ServedMap map(map_, served);
  ServerConfig config;
  config.host = "0.0.0.0";
  config.port = 0;
  EXPECT_NE(fault_of([&] { HttpServer(map, config); }).find("token"), std::string::npos);
  config.token = "secret";
  EXPECT_GT(HttpServer(map, config).port(), 0);
}

TEST_F(HttpServerTest, SaysWhenThePortIsTaken) {
  serve();
  ServedMapConfig served;
  served.encoder = "none";
  ServedMap map(map_, served);
  ServerConfig config;
  config.port = running_->port();
  const std::string fault = fault_of([&] { HttpServer(map, config); });
  EXPECT_NE(fault.find(std::to_string(config.port)), std::string::npos);
  EXPECT_NE(fault.find("--port 0"), std::string::npos);
}

TEST_F(HttpServerTest, LimitsHowOftenOneAsks) {
  ServerConfig config;
  config.work_burst = 3;
  config.work_per_second = 0.001;
  serve(config);
  for (int i = 0; i < 3; ++i) post("/api/query", "{}", 400);
  post("/api/query", "{}", 429);
  get("/api/map");
}

}  // namespace
}  // namespace ovimap
