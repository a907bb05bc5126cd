// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/frame_api.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "ovimap/base/text/printable.h"
#include "ovimap/server/http/multipart.h"
#include "ovimap/server/http/request_body.h"

namespace ovimap {

namespace {

using nlohmann::json;

constexpr const char* kRetry = "ovimap-retry";  // header of a frame that was refused before
constexpr const char* kOtherCamera =
    "the map's frames are of another camera; send that one's, or finish and start a new map";
constexpr double kQuaternionOff = 1e-3;    // by which its length may miss 1: texts have few digits
constexpr std::size_t kLongestName = 200;  // bytes; it names files of masks

using Parts = std::map<std::string, std::string_view>;

std::string_view part_of(const Parts& parts, const char* name) {
  const auto found = parts.find(name);
  if (found == parts.end())
    throw BadRequest(
        400, concat("the part '", name, "' is missing; a frame has color, depth and frame"));
  return found->second;
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// What is missing would be taken from nowhere: other than in camera.yaml there is no layout that
/// knows it.
void require_whole_cameras(const json& rig) {
  for (const char* name : {"camera", "depth_camera", "color_camera"}) {
    if (!rig.contains(name) || !rig[name].is_object()) continue;
    for (const char* key : {"width", "height", "fx", "fy", "cx", "cy"})
      if (!rig[name].contains(key)) throw BadRequest(400, concat("'", name, "' lacks '", key, "'"));
  }
}

FrameIntake::Offer offer_of(const HttpRequest& request) {
  return request.header(kRetry).empty() ? FrameIntake::Offer::kFirst : FrameIntake::Offer::kAgain;
}

/// Empty where `value` is no list of that many numbers.
std::vector<double> numbers_of(const json& value, std::size_t count) {
  const auto is_number = [](const json& number) { return number.is_number(); };
  if (!value.is_array() || value.size() != count ||
      !std::all_of(value.begin(), value.end(), is_number))
    return {};
  return value.get<std::vector<double>>();
}

/// Nullopt where none is given.
std::optional<Eigen::Matrix4d> pose_of(const json& about) {
  if (!about.contains("pose")) return std::nullopt;
  const std::vector<double> numbers = numbers_of(about["pose"], 16);
  if (numbers.empty()) throw BadRequest(400, "'pose' must be 16 numbers, the rows of a 4x4 matrix");
  Eigen::Matrix4d pose;
  for (int i = 0; i < 16; ++i) pose(i / 4, i % 4) = numbers[static_cast<std::size_t>(i)];
  return pose;
}

constexpr const char* kNoRotation = "'orientation' must be a unit quaternion, 4 numbers x, y, z, w";

/// Nullopt where none is given. Its length is whatever was sent.
std::optional<Eigen::Quaterniond> orientation_of(const json& about) {
  if (!about.contains("orientation")) return std::nullopt;
  const std::vector<double> xyzw = numbers_of(about["orientation"], 4);
  if (xyzw.empty()) throw BadRequest(400, kNoRotation);
  return Eigen::Quaterniond(xyzw.data());
}

Eigen::Quaterniond rotation_of(const Eigen::Quaterniond& sent) {
  if (!(std::abs(sent.norm() - 1) < kQuaternionOff)) throw BadRequest(400, kNoRotation);
  return sent.normalized();
}

double time_of(const json& about) {
  if (!about.contains("timestamp_s")) return 0;
  if (!about["timestamp_s"].is_number())
    throw BadRequest(400, "'timestamp_s' must be a number, in seconds");
  return about["timestamp_s"];
}

/// One node of a pose graph, which says when it was: by the index of a frame, or a time.
PoseUpdate::Node node_of(const json& item, const char* key, const CameraRig& rig) {
  if (!item.is_object()) throw BadRequest(400, "each of 'poses' must be an object");
  check_keys(item, {key, "pose"});
  if (!item.contains(key) || !item[key].is_number())
    throw BadRequest(400, concat("each of 'poses' needs '", key, "', a number, as the first has"));
  const std::optional<Eigen::Matrix4d> pose = pose_of(item);
  if (!pose) throw BadRequest(400, "each of 'poses' needs 'pose'");
  if (const std::string bad = pose_fault(*pose); !bad.empty())
    throw BadRequest(400,
                     concat("the pose at ", item[key].dump(), " is no rigid transform: ", bad));
  return {item[key].get<double>(), rig.world_from_depth_camera(*pose)};
}

PoseUpdate update_of(const json& body, const CameraRig& rig) {
  check_keys(body, {"poses"});
  const json poses = body.contains("poses") ? body["poses"] : json();
  if (!poses.is_array() || poses.empty())
    throw BadRequest(400, "'poses' must be a list of {timestamp_s or index, pose}");
  PoseUpdate update{poses[0].is_object() && poses[0].contains("timestamp_s"), {}};
  for (const json& item : poses)
    update.nodes.push_back(node_of(item, update.by_time ? "timestamp_s" : "index", rig));
  return update;
}

/// Names become those of files: no paths.
std::string name_of(const json& about) {
  const std::string name = field<std::string>(about, "name").value_or("");
  if (name.size() > kLongestName || name.find_first_of("/\\") != std::string::npos ||
      name.starts_with('.') || !is_printable(name))
    throw BadRequest(400,
                     "'name' must have at most 200 bytes, no slash, no leading dot and no control "
                     "characters");
  return name;
}

}  // namespace

FrameIntake& FrameApi::intake() const {
  if (intake_ == nullptr)
    throw BadRequest(409,
                     "this server takes no frames; start one that does: ovimap serve --live http "
                     "-o MAP");
  return *intake_;
}

HttpReply FrameApi::counts(int status) const {
  const FrameIntake::Counts counts = intake_->counts();
  const json body = {
      {"taken", counts.taken}, {"skipped", counts.skipped}, {"waiting", counts.waiting}};
  return text_reply(status, "application/json", body.dump());
}

std::optional<HttpReply> FrameApi::early_refusal(const HttpRequest& head) const {
  if (intake_ == nullptr) return std::nullopt;
  const auto room = intake_->room(offer_of(head));
  if (room == FrameIntake::Answer::kTaken) return std::nullopt;
  return reply_to(room);
}

HttpReply FrameApi::camera(const HttpRequest& request) {
  const json body = body_of(request);
  intake();
  require_whole_cameras(body);
  CameraRig rig;
  apply_calibration(body.dump(), "camera", rig);  // JSON is YAML
  auto decoder = std::make_shared<const FrameDecoder>(rig, config_);
  const std::lock_guard lock(mutex_);
  const bool changed =
      decoder_ && calibration_text(decoder_->rig()) != calibration_text(decoder->rig());
  const auto taken_with = intake_->depth_camera();
  if (taken_with && (changed || *taken_with != decoder->rig().depth_camera))
    throw BadRequest(409, kOtherCamera);
  decoder_ = std::move(decoder);
  return counts(200);
}

HttpReply FrameApi::frame(const HttpRequest& request) {
  const Parts parts = parse_multipart(request.header("content-type"), request.body);
  for (const auto& [name, content] : parts)
    if (name != "color" && name != "depth" && name != "frame")
      throw BadRequest(400, concat("'", name, "' is no part of a frame; see /api/openapi.json"));
  const json about = object_of(part_of(parts, "frame"), "the part 'frame'");
  check_keys(about, {"pose", "orientation", "timestamp_s", "name"});
  const std::optional<Eigen::Matrix4d> pose = pose_of(about);
  const std::optional<Eigen::Quaterniond> orientation = orientation_of(about);
  const double timestamp_s = time_of(about);
  const std::string name = name_of(about);
  const auto color = bytes_of(part_of(parts, "color")), depth = bytes_of(part_of(parts, "depth"));
  intake();
  if (!pose && config_.poses != PoseNeed::kNone)
    throw BadRequest(400,
                     "'pose' is missing; send 16 numbers, the rows of a 4x4 matrix, or start "
                     "the server with --poses track");
  const auto offer = offer_of(request);
  // One frame at a time: they stay in order, the camera stays the same, and large images are
  // decoded one by one, and not at all where there is no room.
  const std::lock_guard lock(mutex_);
  if (!decoder_) throw BadRequest(409, "no camera is known yet; POST /api/camera first");
  if (const auto room = intake_->room(offer); room != FrameIntake::Answer::kTaken)
    return reply_to(room);
  Frame frame = decoder_->decode(color, depth, pose);
  if (orientation) frame.orientation = rotation_of(*orientation);
  frame.timestamp_s = timestamp_s;
  frame.name = name;
  return reply_to(intake_->offer(std::move(frame), offer));
}

HttpReply FrameApi::reply_to(FrameIntake::Answer answer) const {
  if (answer == FrameIntake::Answer::kTaken) return counts(200);
  if (answer == FrameIntake::Answer::kEnded)
    return fault(409, "the map is finished and takes no more frames");
  if (answer == FrameIntake::Answer::kOtherCamera) return fault(409, kOtherCamera);
  HttpReply reply = fault(503,
                          "the mapper is busy, so the frame was skipped; send the next one, or "
                          "this one again");
  reply.headers["Retry-After"] = "1";
  return reply;
}

HttpReply FrameApi::poses(const HttpRequest& request) {
  const json body = body_of(request);
  intake();
  if (!moves_frames_)
    throw BadRequest(409,
                     "poses of this map cannot be corrected; start the server with --set "
                     "frame_store.max_mb=1000, and without --poses and memory.max_mb");
  const std::lock_guard lock(mutex_);
  if (!decoder_) throw BadRequest(409, "no camera is known yet; POST /api/camera first");
  if (!intake_->correct(update_of(body, decoder_->rig())))
    return fault(409, "the map is finished; `ovimap correct` takes poses from a file");
  return counts(202);
}

HttpReply FrameApi::finish() {
  intake().finish();
  return counts(202);
}

}  // namespace ovimap
