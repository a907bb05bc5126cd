// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// What clients correct in a served map.
#include <chrono>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "ovimap/io/corrections/taught_file.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/server/front/http_server_fixture.h"

namespace ovimap {
namespace {

using nlohmann::json;

TEST_F(HttpServerTest, KeepsNamesInTheMapFile) {
  serve();
  const auto rename = [](const std::string& name) {
    return json{{"kind", "rename"}, {"instance", 3}, {"name", name}}.dump();
  };
  const json before = get("/api/map");
  const json done = post("/api/corrections", rename("Küchentisch"), 200);
  EXPECT_GT(done["version"], before["version"]);
  EXPECT_EQ(get("/api/instances")["instances"][1]["name"], "Küchentisch");
  EXPECT_EQ(load_corrected_map(map_).names.at(3), "Küchentisch");
  EXPECT_EQ(load_map(map_).names, random_document(40, 3).names);  // what was there stays
  post("/api/corrections", rename(""), 200);
  EXPECT_FALSE(load_corrected_map(map_).names.contains(3));
  post("/api/corrections", rename("two\nlines"), 409);
  post("/api/corrections", rename(std::string(300, 'x')), 409);
  EXPECT_EQ(get("/api/instances")["instances"][1]["name"], "");
}

/// `ovimap edit` beside the server: an undo in the browser must not take back what nobody saw.
TEST_F(HttpServerTest, SeesWhatOtherProgramsCorrect) {
  serve();
  MapEdit edit;
  edit.instances = {3};
  edit.name = "bench";
  edit_map(map_, edit);
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (get("/api/corrections")["corrections"].empty() &&
         std::chrono::steady_clock::now() < patience)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(get("/api/instances")["instances"][1]["name"], "bench");
}

/// What is named in the browser teaches other maps, where the server was told so.
TEST_F(HttpServerTest, NamesTeachOtherMaps) {
  ServedMapConfig served;
  served.encoder = "none";
  served.taught = root_ / "kept" / "taught.json";
  running_ = std::make_unique<fixture::RunningServer>(map_, ServerConfig{}, served);
  EXPECT_EQ(get("/api/map")["teaching"], json({{"on", true}, {"examples", 0}, {"fault", ""}}));
  const auto named = [&] {
    std::vector<std::string> names;
    for (const TaughtThing& thing : read_taught_file(served.taught)) names.push_back(thing.name);
    return names;
  };
  const auto rename = [&](const std::string& name) {
    post("/api/corrections", json{{"kind", "rename"}, {"instance", 1}, {"name", name}}.dump(), 200);
  };
  rename("Küchentisch");
  EXPECT_EQ(named(), std::vector<std::string>{"Küchentisch"});
  post("/api/corrections", json{{"kind", "undo"}}.dump(), 200);
  rename("");
  EXPECT_TRUE(named().empty());
  // A file that is none keeps nobody from correcting the map.
  std::ofstream(served.taught) << "[]";
  rename("table");
  EXPECT_EQ(load_corrected_map(map_).names.at(1), "table");
  EXPECT_NE(get("/api/map")["teaching"]["fault"], "");
}

TEST_F(HttpServerTest, TeachesNothingUnlessAsked) {
  serve();
  EXPECT_EQ(get("/api/map")["teaching"]["on"], false);
}

TEST_F(HttpServerTest, ShowsAMapAsItWasCorrectedBefore) {
  MapEdit edit;
  edit.action = EditAction::kDelete;
  edit.instances = {1};
  edit_map(map_, edit);
  edit.action = EditAction::kRename;
  edit.instances = {3};
  edit.name = "table";
  edit_map(map_, edit);
  serve();
  const json instances = get("/api/instances")["instances"];
  ASSERT_EQ(instances.size(), 1u);  // and the search knows no more
  EXPECT_EQ(instances[0]["id"], 3);
  EXPECT_EQ(instances[0]["name"], "table");
  EXPECT_EQ(get("/api/instances/3")["name"], "table");
  get("/api/instances/1", 404);
  const json labels = get("/api/labels");
  for (const json& id : labels["instances"]) EXPECT_NE(id, 1);
}

TEST_F(HttpServerTest, MergesHidesDeletesLocksAndUndoes) {
  serve();
  const auto correct = [&](json body, int status = 200) {
    return post("/api/corrections", body.dump(), status);
  };
  const auto ids = [&] {
    json list = json::array();
    const json reply = get("/api/instances");
    for (const json& instance : reply["instances"]) list.push_back(instance["id"]);
    return list;
  };
  const auto labels_of = [&](int id) {
    const json table = get("/api/labels")["instances"];
    return std::count(table.begin(), table.end(), json(id));
  };
  const auto one = labels_of(1), three = labels_of(3);
  ASSERT_GT(three, 0);
  EXPECT_EQ(correct({{"kind", "merge"}, {"instance", 3}, {"into", 1}})["edit"], 1);
  EXPECT_EQ(ids(), json({1}));
  EXPECT_EQ(labels_of(1), one + three);
  EXPECT_EQ(get("/api/instances/3")["id"], 1) << "who knew it by the other id finds it";
  EXPECT_EQ(correct({{"kind", "undo"}})["edit"], 2);
  EXPECT_EQ(ids(), json({1, 3}));
  EXPECT_EQ(get("/api/instances/3")["id"], 3);

  correct({{"kind", "hide"}, {"instance", 3}});
  EXPECT_EQ(ids(), json({1}));
  EXPECT_EQ(get("/api/labels")["hidden"], json({3}));
  correct({{"kind", "hide"}, {"instance", 3}}, 409);
  correct({{"kind", "undo"}, {"edit", 3}});

  correct({{"kind", "lock"}, {"instance", 1}});
  EXPECT_EQ(get("/api/instances/1")["locked"], true);
  EXPECT_NE(correct({{"kind", "delete"}, {"instance", 1}}, 409)["error"].get<std::string>().find(
                "locked"),
            std::string::npos);
  correct({{"kind", "delete"}, {"instance", 3}});
  EXPECT_EQ(ids(), json({1}));
  EXPECT_EQ(labels_of(3), 0);

  const json log = get("/api/corrections")["corrections"];
  ASSERT_EQ(log.size(), 6u);
  EXPECT_EQ(log[0]["kind"], "merge");
  EXPECT_EQ(log[0]["instances"], json({1, 3}));
  EXPECT_EQ(log[0]["undone_by"], 2);
  EXPECT_TRUE(log[5]["undone_by"].is_null());
  running_.reset();
  serve();  // all of it is in the file
  EXPECT_EQ(ids(), json({1}));
  EXPECT_EQ(get("/api/corrections")["corrections"], log);
}

TEST_F(HttpServerTest, CorrectsWhatIsKnownByAnotherIdNow) {
  serve();
  post("/api/corrections", R"({"kind":"merge","instance":3,"into":1})", 200);
  post("/api/corrections", R"({"kind":"rename","instance":3,"name":"table"})", 200);
  EXPECT_EQ(get("/api/instances/1")["name"], "table");
  post("/api/corrections", R"({"kind":"rename","instance":99,"name":"table"})", 404);
}

TEST_F(HttpServerTest, TakesObjectsApart) {
  serve();
  const json parts = get("/api/instances/3")["super_points"];
  ASSERT_EQ(parts.size(), 2u);
  json body = {{"kind", "split"}, {"instance", 3}, {"super_points", parts}};
  post("/api/corrections", body.dump(), 409);  // something must stay
  body["super_points"] = json::array({parts[0]});
  post("/api/corrections", body.dump(), 200);
  const json instances = get("/api/instances")["instances"];
  ASSERT_EQ(instances.size(), 3u);
  EXPECT_EQ(get("/api/labels")["instances"][parts[0].get<std::size_t>()], instances[2]["id"]);
  EXPECT_EQ(get("/api/labels")["instances"][parts[1].get<std::size_t>()], 3);
}

TEST_F(HttpServerTest, RefusesBadCorrections) {
  serve();
  post("/api/corrections", R"({"kind":"rename","instance":99,"name":"x"})", 404);
  for (const char* body :
       {R"({"kind":"rename","instance":1})", R"({"kind":"rename","name":"x"})",
        R"({"kind":"paint","instance":1})", R"({"kind":"merge","instance":1})",
        R"({"kind":"rename","instance":1,"name":"x","into":3})", R"({"kind":"undo","instance":1})",
        R"({"kind":"undo","edit":-1})", R"({"kind":"hide","instance":0})",
        R"({"kind":"split","instance":3})", R"({"kind":"split","instance":3,"super_points":[]})",
        R"({"kind":"split","instance":3,"super_points":["a"]})"})
    post("/api/corrections", body, 400);
  post("/api/corrections", R"({"kind":"undo"})", 409);
  post("/api/corrections", R"({"kind":"undo","edit":9})", 409);
  post("/api/corrections", R"({"kind":"merge","instance":1,"into":1})", 409);
}

}  // namespace
}  // namespace ovimap
