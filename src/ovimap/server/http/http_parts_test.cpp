// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/server/api/event_stream.h"
#include "ovimap/server/http/compression.h"
#include "ovimap/server/http/http_message.h"
#include "ovimap/server/served/event_hub.h"

namespace ovimap {
namespace {

TEST(RouterTest, FindsPathsAndMethods) {
  Router router;
  router.add({.method = "GET", .pattern = "/api/things/{id}", .handler = {}});
  HttpRequest request;
  request.method = "GET";
  request.path = "/api/things/7";
  EXPECT_EQ(router.find(request).segments, std::vector<std::string>{"7"});
  request.method = "HEAD";
  EXPECT_NE(router.find(request).route, nullptr);
  request.method = "POST";
  const HttpReply refused = router.find(request).refusal;
  EXPECT_EQ(refused.status, 405);
  EXPECT_EQ(refused.headers.at("Allow"), "GET, HEAD");
  request.method = "GET";
  for (const char* path : {"/api/things", "/api/things/7/8", "", "/", "//", "/api//things/7"}) {
    request.path = path;
    EXPECT_EQ(router.find(request).refusal.status, 404) << path;
  }
}

TEST(CompressionTest, ChoosesWhatTheClientAccepts) {
  EXPECT_EQ(choose_encoding("gzip, deflate, br, zstd"), "zstd");
  EXPECT_EQ(choose_encoding("gzip;q=0.5"), "gzip");
  EXPECT_EQ(choose_encoding("zstd;q=0, gzip"), "gzip");
  EXPECT_EQ(choose_encoding("br"), "");
  EXPECT_EQ(choose_encoding(""), "");
  EXPECT_EQ(choose_encoding(",,;q=,zstdx"), "");
}

TEST(EventHubTest, GivesEachReaderWhatItMissed) {
  EventHub hub;
  EXPECT_FALSE(hub.next(0));
  hub.publish("map", "{}");
  hub.publish("mesh", "{}");
  EXPECT_EQ(hub.next(0)->type, "map");
  EXPECT_EQ(hub.next(1)->type, "mesh");
  EXPECT_FALSE(hub.next(2));
  EXPECT_EQ(hub.next(99)->type, "reset");  // of an earlier server
  for (std::size_t i = 0; i < 2 * EventHub::kKept; ++i) hub.publish("map", "{}");
  EXPECT_EQ(hub.next(2)->type, "reset");
  EXPECT_FALSE(hub.next(hub.last()));
  hub.close();
  EXPECT_FALSE(hub.next(0));
}

TEST(EventStreamTest, SpeaksTheFormatOfServerSentEvents) {
  EventHub hub;
  hub.publish("map", "{\"version\":2}");
  HttpRequest request;
  request.headers["last-event-id"] = "0";
  HttpReply reply = event_stream(hub, request, 1);
  EXPECT_EQ(reply.stream->next(), "retry: 2000\nid: 0\nevent: hello\ndata: {}\n\n");
  EXPECT_EQ(reply.stream->next(), "id: 1\nevent: map\ndata: {\"version\":2}\n\n");
  EXPECT_EQ(reply.stream->next(), "");
  EXPECT_FALSE(reply.stream->ended());
  hub.close();
  EXPECT_TRUE(reply.stream->ended());
}

TEST(EventStreamTest, WakesWhoWatchesAsLongAsItLives) {
  EventHub hub;
  int woken = 0;
  HttpReply reply = event_stream(hub, {}, 0);
  reply.stream->watch([&] { ++woken; });
  hub.publish("map", "{}");
  EXPECT_EQ(woken, 1);
  reply.stream.reset();
  hub.publish("map", "{}");
  EXPECT_EQ(woken, 1);
}

TEST(EventStreamTest, ANewClientHearsWhatCameAfterItReadTheMap) {
  EventHub hub;
  for (const char* type : {"map", "mesh"}) hub.publish(type, "{}");
  HttpReply reply = event_stream(hub, {}, 1);
  EXPECT_NE(reply.stream->next().find("id: 1\nevent: hello"), std::string::npos);
  EXPECT_EQ(reply.stream->next(), "id: 2\nevent: mesh\ndata: {}\n\n");
  EXPECT_EQ(reply.stream->next(), "");
}

TEST(EventStreamTest, ANewClientHearsOnlyWhatIsNew) {
  EventHub hub;
  hub.publish("map", "{}");
  for (const char* id : {"", "abc", "-1", "1x"}) {
    HttpRequest request;
    request.headers["last-event-id"] = id;
    EXPECT_NE(event_stream(hub, request, 1).stream->next().find("id: 1\n"), std::string::npos)
        << id;
  }
}

}  // namespace
}  // namespace ovimap
