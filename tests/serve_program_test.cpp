// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap serve` as a user meets it, and queries over HTTP with a real encoder.
#include <cstdlib>
#include <fstream>

#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/server/front/server_fixture.h"
#include "program_fixture.h"

namespace ovimap {
namespace {

using nlohmann::json;

class ServeProgramTest : public EncodedProgramTest {};

/// A program whose standard output is read line by line, and which is ended as Ctrl-C does.
class RunningProgram {
 public:
  RunningProgram(const std::string& arguments, const std::filesystem::path& pid_file)
      : pid_file_(pid_file),
        pipe_(
            popen(("echo $$ > '" + pid_file.string() + "'; exec '" OVIMAP_PROGRAM "' " + arguments)
                      .c_str(),
                  "r")) {}
  ~RunningProgram() { end(); }

  std::string line() const {
    char text[4096] = "";
    return std::fgets(text, sizeof text, pipe_) != nullptr ? text : "";
  }
  /// Its exit code; -1 when it was ended before.
  int end() {
    if (pipe_ == nullptr) return -1;
    (void)!std::system(("kill -INT $(cat '" + pid_file_.string() + "')").c_str());
    const int status = pclose(pipe_);
    pipe_ = nullptr;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  std::filesystem::path pid_file_;
  FILE* pipe_;
};

TEST_F(ServeProgramTest, ServesUntilItIsInterrupted) {
  ASSERT_EQ(run("run recording -o bare.ovimap").code, 0);
  RunningProgram program(
      "serve '" + path("bare.ovimap").string() + "' --port 0 --json --viewer none", path("pid"));
  const json said = json::parse(program.line(), nullptr, false);
  ASSERT_TRUE(said.contains("address"));
  EXPECT_EQ(said["viewer"], false);
  const fixture::HttpClient client(said["port"].get<int>());
  const auto page = client.get("/");
  ASSERT_TRUE(page);
  EXPECT_NE(page->body.find("make build"), std::string::npos);
  const json info = json::parse(client.get("/api/map")->body);
  EXPECT_EQ(info["title"], "bare");
  const auto refused = client.post("/api/query", R"({"text":"mug"})", "application/json");
  EXPECT_EQ(refused->status, 409);
  EXPECT_NE(refused->body.find("reembed"), std::string::npos);

  expect_complaint("serve bare.ovimap --port " + std::to_string(said["port"].get<int>()),
                   {"taken", "--port 0"});
  EXPECT_EQ(program.end(), 0);
}

TEST_F(ServeProgramTest, SaysWhatIsWrong) {
  expect_complaint("serve none.ovimap", {"none.ovimap"});
  ASSERT_EQ(run("run recording -o bare.ovimap").code, 0);
  expect_complaint("serve bare.ovimap --viewer recording", {"index.html", "make build"});
  expect_complaint("serve bare.ovimap --port 99999", {"--port"});
  expect_complaint("serve bare.ovimap --host 203.0.113.7", {"203.0.113.7"});
  expect_complaint("serve recording --live", {"--output"});
  expect_complaint("serve bare.ovimap --masks sam", {"--live"});
  expect_complaint("serve recording --live -o nowhere/x.ovimap", {"nowhere"});
}

TEST_F(ServeProgramTest, TakesItsTokenFromAFileOrTheEnvironment) {
  ASSERT_EQ(run("run recording -o bare.ovimap").code, 0);
  std::ofstream(path("token")) << "from a file&\n";
  const std::string serve =
      "serve '" + path("bare.ovimap").string() + "' --port 0 --json --viewer none";
  const auto address_with = [&](const std::string& options) {
    const RunningProgram program(serve + options, path("pid"));
    return json::parse(program.line(), nullptr, false).value("address", "");
  };
  const std::string file = " --token-file '" + path("token").string() + "'";
  EXPECT_NE(address_with(file).find("/?token=from%20a%20file%26"), std::string::npos);
  ::setenv("OVIMAP_TOKEN", "from-the-environment", 1);
  EXPECT_NE(address_with("").find("/?token=from-the-environment"), std::string::npos);
  EXPECT_NE(address_with(file).find("/?token=from%20a"), std::string::npos);
  ::unsetenv("OVIMAP_TOKEN");
  expect_complaint("serve bare.ovimap --token 'a '", {"token", "ASCII"});
  expect_complaint("serve bare.ovimap --tls-cert token --tls-key token", {"token", "PEM"});
}

TEST_F(ServeProgramTest, MapsWhileItServes) {
  RunningProgram program("serve '" + path("recording").string() + "' --live --fps 100 -o '" +
                             path("live.ovimap").string() + "' --port 0 --json --viewer none",
                         path("pid"));
  const json said = json::parse(program.line(), nullptr, false);
  ASSERT_TRUE(said.contains("address"));
  const fixture::HttpClient client(said["port"].get<int>());
  EXPECT_EQ(client.get("/api/map")->status, 200);
  const json saved = json::parse(program.line(), nullptr, false)["saved"];
  EXPECT_GT(saved["frames"], 0);
  EXPECT_GT(saved["live"]["frames_fused"], 0);
  json info = json::object();
  for (int i = 0; i < 400 && info.value("live", true); ++i) {  // as often as the server allows
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    info = json::parse(client.get("/api/map")->body);
  }
  EXPECT_EQ(info["frames"], saved["frames"]);
  ASSERT_GT(info["instances"], 0);
  const json first = json::parse(client.get("/api/instances")->body)["instances"][0]["id"];
  const json named = {{"kind", "rename"}, {"instance", first}, {"name", "pot"}};
  EXPECT_EQ(client.post("/api/corrections", named.dump(), "application/json")->status, 200);
  EXPECT_EQ(program.end(), 0);
  EXPECT_EQ(load_corrected_map(path("live.ovimap")).names.at(first.get<InstanceId>()), "pot");
}

TEST_F(ServeProgramTest, InterruptedWhileMappingItSaves) {
  RunningProgram program("serve '" + path("recording").string() + "' --live --fps 1 -o '" +
                             path("live.ovimap").string() + "' --port 0 --json --viewer none",
                         path("pid"));
  const json said = json::parse(program.line(), nullptr, false);
  ASSERT_TRUE(said.contains("address"));
  const fixture::HttpClient client(said["port"].get<int>());
  while (json::parse(client.get("/api/map")->body)["frames"] < 2)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(program.end(), 0);
  EXPECT_GE(load_map(path("live.ovimap")).frames.size(), 2u);
  EXPECT_FALSE(std::filesystem::exists(path("live.ovimap.partial")));
}

TEST_F(ServeProgramTest, AnswersInWords) {
  map_with(golden_model("minilm"));
  ServedMapConfig served;
  served.encoder = OVIMAP_SOURCE_DIR "/src/ovimap/inference/testdata/golden_minilm";
  const fixture::RunningServer server(path("room.ovimap"), {}, served);
  auto client = server.client();
  const auto ask = [&](const json& question, int status) {
    const auto reply = client.post("/api/query", question.dump(), "application/json");
    EXPECT_TRUE(reply);
    EXPECT_EQ(reply->status, status) << reply->body;
    return json::parse(reply->body);
  };
  const json objects = json::parse(client.get("/api/instances")->body)["instances"];
  ASSERT_GE(objects.size(), 2u);
  const json answer = ask({{"text", "table"}, {"heat", true}}, 200);
  EXPECT_TRUE(answer["verdict"] == "found" || answer["verdict"] == "not_in_map");
  ASSERT_EQ(answer["heat"].size(), objects.size());
  for (const auto& entry : answer["heat"]) {
    EXPECT_GE(entry[1], 0.0);
    EXPECT_LE(entry[1], 1.0);
  }
  EXPECT_EQ(ask({{"text", "largest object"}}, 200)["reading"], "largest [object]");
  EXPECT_FALSE(ask({{"text", "table"}}, 200).contains("heat"));
  const json alike = ask({{"like", objects[0]["id"]}}, 200);
  for (const auto& match : alike["matches"]) EXPECT_NE(match["id"], objects[0]["id"]);
  ask({{"text", "thing"}, {"not", {"thing"}}}, 200);
  ask({{"text", "  "}}, 400);
  ask({{"text", std::string(3000, 'a')}}, 400);
  ask({{"like", 987654}}, 404);
}

}  // namespace
}  // namespace ovimap
