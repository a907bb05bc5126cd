// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/front/http_server.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/server/api/map_api.h"
#include "ovimap/server/front/http_server_fixture.h"

namespace ovimap {
namespace {

using nlohmann::json;

std::string unpacked_gzip(const std::string& packed) {
  std::string result(1 << 20, '\0');
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  result.resize(stream.total_out);
  inflateEnd(&stream);
  return result;
}

TEST_F(HttpServerTest, DescribesTheMap) {
  serve();
  const json map = get("/api/map");
  EXPECT_EQ(map["title"], "room");
  EXPECT_EQ(map["instances"], 2);
  EXPECT_EQ(map["frames"], 3);
  EXPECT_EQ(map["live"], false);
  EXPECT_EQ(map["heat_ramp"].size(), 16u);
  const json cameras = get("/api/cameras");
  EXPECT_EQ(cameras["frames"].size(), 3u);
  EXPECT_EQ(cameras["frames"][0]["world_from_camera"].size(), 12u);
  EXPECT_EQ(get("/api/openapi.json")["info"]["title"], "ovimap");
}

TEST_F(HttpServerTest, SaysWhereToLookNext) {
  MapDocument document = random_document(40, 3);
  SeenFree::Regions looked_through;
  looked_through[pack_index({30, 0, 0})].fill(
      {5, 0});  // far from any surface: its faces are frontiers
  document.seen_free.restore(looked_through);
  save_map(map_, document);
  serve();
  const json reply = get("/api/gaps");
  EXPECT_EQ(reply["space_known"], true);
  ASSERT_FALSE(reply["gaps"].empty());
  double before = 1e9;
  for (const json& gap : reply["gaps"]) {
    EXPECT_TRUE(gap["kind"] == "unseen" || gap["kind"] == "thin");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_GT(gap["middle"][axis].get<double>(), gap["box"]["min"][axis].get<double>());
      EXPECT_LT(gap["middle"][axis].get<double>(), gap["box"]["max"][axis].get<double>());
    }
    EXPECT_LE(gap["area_m2"].get<double>(), before) << "the largest first";
    before = gap["area_m2"].get<double>();
  }
}

TEST_F(HttpServerTest, ListsObjects) {
  serve();
  const json instances = get("/api/instances")["instances"];
  ASSERT_EQ(instances.size(), 2u);
  EXPECT_EQ(instances[0]["id"], 1);
  EXPECT_EQ(instances[0]["name"], random_document(1, 1).names.at(1));
  EXPECT_EQ(instances[0]["crops"], json::array({0}));
  EXPECT_TRUE(instances[1]["box"]["min"][0].is_null());  // an empty box has no corners
  const json detail = get("/api/instances/1");
  EXPECT_GT(detail["height_m"], 0.0);
  EXPECT_TRUE(detail["neighbors"].is_array());
}

TEST_F(HttpServerTest, SendsCropsAndChunks) {
  serve();
  const auto crop = running_->client().get("/api/instances/1/crops/0");
  ASSERT_TRUE(crop);
  EXPECT_EQ(crop->field("content-type"), "image/jpeg");
  EXPECT_EQ(crop->body, std::string("\x01\x02"));
  running_->map().surface()->errors();  // makes all chunks
  for (const int level : {0, 1, 2}) {
    const json list = get("/api/mesh?level=" + std::to_string(level));
    ASSERT_GT(list["chunks"].size(), 0u);
    for (const json& chunk : list["chunks"]) {
      const auto reply =
          running_->client().get("/api/mesh/" + std::to_string(level) + "/" + chunk["x"].dump() +
                                 "/" + chunk["y"].dump() + "/" + chunk["z"].dump());
      ASSERT_TRUE(reply);
      EXPECT_EQ(reply->body.size(), 56 + 28 * chunk["patches"].get<std::size_t>() +
                                        16 * chunk["vertices"].get<std::size_t>() +
                                        12 * chunk["triangles"].get<std::size_t>());
    }
  }
  EXPECT_EQ(get("/api/mesh?since=1")["chunks"].size(), 0u);
}

TEST_F(HttpServerTest, TellsTheHistory) {
  serve();
  const json history = get("/api/history");
  ASSERT_EQ(history["visits"].size(), 2u);
  EXPECT_EQ(history["visits"][0]["source"], "/data/evening");
  EXPECT_EQ(history["visits"][0]["frames"], 2);
  EXPECT_TRUE(history["visits"][0]["begin_s"].is_null());
  EXPECT_EQ(history["visits"][1]["begin_s"], 1.7e9);
  ASSERT_EQ(history["events"].size(), 3u);
  const json& gone = history["events"][1];
  EXPECT_EQ(gone["instance"], 2);
  EXPECT_EQ(gone["event"], "gone");
  EXPECT_EQ(gone["surface"], true);
  EXPECT_TRUE(gone["after"].is_null());
  EXPECT_EQ(history["events"][0]["surface"], false);
  EXPECT_EQ(history["events"][2]["may_be"], 2);
  const json surface = get("/api/history/2/surface");
  EXPECT_EQ(surface["points"].size(), 6u);
  EXPECT_EQ(surface["colors"], json({9, 0, 255, 0, 0, 0}));
  const auto crop = running_->client().get("/api/history/2/crop");
  EXPECT_TRUE(crop && crop->body == std::string("\x01\x02"));
  for (const char* path : {"/api/history/1/surface", "/api/history/1/crop", "/api/history/0/crop",
                           "/api/history/4/surface", "/api/history/x/crop"})
    EXPECT_FALSE(get(path, 404)["error"].get<std::string>().empty()) << path;
}

TEST_F(HttpServerTest, TellsWhatChangedBetweenTimes) {
  serve();
  const auto all = get("/api/changes");
  ASSERT_EQ(all["changes"].size(), 3u);
  EXPECT_EQ(all["visits"].size(), 2u);
  const json& gone = all["changes"][1];
  EXPECT_EQ(gone["instance"], 2);
  EXPECT_EQ(gone["event"], "gone");
  EXPECT_NE(gone["text"].get<std::string>().find("visit 2"), std::string::npos);
  EXPECT_EQ(get("/api/changes?since=visit%201")["changes"], all["changes"]);
  EXPECT_TRUE(get("/api/changes?since=visit%202")["changes"].empty());
  EXPECT_TRUE(get("/api/changes?until=visit%201")["changes"].empty());
  get("/api/changes?since=some%20day", 400);
  get("/api/changes?since=", 400);
  get("/api/changes?since=visit%203", 409);
}

TEST_F(HttpServerTest, AnswersWhatChangedWithoutAnEncoder) {
  serve();
  const auto changed = [&](const json& question) {
    std::vector<int> ids;
    const json answer = post("/api/query", question.dump(), 200);
    for (const json& match : answer["matches"]) ids.push_back(match["id"]);
    return ids;
  };
  EXPECT_EQ(changed({{"text", "what changed"}, {"heat", true}}), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(changed({{"text", "what is gone"}}), (std::vector<int>{2}));
  EXPECT_EQ(changed({{"since", "visit 1"}}), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(changed({{"since", "visit 2"}}), (std::vector<int>{}));
  const json gone = post("/api/query", "{\"text\":\"what is gone?\"}", 200)["matches"][0];
  EXPECT_EQ(gone["event"], 2);
  EXPECT_EQ(gone["box"]["min"], json({0.1, 0.2, 0.3}));
  EXPECT_EQ(changed({{"at", "visit 1"}}), (std::vector<int>{1, 2}));
  post("/api/query", "{\"at\":\"visit 9\"}", 409);
  post("/api/query", "{\"at\":\"some day\"}", 400);
  post("/api/query", "{\"text\":\"mug\",\"since\":\"\"}", 400);
  post("/api/query", "{\"text\":\"\",\"since\":\"visit 1\"}", 400);
  post("/api/query", "{\"at\":\"visit 1\",\"since\":\"visit 1\"}", 400);
  post("/api/query", "{\"like\":1,\"at\":\"visit 1\"}", 400);
  post("/api/query", "{\"text\":\"mug\",\"at\":\"visit 1\"}", 409);  // which needs an encoder
}

TEST_F(HttpServerTest, RefusesWhatDoesNotExist) {
  serve();
  for (const char* path :
       {"/api/instances/9", "/api/instances/0", "/api/instances/x", "/api/instances/-1",
        "/api/instances/99999999999999999999", "/api/instances/1/crops/1",
        "/api/instances/1/crops/x", "/api/instances/7/crops/0", "/api/mesh/0/500/0/0",
        "/api/mesh/3/0/0/0", "/api/mesh/0/0/0/x", "/api/nothing", "/../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd", "/assets/../secret"})
    EXPECT_FALSE(get(path, 404)["error"].get<std::string>().empty()) << path;
  for (const char* path : {"/api/mesh?level=x", "/api/mesh?level=5", "/api/mesh?since=-1"})
    EXPECT_FALSE(get(path, 400)["error"].get<std::string>().empty()) << path;
}

TEST_F(HttpServerTest, RefusesBadBodies) {
  serve();
  for (const char* body :
       {"", "{", "[]", "7", "{\"text\":7}", "{\"text\":\"a\",\"like\":1}", "{}",
        "{\"texts\":\"a\"}", "{\"like\":-1}", "{\"like\":1.5}", "{\"like\":99999999999}",
        "{\"text\":\"a\",\"not\":\"b\"}", "{\"text\":\"a\",\"not\":[7]}",
        "{\"text\":\"a\",\"heat\":1}", "\xff\xfe", "{\"text\":\"\xff\"}"})
    post("/api/query", body, 400);
  post("/api/query", std::string(60000, '['), 400);
  post("/api/query", "{\"text\":\"a\"}", 415, "text/plain");
  post("/api/query", std::string(200000, 'x'), 413);
  post("/api/map", "{}", 405);
  post("/api/nothing", "{}", 404);
}

TEST_F(HttpServerTest, SaysWhyItCannotSearch) {
  serve();
  EXPECT_NE(
      post("/api/query", "{\"text\":\"mug\"}", 409)["error"].get<std::string>().find("encoder"),
      std::string::npos);
  EXPECT_EQ(get("/api/map")["search"]["state"], "unavailable");
  post("/api/corrections", R"({"kind":"rename","instance":3,"name":"blue mug"})", 200);
  const auto named = post("/api/query", "{\"text\":\"mug\"}", 200);  // that needs no encoder
  EXPECT_EQ(named["verdict"], "found");
  EXPECT_EQ(named["matches"][0]["id"], 3);
}

TEST_F(HttpServerTest, HandsOutTheSurfaceAsGlb) {
  serve();
  const auto whole = running_->client().get("/api/export.glb");
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->status, 200);
  EXPECT_EQ(whole->field("content-type"), "model/gltf-binary");
  EXPECT_EQ(whole->body.substr(0, 4), "glTF");
  post("/api/corrections", R"({"kind":"hide","instance":3})", 200);
  EXPECT_LT(running_->client().get("/api/export.glb")->body.size(), whole->body.size());
}

TEST_F(HttpServerTest, TellsHowObjectsStandToEachOther) {
  serve();
  const auto said = get("/api/relations");
  EXPECT_LE(said["version"], get("/api/map")["version"]);  // names may be found in between
  ASSERT_TRUE(said["relations"].is_array());
  for (const auto& relation : said["relations"]) {
    EXPECT_GE(relation["score"], 0.5);
    get("/api/instances/" + std::to_string(relation["object"].get<int>()));
    get("/api/instances/" + std::to_string(relation["anchor"].get<int>()));
  }
  const json object = get("/api/instances/1");
  for (const auto& color : object["colors"]) EXPECT_GE(color["share"], 0.1);
}

TEST_F(HttpServerTest, ChecksWhatIsAskedWhereToStand) {
  serve();
  // This map's blocks lie too far apart for a grid; the agents' tests ask a room's.
  post("/api/approach", R"({"instance":1,"from":[1.5,2],"radius_m":0.05})", 409);
  post("/api/approach", R"({"instance":987654})", 404);
  for (const char* wrong : {R"({})", R"({"instance":"1"})", R"({"instance":1,"from":[1]})",
                            R"({"instance":1,"from":[1,null]})", R"({"instance":1,"radius_m":0})",
                            R"({"instance":1,"radius_m":"wide"})", R"({"instance":1,"speed":1})",
                            R"({"instance":1,"poses":1.5})"})
    post("/api/approach", wrong, 400);
}

TEST_F(HttpServerTest, AMapThatWasReplacedUnderneathIsLeftAlone) {
  serve();
  const std::filesystem::path other = root_ / "other.ovimap";
  save_map(other, random_document(41, 3));
  std::filesystem::rename(other, map_);
  const auto refused =
      post("/api/corrections", R"({"kind":"rename","instance":1,"name":"mug"})", 409);
  EXPECT_NE(refused["error"].get<std::string>().find("replaced by another map"), std::string::npos);
  post("/api/approach", R"({"instance":1})", 409);
  get("/api/rooms", 409);
  EXPECT_TRUE(read_edits(map_).empty());
  EXPECT_FALSE(get("/api/instances")["instances"].empty()) << "what was read is served on";

  serve();  // anew
  post("/api/corrections", R"({"kind":"rename","instance":1,"name":"mug"})", 200);
}

TEST_F(HttpServerTest, FindsObjectsByTheIdsThatTheyHad) {
  serve();
  EXPECT_EQ(get("/api/instances/2")["id"], 1);
  for (const json& instance : get("/api/instances")["instances"]) EXPECT_NE(instance["id"], 2);
}

TEST_F(HttpServerTest, DrawsWhereAnObjectIs) {
  serve();
  const auto picture = running_->client().get("/api/instances/1/place");
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->status, 200) << picture->body;
  EXPECT_TRUE(picture->body.starts_with("\xff\xd8")) << "no JPEG";
  get("/api/instances/9/place", 404);
  get("/api/instances/x/place", 404);
}

TEST_F(HttpServerTest, WritesAnExportOnceAndCountsItAsWork) {
  ServerConfig config;
  config.work_burst = 2;
  config.work_per_second = 0.001;
  serve(config);
  get("/api/export.glb");
  get("/api/export.glb");
  get("/api/export.glb", 429);

  FrameApi no_frames(nullptr, {});
  StandingQueries standing(running_->map(), {});
  const Router routes = map_api(running_->map(), no_frames, standing);
  HttpRequest request;
  request.method = "GET";
  request.path = "/api/export.glb";
  const HttpHandler& write = routes.find(request).route->handler;
  const auto first = write(request).body;
  EXPECT_EQ(write(request).body, first);
  MapEdit hide;
  hide.action = EditAction::kHide;
  hide.instances = {3};
  running_->map().correct(std::move(hide));
  EXPECT_NE(*write(request).body, *first);
}

TEST_F(HttpServerTest, GoesOnWhenTheMapIsDeleted) {
  serve();
  std::filesystem::remove(map_);
  EXPECT_EQ(get("/api/instances")["instances"].size(), 2u);
  EXPECT_GT(get("/api/mesh")["chunks"].size(), 0u);
  const json refused =
      post("/api/corrections", R"({"kind":"rename","instance":1,"name":"lost"})", 409);
  EXPECT_NE(refused["error"].get<std::string>().find("room.ovimap"), std::string::npos);
  EXPECT_NE(get("/api/instances")["instances"][0]["name"], "lost");
}

TEST_F(HttpServerTest, SavesTheTripAndBytes) {
  serve();
  auto client = running_->client();
  const auto first = client.get("/api/cameras");
  ASSERT_TRUE(first);
  const auto again = client.get("/api/cameras", {{"If-None-Match", first->field("etag")}});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
  EXPECT_TRUE(again->body.empty());
  const auto plain = client.get("/api/openapi.json", {{"Accept-Encoding", "identity"}});
  const auto zstd = client.get("/api/openapi.json", {{"Accept-Encoding", "zstd"}});
  EXPECT_EQ(zstd->field("content-encoding"), "zstd");
  EXPECT_LT(zstd->body.size(), plain->body.size() / 4);
  const auto gzip = client.get("/api/openapi.json", {{"Accept-Encoding", "gzip"}});
  EXPECT_EQ(gzip->field("content-encoding"), "gzip");
  EXPECT_EQ(unpacked_gzip(gzip->body), plain->body);
  EXPECT_EQ(client.get("/api/openapi.json", {{"Range", "bytes=5-9"}})->status, 200);
  EXPECT_TRUE(client.head("/api/map")->body.empty());
}

}  // namespace
}  // namespace ovimap
