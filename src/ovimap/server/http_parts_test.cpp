// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/server/compression.h"
#include "ovimap/server/event_hub.h"
#include "ovimap/server/event_stream.h"
#include "ovimap/server/http_message.h"

namespace ovimap {
namespace {

TEST(RouterTest, FindsPathsAndMethods) {
  Router router;
  router.add("GET", "/api/things/{id}", [](const HttpRequest& request) {
    return text_reply(200, "text/plain", request.segments.at(0));
  });
  HttpRequest request;
  request.method = "GET";
  request.path = "/api/things/7";
  EXPECT_EQ(*router.answer(request).body, "7");
  request.method = "HEAD";
  EXPECT_EQ(router.answer(request).status, 200);
  request.method = "POST";
  const HttpReply refused = router.answer(request);
  EXPECT_EQ(refused.status, 405);
  EXPECT_EQ(refused.headers.at("Allow"), "GET, HEAD");
  request.method = "GET";
  for (const char* path : {"/api/things", "/api/things/7/8", "", "/", "//", "/api//things/7"}) {
    request.path = path;
    EXPECT_EQ(router.answer(request).status, 404) << path;
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
  const std::chrono::milliseconds soon(1);
  EXPECT_FALSE(hub.next(0, soon));
  hub.publish("map", "{}");
  hub.publish("mesh", "{}");
  EXPECT_EQ(hub.next(0, soon)->type, "map");
  EXPECT_EQ(hub.next(1, soon)->type, "mesh");
  EXPECT_FALSE(hub.next(2, soon));
  EXPECT_EQ(hub.next(99, soon)->type, "reset");  // of an earlier server
  for (std::size_t i = 0; i < 2 * EventHub::kKept; ++i) hub.publish("map", "{}");
  EXPECT_EQ(hub.next(2, soon)->type, "reset");
  EXPECT_FALSE(hub.next(hub.last(), soon));
  hub.close();
  EXPECT_FALSE(hub.next(0, soon));
}

TEST(EventStreamTest, SpeaksTheFormatOfServerSentEvents) {
  EventHub hub;
  hub.publish("map", "{\"version\":2}");
  HttpRequest request;
  request.headers["last-event-id"] = "0";
  HttpReply reply = event_stream(hub, request);
  bool ended = false;
  EXPECT_EQ(reply.stream(ended), "retry: 2000\nid: 0\nevent: hello\ndata: {}\n\n");
  EXPECT_EQ(reply.stream(ended), "id: 1\nevent: map\ndata: {\"version\":2}\n\n");
  EXPECT_FALSE(ended);
  hub.close();
  reply.stream(ended);
  EXPECT_TRUE(ended);
}

TEST(EventStreamTest, ANewClientHearsOnlyWhatIsNew) {
  EventHub hub;
  hub.publish("map", "{}");
  for (const char* id : {"", "abc", "-1", "1x"}) {
    HttpRequest request;
    request.headers["last-event-id"] = id;
    bool ended = false;
    EXPECT_NE(event_stream(hub, request).stream(ended).find("id: 1\n"), std::string::npos) << id;
  }
}

}  // namespace
}  // namespace ovimap
