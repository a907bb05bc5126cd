// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Frames pushed over HTTP, by a client.
#include "ovimap/server/api/frame_api.h"

#include <gtest/gtest.h>

#include "ovimap/frames/recording/sequence_fixture.h"
#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/server/front/server_fixture.h"

namespace ovimap {
namespace {

using nlohmann::json;

std::string text_of(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

class FrameApiTest : public MapFolder {
 protected:
  FrameApiTest() { save_map(root_ / "room.ovimap", random_document(40, 3)); }

  fixture::RunningServer& serve(FrameIntake* intake, ServerConfig config = {}) {
    ServedMapConfig served;
    served.encoder = "none";
    running_ = std::make_unique<fixture::RunningServer>(root_ / "room.ovimap", std::move(config),
                                                        served, intake);
    return *running_;
  }

  json parsed(const std::optional<fixture::HttpAnswer>& reply, int status) const {
    EXPECT_TRUE(reply);
    if (!reply) return {};
    EXPECT_EQ(reply->status, status) << reply->body;
    const json body = json::parse(reply->body, nullptr, false);
    if (status >= 400) {
      EXPECT_FALSE(body.value("error", "").empty()) << reply->body;
    }
    return body;
  }
  json set_camera(const json& camera, int status) const {
    return parsed(running_->client().post("/api/camera", camera.dump(), "application/json"),
                  status);
  }
  json camera() const {
    const PinholeCamera& c = sequence_.depth_camera;
    return {{"camera",
             {{"width", c.width},
              {"height", c.height},
              {"fx", c.fx},
              {"fy", c.fy},
              {"cx", c.cx},
              {"cy", c.cy},
              {"depth_scale", 1000}}}};
  }
  json about(int index) const {
    json pose = json::array();
    for (int i = 0; i < 16; ++i) pose.push_back(sequence_.pose(index)(i / 4, i % 4));
    return {{"pose", pose}, {"timestamp_s", 0.1 * index}};
  }
  std::vector<fixture::FormPart> frame(int index) const {
    return {{"color", text_of(encode_png(sequence_.color(index))), "image/png"},
            {"depth", text_of(encode_png(sequence_.stored_depth(index))), "image/png"},
            {"frame", about(index).dump(), "application/json"}};
  }
  json push(const std::vector<fixture::FormPart>& items, int status) const {
    return parsed(running_->client().post("/api/frames", items), status);
  }

  const fixture::Sequence sequence_;
  std::unique_ptr<fixture::RunningServer> running_;
};

TEST_F(FrameApiTest, TakesFramesUntilTheQueueIsFull) {
  FrameIntake intake(2);
  serve(&intake);
  push(frame(0), 409);  // no camera yet
  EXPECT_EQ(set_camera(camera(), 200)["taken"], 0);
  EXPECT_EQ(push(frame(3), 200)["waiting"], 1);
  auto named = frame(4);
  json text = about(4);
  text["name"] = "kitchen 4";
  text["orientation"] = {0.6, 0, -0.8, 0.0001};
  named[2].content = text.dump();
  EXPECT_EQ(push(named, 200)["taken"], 2);
  EXPECT_NE(push(frame(5), 503)["error"].get<std::string>().find("skipped"), std::string::npos);
  EXPECT_EQ(intake.counts().skipped, 1);

  const Frame first = *intake.next(std::chrono::milliseconds(0));
  EXPECT_EQ(first.color, sequence_.color(3));
  EXPECT_EQ(first.depth_camera, sequence_.depth_camera);
  EXPECT_TRUE(first.world_from_camera.isApprox(fixture::room_pose(3), 1e-9));
  EXPECT_DOUBLE_EQ(first.timestamp_s, 0.3);
  EXPECT_EQ(first.name, "frame000000");
  EXPECT_FALSE(first.orientation);
  const Frame second = *intake.next(std::chrono::milliseconds(0));
  EXPECT_EQ(second.name, "kitchen 4");
  ASSERT_TRUE(second.orientation);
  EXPECT_LT(second.orientation->angularDistance(Eigen::Quaterniond(0, 0.6, 0, -0.8)), 1e-3);
  EXPECT_DOUBLE_EQ(second.orientation->norm(), 1);

  EXPECT_EQ(parsed(running_->client().post("/api/finish"), 202)["taken"], 2);
  push(frame(6), 409);
  EXPECT_TRUE(intake.ended());
}

TEST_F(FrameApiTest, AResumedMapTakesItsOwnCameraAlone) {
  FrameIntake intake(2);
  serve(&intake);
  set_camera(camera(), 200);  // while the earlier run is still read
  PinholeCamera other = sequence_.depth_camera;
  other.fx *= 1.5f;
  intake.resume_at(5, other);
  EXPECT_NE(push(frame(0), 409)["error"].get<std::string>().find("another camera"),
            std::string::npos);
  set_camera(camera(), 409);
  EXPECT_EQ(intake.counts().taken, 0);
}

TEST_F(FrameApiTest, SaysWhatIsWrongWithARequest) {
  FrameIntake intake(2);
  serve(&intake);
  set_camera(json::object(), 400);
  set_camera({{"camera", {{"width", 80}}}}, 400);
  set_camera({{"camera", {{"width", "wide"}}}}, 400);
  set_camera({{"kamera", 3}}, 400);
  set_camera(json::array(), 400);
  set_camera(camera(), 200);
  for (std::size_t part = 0; part < 3; ++part) {
    auto lacking = frame(0);
    lacking.erase(lacking.begin() + static_cast<std::ptrdiff_t>(part));
    push(lacking, 400);
    auto broken = frame(0);
    broken[part].content = "{nothing";
    push(broken, 400);
  }
  for (const json& wrong :
       {json{{"pose", {1, 2, 3}}}, json{{"pose", 5}}, json::array(), json{{"when", 3}},
        json{{"pose", json(std::vector<double>(16, 1e30))}}}) {
    auto items = frame(0);
    items[2].content = wrong.dump();
    push(items, 400);
  }
  for (const char* name : {"../up", "a/b", ".hidden"}) {
    auto items = frame(0);
    json text = about(0);
    text["name"] = name;
    items[2].content = text.dump();
    push(items, 400);
  }
  for (const json& orientation : {json{0, 0, 0, 0}, json{0, 0, 1}, json{0, 0, 1e308, 1e308},
                                  json{0, 0, "1", 0}, json(1), json(nullptr)}) {
    auto items = frame(0);
    json text = about(0);
    text["orientation"] = orientation;
    items[2].content = text.dump();
    EXPECT_NE(push(items, 400)["error"].get<std::string>().find("unit quaternion"),
              std::string::npos)
        << orientation;
  }
  auto extra = frame(0);
  extra.push_back({"mask", "1", "text/plain"});
  push(extra, 400);
  parsed(running_->client().post("/api/frames", "{}", "application/json"), 415);
  EXPECT_EQ(intake.counts().taken, 0);

  push(frame(0), 200);
  set_camera(camera(), 200);  // the same again
  json other = camera();
  other["camera"]["fx"] = 300;
  set_camera(other, 409);
}

/// What walks JSON recursively would run out of stack, and the map be lost.
TEST_F(FrameApiTest, DeeplyNestedJsonIsRefused) {
  FrameIntake intake(2);
  ServerConfig config;
  config.max_body_bytes = 4 << 20;
  serve(&intake, config);
  const auto nested = [](std::size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
  };
  for (const std::size_t levels : {100u, 10'000u, 500'000u}) {
    const std::string camera_body = R"({"camera": )" + nested(levels) + "}";
    parsed(running_->client().post("/api/camera", camera_body, "application/json"), 400);
    auto items = frame(0);
    items[2].content = R"({"pose": )" + nested(levels) + "}";
    push(items, 400);
  }
  set_camera(camera(), 200);
  push(frame(0), 200);
}

class PoseApiTest : public FrameApiTest {
 protected:
  void serve_moving(FrameIntake& intake) {
    ServerConfig config;
    config.moves_frames = true;
    serve(&intake, config);
  }
  json post(const json& body, int status) const {
    return parsed(running_->client().post("/api/poses", body.dump(), "application/json"), status);
  }
  json node(int index) const { return {{"index", index}, {"pose", about(index)["pose"]}}; }
};

TEST_F(PoseApiTest, TakesThePosesOfAGraph) {
  FrameIntake intake(4);
  serve_moving(intake);
  const json graph = {{"poses", {about(0), about(3)}}};
  post(graph, 409);  // no camera yet
  set_camera(camera(), 200);
  post(graph, 202);
  PoseUpdate update = *intake.next_update();
  EXPECT_TRUE(update.by_time);
  ASSERT_EQ(update.nodes.size(), 2u);
  EXPECT_DOUBLE_EQ(update.nodes[1].at, 0.3);
  EXPECT_TRUE(update.nodes[1].world_from_camera.isApprox(fixture::room_pose(3), 1e-9));
  post({{"poses", {node(2)}}}, 202);
  update = *intake.next_update();
  EXPECT_FALSE(update.by_time);
  EXPECT_DOUBLE_EQ(update.nodes[0].at, 2);
  intake.finish();
  EXPECT_NE(post(graph, 409)["error"].get<std::string>().find("ovimap correct"), std::string::npos);
}

TEST_F(PoseApiTest, SaysWhatIsWrongWithAGraph) {
  FrameIntake intake(4);
  serve_moving(intake);
  set_camera(camera(), 200);
  json skewed = node(1), vague = node(1), lacking = node(1);
  skewed["pose"] = json(std::vector<double>(16, 1.));
  vague.erase("index");
  lacking.erase("pose");
  for (const json& wrong :
       {json::object(), json{{"poses", 3}}, json{{"poses", json::array()}}, json{{"graph", 3}},
        json{{"poses", {3}}}, json{{"poses", {skewed}}}, json{{"poses", {vague}}},
        json{{"poses", {lacking}}}, json{{"poses", {node(1), about(2)}}}})
    post(wrong, 400);
  EXPECT_FALSE(intake.next_update());
}

TEST_F(PoseApiTest, WhereNoFramesAreKeptItSaysHowToKeepThem) {
  FrameIntake intake(4);
  serve(&intake);
  set_camera(camera(), 200);
  EXPECT_NE(
      post({{"poses", {node(1)}}}, 409)["error"].get<std::string>().find("frame_store.max_mb"),
      std::string::npos);
}

TEST_F(FrameApiTest, WithoutAnIntakeItSaysHowToGetOne) {
  serve(nullptr);
  EXPECT_NE(set_camera(camera(), 409)["error"].get<std::string>().find("--live http"),
            std::string::npos);
  push(frame(0), 409);
  parsed(running_->client().post("/api/finish"), 409);
}

TEST_F(FrameApiTest, LargeBodiesAreForFramesOfThoseWhoMaySendThem) {
  FrameIntake intake(2);
  ServerConfig config;
  config.token = "secret";
  config.max_frame_bytes = 1 << 18;
  serve(&intake, config);
  const auto post = [&](const std::string& path, std::size_t bytes, bool with_token) {
    fixture::HttpFields fields;
    if (with_token) fields["Authorization"] = "Bearer secret";
    const auto reply =
        running_->client().post(path, std::string(bytes, 'a'), "application/json", fields);
    return reply ? reply->status : 0;
  };
  EXPECT_EQ(post("/api/frames", 1 << 17, true), 415);
  EXPECT_EQ(post("/api/frames", 1 << 10, false), 401);
  EXPECT_EQ(post("/api/query", 1 << 10, true), 400);
}

/// What a request is answered of which the head alone was sent. What follows must not be taken for
/// another request: the connection has to be closed.
std::string answer_to_head(int port, const std::string& head) {
  const fixture::RawConnection raw(port);
  raw.send("POST " + head + "\r\nHost: localhost\r\n\r\n");
  std::string answer;
  for (std::string piece = raw.receive(); !piece.empty(); piece = raw.receive()) answer += piece;
  raw.send("GET /api/map HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer secret\r\n\r\n");
  EXPECT_EQ(raw.receive(), "") << "something answered after: " << answer;
  return answer.substr(0, std::string("HTTP/1.1 401").size());
}

TEST_F(FrameApiTest, RefusalsByTheHeadCloseTheConnection) {
  FrameIntake intake(2);
  ServerConfig config;
  config.token = "secret";
  config.max_frame_bytes = 1 << 18;
  serve(&intake, config);
  const auto answer = [&](const std::string& path, const std::string& headers) {
    return answer_to_head(running_->port(), path + " HTTP/1.1\r\n" + headers);
  };
  const std::string token = "Authorization: Bearer secret\r\n";
  EXPECT_EQ(answer("/api/frames", "Content-Length: 200000"), "HTTP/1.1 401");
  EXPECT_EQ(answer("/api/query", token + "Content-Length: 200000"), "HTTP/1.1 413");
  EXPECT_EQ(answer("/api/frames", token + "Content-Length: 600000"), "HTTP/1.1 413");
  EXPECT_EQ(answer("/api/frames", token + "Content-Length: 9999999999999999999"), "HTTP/1.1 413");
  EXPECT_EQ(answer("/api/frames", token + "Content-Length: 99999999999999999999999"),
            "HTTP/1.1 400");
  EXPECT_EQ(answer("/api/frames", token + "Content-Length: +70000"), "HTTP/1.1 400");
  EXPECT_EQ(answer("/api/frames", token + "Transfer-Encoding: chunked"), "HTTP/1.1 411");
  EXPECT_EQ(answer("/api/query", "Origin: http://evil.example\r\nContent-Length: 70000"),
            "HTTP/1.1 403");
}

TEST_F(FrameApiTest, ImagesAreAskedForOnlyWhereThereIsRoom) {
  FrameIntake intake(1);
  ServerConfig config;
  config.max_frame_bytes = 1 << 18;
  serve(&intake, config);
  set_camera(camera(), 200);
  std::vector<std::unique_ptr<fixture::RawConnection>> open;
  const auto announce = [&](const char* from) {
    open.push_back(std::make_unique<fixture::RawConnection>(running_->port(), from));
    open.back()->send(
        "POST /api/frames HTTP/1.1\r\nHost: localhost\r\nContent-Length: 200000\r\n"
        "Content-Type: multipart/form-data; boundary=a\r\nExpect: 100-continue\r\n\r\n");
    return open.back()->receive().substr(9, 3);
  };
  EXPECT_EQ(announce("127.0.0.1"), "100");
  EXPECT_EQ(announce("127.0.0.1"), "503");  // one body of that size from each address
  EXPECT_EQ(announce("127.0.0.2"), "100");
  EXPECT_EQ(announce("127.0.0.3"), "503");  // two in all
  EXPECT_EQ(intake.counts().skipped, 0);
  std::string again;
  do {  // given back
    open.clear();
    again = announce("127.0.0.1");
  } while (again == "503");
  EXPECT_EQ(again, "100");
  open.clear();
  push(frame(0), 200);
  EXPECT_EQ(announce("127.0.0.1"), "503");  // the queue is full: nothing is read in vain
  EXPECT_EQ(intake.counts().skipped, 1);
}

TEST_F(FrameApiTest, FramesAreNotHeldBackAsQueriesAre) {
  FrameIntake intake(1000);
  ServerConfig config;
  config.work_burst = 2;
  config.work_per_second = 0.001;
  serve(&intake, config);
  set_camera(camera(), 200);
  for (int i = 0; i < 6; ++i) push(frame(i), 200);
  parsed(running_->client().post("/api/finish"), 202);
  parsed(running_->client().post("/api/finish"), 429);
}

}  // namespace
}  // namespace ovimap
