// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/server/front/http_server_fixture.h"

namespace ovimap {
namespace {

/// Standing queries over HTTP. What they find is tested where there is an encoder
/// (python/tests/test_watch.py).
class WatchTest : public HttpServerTest {
 protected:
  /// What a client reads until `words` came; all there was when the connection ended before.
  static std::string read_until(const fixture::RawConnection& connection,
                                const std::string& words) {
    std::string all;
    while (all.find(words) == std::string::npos) {
      const std::string piece = connection.receive();
      if (piece.empty()) break;
      all += piece;
    }
    return all;
  }
  static std::string head(const std::string& target, const std::string& more = "") {
    return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n" + more + "\r\n";
  }
  static std::string body(std::size_t queries) {
    return nlohmann::json{{"queries", std::vector<std::string>(queries, "mug")}}.dump();
  }
  static std::string post_of(const std::string& body) {
    return "POST /api/watch HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
           "Content-Length: " +
           std::to_string(body.size()) + "\r\n\r\n" + body;
  }
};

TEST_F(WatchTest, SaysThatAMapCannotBeSearchedAndGoesOn) {
  serve();
  const fixture::RawConnection listener(running_->port());
  listener.send(head("/api/watch?query=mug&query=red+cup&hold_s=0.5"));
  const std::string said = read_until(listener, "cannot be searched");
  EXPECT_NE(said.find("text/event-stream"), std::string::npos) << said;
  EXPECT_NE(said.find("event: hello\ndata: {\"queries\":2}"), std::string::npos) << said;
  EXPECT_NE(said.find("id: 0\n"), std::string::npos) << said;
  EXPECT_NE(said.find("event: fault"), std::string::npos) << said;
  EXPECT_NE(read_until(listener, ": quiet").find(": quiet"), std::string::npos);
}

TEST_F(WatchTest, ManyQueriesAreInTheBody) {
  serve();
  const fixture::RawConnection listener(running_->port());
  listener.send(post_of(body(1000)));
  EXPECT_NE(read_until(listener, "cannot be searched").find("{\"queries\":1000}"),
            std::string::npos);
}

TEST_F(WatchTest, RefusesNonsenseInOneSentence) {
  serve();
  get("/api/watch", 400);
  get("/api/watch?query=", 400);
  get("/api/watch?query=mug&query=+", 400);
  get("/api/watch?q=mug", 400);
  get("/api/watch?query=" + std::string(3000, 'x'), 400);
  for (const char* hold : {"", "x", "-1", "3601", "nan", "1s"})
    get(concat("/api/watch?query=mug&hold_s=", hold), 400);
  for (const char* wrong :
       {R"({})", R"({"queries":[]})", R"({"queries":"mug"})", R"({"queries":[1]})",
        R"({"queries":[""]})", R"({"queries":["mug"],"hold_s":"3"})",
        R"({"queries":["mug"],"hold_s":1e9})", R"({"queries":["mug"],"heat":true})", "[]", "{"})
    post("/api/watch", wrong, 400);
  post("/api/watch", body(1001), 400);
  post("/api/watch", body(1), 415, "text/plain");
}

TEST_F(WatchTest, AsMuchStandsAsIsAllowedAndAClientThatLeavesMakesRoom) {
  ServerConfig config;
  config.max_standing_queries = 5;
  config.max_standing_queries_of_one = 3;
  serve(config);
  {
    const fixture::RawConnection first(running_->port()), other(running_->port(), "127.0.0.2");
    first.send(post_of(body(3)));
    EXPECT_NE(read_until(first, "hello").find("hello"), std::string::npos);
    post("/api/watch", body(1), 503);
    other.send(post_of(body(2)));
    EXPECT_NE(read_until(other, "hello").find("hello"), std::string::npos);
    EXPECT_EQ(running_->client("127.0.0.3").get("/api/watch?query=mug")->status, 503);
  }
  std::string said;
  while (said.find(" 200 OK") == std::string::npos) {  // once the server saw them leave
    const fixture::RawConnection again(running_->port());
    again.send(head("/api/watch?query=a&query=b&query=c", "Connection: close\r\n"));
    said = read_until(again, "\r\n\r\n");
    ASSERT_NE(said.find("HTTP/1.1 "), std::string::npos);
  }
}

TEST_F(WatchTest, ListenersAreCountedAsThoseOfOtherEvents) {
  ServerConfig config;
  config.max_event_streams_of_one = 1;
  serve(config);
  const fixture::RawConnection first(running_->port());
  first.send(head("/api/events"));
  EXPECT_NE(read_until(first, "hello").find("hello"), std::string::npos);
  get("/api/watch?query=mug", 503);
}

TEST_F(WatchTest, WantsTheToken) {
  ServerConfig config;
  config.token = "secret";
  serve(config);
  get("/api/watch?query=mug", 401);
  const fixture::RawConnection listener(running_->port());
  listener.send(head("/api/watch?query=mug", "Authorization: Bearer secret\r\n"));
  EXPECT_NE(read_until(listener, "hello").find(" 200 OK"), std::string::npos);
}

TEST_F(WatchTest, EndsWithTheServer) {
  serve();
  const fixture::RawConnection listener(running_->port());
  listener.send(head("/api/watch?query=mug"));
  read_until(listener, "event: fault");
  running_.reset();
  listener.receive_all();  // which returns
}

}  // namespace
}  // namespace ovimap
