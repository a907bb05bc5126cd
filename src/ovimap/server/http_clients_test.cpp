// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Clients that nobody would wish for: malformed, slow, vanishing, many.
#include <gtest/gtest.h>

#include "ovimap/io/map_file_fixture.h"
#include "ovimap/server/server_fixture.h"

namespace ovimap {
namespace {

using fixture::RawConnection;

class HttpClientsTest : public MapFolder {
 protected:
  HttpClientsTest() {
    const std::filesystem::path map = root_ / "room.ovimap";
    save_map(map, random_document(20, 3));
    ServedMapConfig served;
    served.encoder = "none";
    ServerConfig config;
    config.patience_s = 1;
    running_ = std::make_unique<fixture::RunningServer>(map, config, served);
  }

  void expect_alive() {
    const auto reply = running_->client().get("/api/map");
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->status, 200);
  }

  std::unique_ptr<fixture::RunningServer> running_;
};

TEST_F(HttpClientsTest, MalformedRequestsGetAReplyOrAreClosed) {
  const std::string host = "Host: 127.0.0.1\r\n";
  const std::string requests[] = {
      "hello\r\n\r\n",
      "GET\r\n\r\n",
      "GET /api/map\r\n\r\n",
      "\r\n\r\n",
      std::string(20, '\0'),
      "GET /api/map HTTP/9.9\r\n\r\n",
      "BREW /api/map HTTP/1.1\r\n" + host + "\r\n",
      "GET /api/map HTTP/1.1\r\nno colon\r\n\r\n",
      "GET /" + std::string(10000, 'a') + " HTTP/1.1\r\n" + host + "\r\n",
      "GET /" + std::string(3000, 'a') + " HTTP/1.1\r\n" + host + "\r\n",
      "GET /%zz%00%ff HTTP/1.1\r\n" + host + "\r\n",
      "GET /api/map HTTP/1.1\r\n" + host + "X: " + std::string(20000, 'b') + "\r\n\r\n",
      "GET /api/map HTTP/1.1\r\n" + host + "Range: bytes=9-1,99999999999999999999-\r\n\r\n",
      "POST /api/query HTTP/1.1\r\n" + host + "Content-Length: -5\r\n\r\n",
      "POST /api/query HTTP/1.1\r\n" + host + "Content-Length: 99999999999999999999\r\n\r\n",
      "POST /api/query HTTP/1.1\r\n" + host + "\r\n",
      "POST /api/query HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\nzz\r\n"};
  for (const std::string& request : requests) {
    RawConnection connection(running_->port());
    connection.send(request);
    const std::string reply = connection.receive();
    if (reply.empty()) continue;
    EXPECT_EQ(reply.substr(0, 9), "HTTP/1.1 ") << request.substr(0, 60);
    EXPECT_NE(reply.substr(9, 1), "5") << request.substr(0, 60) << reply;
  }
  expect_alive();
}

TEST_F(HttpClientsTest, SlowClientsAreLetGo) {
  std::vector<std::unique_ptr<RawConnection>> slow;
  for (int i = 0; i < 50; ++i) {
    slow.push_back(std::make_unique<RawConnection>(running_->port()));
    slow.back()->send(i % 2 == 0 ? "GET /api/m"
                                 : "POST /api/query HTTP/1.1\r\nHost: localhost\r\n"
                                   "Content-Length: 50\r\n\r\n{");
  }
  expect_alive();
  for (const auto& connection : slow) connection->receive();  // a refusal, or the end: no hanging
}

TEST_F(HttpClientsTest, ClientsMayVanish) {
  for (int i = 0; i < 50; ++i) {
    RawConnection connection(running_->port());
    const char* path = i % 2 == 0 ? "/api/events" : "/api/mesh";
    connection.send("GET " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    if (i % 4 < 2) connection.receive();
  }
  expect_alive();
}

TEST_F(HttpClientsTest, TwoHundredAreServedAtOnce) {
  std::vector<std::unique_ptr<RawConnection>> open;
  for (int i = 0; i < 200; ++i) {
    open.push_back(std::make_unique<RawConnection>(running_->port()));
    ASSERT_TRUE(open.back()->connected());
    open.back()->send("GET /api/instances HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  for (const auto& connection : open)
    EXPECT_EQ(connection->receive().substr(0, 15), "HTTP/1.1 200 OK");
  expect_alive();
}

TEST_F(HttpClientsTest, EventsReachTheirListenersAndEndWithTheServer) {
  RawConnection listener(running_->port());
  listener.send("GET /api/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  std::string heard;
  while (heard.find("event: hello") == std::string::npos) {
    const std::string piece = listener.receive();
    ASSERT_FALSE(piece.empty());
    heard += piece;
  }
  MapEdit rename;
  rename.instances = {1};
  rename.name = "cup";
  running_->map().correct(rename);
  while (heard.find("event: map") == std::string::npos) {
    const std::string piece = listener.receive();
    ASSERT_FALSE(piece.empty());
    heard += piece;
  }
  running_.reset();  // ends at once although somebody listens
  while (!listener.receive().empty()) {
  }
}

TEST_F(HttpClientsTest, TooManyListenersAreTurnedAway) {
  std::vector<std::unique_ptr<RawConnection>> listeners;
  for (int i = 0; i < 65; ++i) {
    listeners.push_back(std::make_unique<RawConnection>(running_->port()));
    listeners.back()->send("GET /api/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const std::string status = listeners.back()->receive().substr(9, 3);
    EXPECT_EQ(status, i < 64 ? "200" : "503");
  }
  expect_alive();
}

}  // namespace
}  // namespace ovimap
