// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iomanip>
#include <sstream>

#include <yaml-cpp/yaml.h>

#include "ovimap/base/bounded_yaml.h"
#include "ovimap/frames/calibration/color_calibration.h"

namespace ovimap {

namespace {

constexpr Rgb8 kBefore = {255, 60, 40}, kAfter = {60, 255, 90};

std::string number(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

YAML::Node flow_map() {
  YAML::Node node(YAML::NodeType::Map);
  node.SetStyle(YAML::EmitterStyle::Flow);
  return node;
}

void set_camera(YAML::Node node, const PinholeCamera& camera) {
  node["width"] = camera.width;
  node["height"] = camera.height;
  node["fx"] = number(camera.fx, 3);
  node["fy"] = number(camera.fy, 3);
  node["cx"] = number(camera.cx, 3);
  node["cy"] = number(camera.cy, 3);
}

YAML::Node vector_node(const Eigen::Vector3d& vector) {
  YAML::Node node(YAML::NodeType::Sequence);
  node.SetStyle(YAML::EmitterStyle::Flow);
  for (int i = 0; i < 3; ++i) node.push_back(number(vector[i], 6));
  return node;
}

YAML::Node lens_node(const Lens& lens) {
  YAML::Node coefficients(YAML::NodeType::Sequence);
  coefficients.SetStyle(YAML::EmitterStyle::Flow);
  for (std::size_t i = 0; i < 5; ++i) coefficients.push_back(number(lens.coefficients[i], 5));
  YAML::Node node = flow_map();
  node["model"] = "brown_conrady";
  node["coefficients"] = coefficients;
  return node;
}

YAML::Node present_keys(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return YAML::Node(YAML::NodeType::Map);
  const YAML::Node root = read_yaml(file, kSmallDocument);
  return root.IsMap() ? root : YAML::Node(YAML::NodeType::Map);
}

/// Colour dimmed, so that lines stand out.
void draw_background(const RgbImage& color, RgbImage& picture, int left, int top) {
  const auto dim = [](std::uint8_t value) { return static_cast<std::uint8_t>(2 * value / 3); };
  for (int y = 0; y < color.height(); ++y)
    for (int x = 0; x < color.width(); ++x) {
      const Rgb8 pixel = color.at(x, y);
      picture.at(left + x, top + y) = {dim(pixel.r), dim(pixel.g), dim(pixel.b)};
    }
}

void draw_edges(const Frame& frame, const std::vector<DepthEdge>& edges, const ColorView& view,
                Rgb8 paint, RgbImage& picture, int left, int top) {
  draw_background(frame.color, picture, left, top);
  for (const DepthEdge& edge : edges) {
    const Eigen::Vector2f pixel = view.project(edge.x_in_depth);
    const bool seen = pixel.x() >= 0 && pixel.x() < static_cast<float>(frame.color.width()) &&
                      pixel.y() >= 0 && pixel.y() < static_cast<float>(frame.color.height());
    if (!seen) continue;
    const int x = static_cast<int>(pixel.x() + 0.5f), y = static_cast<int>(pixel.y() + 0.5f);
    if (frame.color.contains(x, y)) picture.at(left + x, top + y) = paint;
  }
}

Frame read_again(const FrameSource& source, std::int64_t position) {
  FrameRead read = source.read(position);
  if (!read.frame) throw Error(read.fault);
  return std::move(*read.frame);
}

}  // namespace

std::filesystem::path calibration_file(const std::filesystem::path& source) {
  return (std::filesystem::is_directory(source) ? source : source.parent_path()) /
         "calibration.yaml";
}

std::string calibrated_text(const std::filesystem::path& present,
                            const ColorCalibration& calibration) {
  YAML::Node root = present_keys(present);
  if (!root["depth_camera"]) {
    root["depth_camera"] = flow_map();
    set_camera(root["depth_camera"], calibration.depth_camera);
  }
  const YAML::Node given = root["color_camera"];
  const YAML::Node lens =
      given && given["distortion"] ? YAML::Clone(given["distortion"]) : YAML::Node();
  root["color_camera"] = flow_map();
  set_camera(root["color_camera"], calibration.found.camera);
  if (lens.IsMap()) root["color_camera"]["distortion"] = lens;
  if (calibration.found.lens != Lens{})
    root["color_camera"]["distortion"] = lens_node(calibration.found.lens);
  const Pose& offset = calibration.found.color_from_depth;
  const Eigen::AngleAxisd rotation(offset.linear());
  root["color_from_depth"] = flow_map();
  root["color_from_depth"]["rotation_vector"] = vector_node(rotation.angle() * rotation.axis());
  root["color_from_depth"]["translation"] = vector_node(offset.translation());
  YAML::Emitter text;
  text << root;
  return concat("# color_camera and color_from_depth were found by ovimap calibrate from ",
                calibration.positions.size(), " frames: edges of depth lie ",
                number(calibration.found_px, 2), " px\n# beside those of colour (",
                number(calibration.given_px, 2), " px before); the halves of the frames agree to ",
                number(calibration.spread_px, 2), " px.\n", text.c_str(), "\n");
}

RgbImage calibration_picture(const FrameSource& source, const ColorCalibration& calibration,
                             const CalibrationEdgesConfig& config) {
  constexpr std::size_t kRows = 2;
  const int width = calibration.given.camera.width, height = calibration.given.camera.height;
  RgbImage picture(2 * width, static_cast<int>(kRows) * height);
  for (std::size_t row = 0; row < kRows && !calibration.positions.empty(); ++row) {
    // The middle of each half of the recording.
    const std::size_t at = (2 * row + 1) * calibration.positions.size() / (2 * kRows);
    const Frame frame = read_again(source, calibration.positions[at]);
    const std::vector<DepthEdge> edges = find_calibration_edges(frame, config).depth;
    const int top = static_cast<int>(row) * height;
    draw_edges(frame, edges, calibration.given, kBefore, picture, 0, top);
    draw_edges(frame, edges, calibration.found, kAfter, picture, width, top);
  }
  return picture;
}

}  // namespace ovimap
