// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Clients that nobody would wish for: malformed, slow, vanishing, many.
#include <gtest/gtest.h>

#include <functional>
#include <future>
#include <thread>

#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/server/front/server_fixture.h"
#include "ovimap/server/http/http_io.h"

namespace ovimap {
namespace {

using fixture::RawConnection;

class HttpClientsTest : public MapFolder {
 protected:
  HttpClientsTest() {
    save_map(root_ / "room.ovimap", random_document(20, 3));
    ServerConfig config;
    config.patience_s = 1;
    serve(config);
  }

  void serve(const ServerConfig& config) {
    ServedMapConfig served;
    served.encoder = "none";
    running_.reset();
    running_ = std::make_unique<fixture::RunningServer>(root_ / "room.ovimap", config, served);
  }

  /// All that is answered to these bytes until the server closes the connection.
  std::string answers(const std::string& bytes) const {
    const RawConnection connection(running_->port());
    connection.send(bytes);
    return connection.receive_all();
  }

  std::unique_ptr<RawConnection> saying(const std::string& bytes,
                                        const std::string& from = "127.0.0.1") const {
    auto connection = std::make_unique<RawConnection>(running_->port(), from.c_str());
    connection->send(bytes);
    return connection;
  }

  void expect_alive() {
    const auto reply = running_->client().get("/api/map");
    ASSERT_TRUE(reply.has_value());
    EXPECT_EQ(reply->status, 200);
  }

  std::unique_ptr<fixture::RunningServer> running_;
};

TEST_F(HttpClientsTest, MalformedRequestsAreAnswered) {
  const std::string host = "Host: 127.0.0.1\r\n";
  const std::string requests[] = {
      "hello\r\n\r\n",
      "GET\r\n\r\n",
      "GET /api/map\r\n\r\n",
      "\r\n\r\n",
      std::string(20, '\0') + "\r\n\r\n",
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
    ASSERT_FALSE(reply.empty()) << request.substr(0, 60);
    EXPECT_EQ(reply.substr(0, 9), "HTTP/1.1 ") << request.substr(0, 60);
    EXPECT_NE(reply.substr(9, 3), "500") << request.substr(0, 60) << reply;
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
  const std::string listen = "GET /api/events HTTP/1.1\r\nHost: localhost\r\n\r\n";
  std::vector<std::unique_ptr<RawConnection>> listeners;
  const auto status = [&](const std::string& from) {
    listeners.push_back(saying(listen, from));
    return listeners.back()->receive().substr(9, 3);
  };
  for (const char* from : {"127.0.0.2", "127.0.0.3", "127.0.0.5", "127.0.0.6"})
    for (int i = 0; i < 33; ++i) EXPECT_EQ(status(from), i < 32 ? "200" : "503") << from;
  EXPECT_EQ(status("127.0.0.4"), "503");  // 128 in all
  expect_alive();
  std::string again;
  do {  // places come back
    listeners.clear();
    again = status("127.0.0.4");
  } while (again == "503");
  EXPECT_EQ(again, "200");
}

std::size_t count_of(const std::string& what, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++count;
  return count;
}

const std::string kLast = "GET /api/map HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

TEST_F(HttpClientsTest, RequestsMayFollowWithoutWaiting) {
  const std::string one = "GET /api/labels HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const std::string post =
      "POST /api/query HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Content-Length: 3\r\n\r\n{ }";
  const std::string all = answers(one + post + one + kLast);
  EXPECT_EQ(count_of("HTTP/1.1 200 OK", all), 3u);
  EXPECT_EQ(count_of("HTTP/1.1 400 Bad Request", all), 1u);
}

TEST_F(HttpClientsTest, ABodyIsNeverTakenForARequest) {
  const std::string host = " HTTP/1.1\r\nHost: localhost\r\n";
  const std::string length = "Content-Length: " + std::to_string(kLast.size()) + "\r\n";
  for (const std::string& head :
       {"GET /api/map" + host + length, "HEAD /api/map" + host + length,
        "PUT /api/map" + host + length, "POST /api/map" + host + length,
        "POST /api/query" + host + length + length,
        "POST /api/query" + host + "Content-Length: 0\r\n" + length,
        "POST /api/query" + host + "Transfer-Encoding: chunked\r\n",
        "POST /api/query" + host + length + "Transfer-Encoding: chunked\r\n"}) {
    const std::string all = answers(head + "\r\n" + kLast);
    EXPECT_EQ(count_of("HTTP/1.1 ", all), 1u) << head << all;
    EXPECT_EQ(all.substr(9, 1), "4") << head << all;
  }
}

TEST_F(HttpClientsTest, BodiesAreRefusedByTheHead) {
  const auto status = [&](const std::string& headers) {
    return answers("POST /api/query HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n")
        .substr(9, 3);
  };
  const std::string length = "Content-Length: 60000\r\n",
                    type = "Content-Type: application/json\r\n";
  EXPECT_EQ(status(length + type + "Content-Encoding: gzip\r\n"), "415");
  EXPECT_EQ(status(length + type + "Content-Encoding: identity, gzip\r\n"), "415");
  EXPECT_EQ(status(length + "Content-Type: multipart/form-data; boundary=a\r\n"), "415");
  EXPECT_EQ(status("Content-Length: 70000\r\n" + type), "413");
  EXPECT_EQ(status(type), "411");
}

TEST_F(HttpClientsTest, BodiesAreAskedForWhereTheClientWaits) {
  const auto client = saying(
      "POST /api/query HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Content-Length: 2\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(client->receive(), "HTTP/1.1 100 Continue\r\n\r\n");
  client->send("{}");
  EXPECT_EQ(client->receive().substr(9, 3), "400");
}

TEST_F(HttpClientsTest, EndlessHeadsAreRefused) {
  const std::string endless(1 << 20, 'a');
  EXPECT_EQ(answers(endless).substr(9, 3), "414");
  EXPECT_EQ(answers("PRI * HTTP/2.0\r\n\r\n" + endless).substr(9, 1), "5");
  EXPECT_EQ(answers("GET / HTTP/1.1\r\nX: " + endless).substr(9, 3), "431");
  std::string many = "GET / HTTP/1.1\r\n";
  for (int i = 0; i < 10000; ++i) many += "X: a\r\n";
  EXPECT_EQ(answers(many).substr(9, 3), "431");
}

TEST_F(HttpClientsTest, OldClientsAreAnsweredOnce) {
  const std::string all = answers("GET /api/map HTTP/1.0\r\nHost: localhost\r\n\r\n" + kLast);
  EXPECT_EQ(count_of("HTTP/1.1 200 OK", all), 1u);
  EXPECT_NE(all.find("Connection: close"), std::string::npos);
}

TEST_F(HttpClientsTest, ManySlowClientsLockNobodyOut) {
  ServerConfig config;
  config.max_connections = 40;
  config.max_connections_of_one = 8;
  config.patience_s = config.idle_s = 3600;  // nothing but the places may end them
  serve(config);
  std::vector<std::unique_ptr<RawConnection>> slow;
  for (int i = 2; i < 150; ++i) {
    const std::string from = "127.0.0." + std::to_string(i);
    for (int k = 0; k < 2; ++k) slow.push_back(saying("GET /api/map HT", from));
    slow.push_back(
        saying("POST /api/query HTTP/1.1\r\nHost: localhost\r\n"
               "Content-Type: application/json\r\nContent-Length: 50\r\n\r\n{",
               from));
    if (i % 10 == 0) expect_alive();
  }
  expect_alive();
  for (int i = 0; i < 100; ++i) slow.push_back(saying("G"));  // also from the same address
  expect_alive();
}

TEST_F(HttpClientsTest, AStalledHeadOrBodyEnds) {
  EXPECT_EQ(answers("GET /api/map HTTP/1.1\r\nHost: lo"), "");
  EXPECT_EQ(answers("POST /api/query HTTP/1.1\r\nHost: localhost\r\n"
                    "Content-Type: application/json\r\nContent-Length: 50\r\n\r\n{"),
            "");
}

/// Whether the loop says that a client is gone which does this.
bool is_missed(const std::function<void(const RawConnection&)>& says) {
  IoLoop loop({"127.0.0.1", 0, {}, {}});
  std::promise<void> waiting;
  bool missed = false;
  std::thread thread([&] {
    loop.run([&](std::unique_ptr<Wire> wire) {
      loop.stop_accepting();  // run() returns when nobody is waited for any more
      const std::shared_ptr<Wire> client(std::move(wire));
      client->wait_for_end([&missed, client] { missed = true; });
      waiting.set_value();
    });
  });
  {
    const RawConnection client(loop.port());
    waiting.get_future().wait();
    says(client);
  }
  thread.join();
  return missed;
}

TEST(IoLoopTest, SaysWhenAClientIsGone) {
  EXPECT_TRUE(is_missed([](const auto&) {}));
  EXPECT_FALSE(is_missed([](const auto& client) { client.send("GET"); }));
}

}  // namespace
}  // namespace ovimap
