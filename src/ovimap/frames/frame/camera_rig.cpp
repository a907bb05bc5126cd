// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/camera_rig.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include <yaml-cpp/yaml.h>

#include "ovimap/base/bounded_yaml.h"
#include "ovimap/base/config.h"
#include "ovimap/geometry/camera_limits.h"
#include "ovimap/image/size_limits.h"

namespace ovimap {

namespace {

constexpr double kLargest = std::numeric_limits<float>::max();
constexpr double kAboveZero = std::numeric_limits<float>::min();

const std::vector<std::string> kDirections = {"world_from_camera", "camera_from_world"};
const std::vector<std::string> kAxes = {"opencv", "opengl", "ros"};
const std::vector<std::string> kCameras = {"depth", "color"};
const std::vector<std::string> kLensModels = {"none", "brown_conrady", "kannala_brandt"};

/// One mapping of a calibration file, with its dotted name for messages.
class Section {
 public:
  Section(std::string file, std::string name, YAML::Node node)
      : file_(std::move(file)), name_(std::move(name)), node_(std::move(node)) {
    if (!node_.IsMap()) fail(name_, text_of(node_), "a mapping of keys");
  }

  void check_keys(const std::vector<std::string>& accepted) const {
    for (const auto& entry : node_) {
      const std::string key = text_of(entry.first);
      if (std::find(accepted.begin(), accepted.end(), key) == accepted.end())
        throw Error(concat(file_, ": there is no key '", dotted(key), "'; did you mean '",
                           dotted(nearest_word(key, accepted)), "'?"));
    }
  }

  bool has(const std::string& key) const { return bool(node_[key]); }
  Section section(const std::string& key) const { return Section(file_, dotted(key), node_[key]); }

  /// Leaves `value` as it is when the key is absent.
  template <class Number>
  void read(const std::string& key, Number& value, double min, double max) const {
    if (has(key))
      value = static_cast<Number>(number(key, node_[key], min, max, std::is_integral_v<Number>));
  }

  /// Three finite numbers, or `absent`.
  Eigen::Vector3d read_vector(const std::string& key, const Eigen::Vector3d& absent) const {
    if (!has(key)) return absent;
    const YAML::Node list = node_[key];
    if (!list.IsSequence() || list.size() != 3)
      fail(dotted(key), text_of(list), "a list of three numbers");
    Eigen::Vector3d vector;
    for (int i = 0; i < 3; ++i) vector[i] = number(key, list[i], -kLargest, kLargest, false);
    return vector;
  }

  /// As many finite numbers as one of `counts`, or none where the key is absent.
  std::vector<double> read_numbers(const std::string& key, const std::vector<std::size_t>& counts,
                                   const std::string& accepted) const {
    const YAML::Node list = node_[key];
    const std::size_t count = list.IsDefined() && list.IsSequence() ? list.size() : 0;
    if (std::find(counts.begin(), counts.end(), count) == counts.end())
      fail(dotted(key), has(key) ? text_of(list) : "", accepted);
    std::vector<double> numbers;
    for (const YAML::Node& item : list)
      numbers.push_back(number(key, item, -kLargest, kLargest, false));
    return numbers;
  }

  void read_list(const std::string& key, std::vector<std::uint16_t>& values) const {
    if (!has(key)) return;
    const YAML::Node list = node_[key];
    if (!list.IsSequence())
      fail(dotted(key), text_of(list), "a list of whole numbers from 0 to 65535");
    values.clear();
    for (const YAML::Node& item : list)
      values.push_back(static_cast<std::uint16_t>(number(key, item, 0, 65535, true)));
  }

  /// One of `words`, which stand in the order of the enumeration.
  template <class Choice>
  void read_choice(const std::string& key, Choice& value,
                   const std::vector<std::string>& words) const {
    if (!has(key)) return;
    const std::string text = text_of(node_[key]);
    const auto found = std::find(words.begin(), words.end(), text);
    std::string accepted;
    for (const std::string& word : words) accepted += (accepted.empty() ? "" : " or ") + word;
    if (found == words.end()) fail(dotted(key), text, accepted);
    value = static_cast<Choice>(found - words.begin());
  }

 private:
  std::string dotted(const std::string& key) const {
    return name_.empty() ? key : name_ + "." + key;
  }

  static std::string text_of(const YAML::Node& node) {
    std::ostringstream text;
    text << node;
    return text.str();
  }

  [[noreturn]] void fail(const std::string& key, const std::string& value,
                         const std::string& accepted) const {
    throw Error(concat(file_, ": ", key.empty() ? "content" : key, " is '", value,
                       "'; accepted is ", accepted));
  }

  static std::string range_text(double min, double max) {
    const bool above_0 = min == kAboveZero, bounded = max < kLargest;
    if (above_0) return bounded ? concat(" above 0, at most ", max) : " above 0";
    return bounded ? concat(" from ", min, " to ", max) : "";
  }

  double number(const std::string& key, const YAML::Node& node, double min, double max,
                bool whole) const {
    double value = std::nan("");
    const bool readable = node.IsScalar() && YAML::convert<double>::decode(node, value);
    if (!readable || !(value >= min && value <= max) || (whole && value != std::floor(value)))
      fail(dotted(key), text_of(node),
           concat(whole ? "a whole number" : "a number", range_text(min, max)));
    return value;
  }

  std::string file_, name_;
  YAML::Node node_;
};

Lens read_lens(const Section& section) {
  section.check_keys({"model", "coefficients"});
  Lens lens;
  lens.model = Lens::Model::kBrownConrady;
  section.read_choice("model", lens.model, kLensModels);
  if (lens.model == Lens::Model::kStraight) return lens;
  const bool fisheye = lens.model == Lens::Model::kKannalaBrandt;
  const std::vector<double> numbers =
      fisheye ? section.read_numbers("coefficients", {4}, "a list of 4 numbers: k1, k2, k3, k4")
              : section.read_numbers("coefficients", {5, 8},
                                     "a list of 5 or 8 numbers: k1, k2, p1, p2, k3, and k4 to k6");
  std::copy(numbers.begin(), numbers.end(), lens.coefficients.begin());
  return lens;
}

void read_camera(const Section& section, PinholeCamera& camera, Lens& lens) {
  section.read("width", camera.width, 1, double{kLargestSide_px});
  section.read("height", camera.height, 1, double{kLargestSide_px});
  constexpr double kMost = kMostFocal_px;
  section.read("fx", camera.fx, kAboveZero, kMost);
  section.read("fy", camera.fy, kAboveZero, kMost);
  section.read("cx", camera.cx, -kMost, kMost);
  section.read("cy", camera.cy, -kMost, kMost);
  if (section.has("distortion")) lens = read_lens(section.section("distortion"));
}

void read_depth_storage(const Section& section, CameraRig& rig) {
  section.read("depth_scale", rig.depth_units_per_m, kAboveZero, kLargest);
  section.read_list("invalid", rig.invalid_depth);
}

Eigen::Vector3d rotation_vector(const Pose& pose) {
  const Eigen::AngleAxisd rotation(pose.linear());
  return rotation.angle() * rotation.axis();
}

Pose rigid(const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation) {
  Pose pose = Pose::Identity();
  if (rotation.norm() > 0)
    pose.linear() = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

void apply(const Section& root, CameraRig& rig) {
  static const std::vector<std::string> kCameraKeys = {"width", "height", "fx",        "fy",
                                                       "cx",    "cy",     "distortion"};
  static const std::vector<std::string> kDepthKeys = {
      "width", "height", "fx", "fy", "cx", "cy", "distortion", "depth_scale", "invalid"};
  root.check_keys({"camera", "depth_camera", "color_camera", "color_from_depth", "poses"});
  if (root.has("camera")) {
    const Section camera = root.section("camera");
    camera.check_keys(kDepthKeys);
    read_camera(camera, rig.color_camera, rig.color_lens);
    read_camera(camera, rig.depth_camera, rig.depth_lens);
    read_depth_storage(camera, rig);
  }
  if (root.has("depth_camera")) {
    const Section camera = root.section("depth_camera");
    camera.check_keys(kDepthKeys);
    read_camera(camera, rig.depth_camera, rig.depth_lens);
    read_depth_storage(camera, rig);
  }
  if (root.has("color_camera")) {
    root.section("color_camera").check_keys(kCameraKeys);
    read_camera(root.section("color_camera"), rig.color_camera, rig.color_lens);
  }
  if (root.has("color_from_depth")) {
    const Section offset = root.section("color_from_depth");
    offset.check_keys({"rotation_vector", "translation"});
    rig.color_from_depth =
        rigid(offset.read_vector("rotation_vector", rotation_vector(rig.color_from_depth)),
              offset.read_vector("translation", rig.color_from_depth.translation()));
  }
  if (root.has("poses")) {
    const Section poses = root.section("poses");
    poses.check_keys({"direction", "axes", "camera"});
    poses.read_choice("direction", rig.poses.direction, kDirections);
    poses.read_choice("axes", rig.poses.axes, kAxes);
    poses.read_choice("camera", rig.poses.camera, kCameras);
  }
}

std::string lens_text(const Lens& lens) {
  if (lens.model == Lens::Model::kStraight) return "";
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10)
       << ", distortion: {model: " << kLensModels[static_cast<std::size_t>(lens.model)]
       << ", coefficients: [";
  const std::size_t count = lens.model == Lens::Model::kKannalaBrandt ? 4 : 8;
  for (std::size_t i = 0; i < count; ++i) text << (i == 0 ? "" : ", ") << lens.coefficients[i];
  return text.str() + "]}";
}

std::string camera_text(const PinholeCamera& camera, const Lens& lens) {
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<float>::max_digits10) << "width: " << camera.width
       << ", height: " << camera.height << ", fx: " << camera.fx << ", fy: " << camera.fy
       << ", cx: " << camera.cx << ", cy: " << camera.cy << lens_text(lens);
  return text.str();
}

std::string vector_text(const Eigen::Vector3d& vector) {
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10) << "[" << vector.x() << ", "
       << vector.y() << ", " << vector.z() << "]";
  return text.str();
}

}  // namespace

Pose pose_by_convention(const PoseConvention& convention, const Pose& stored) {
  const bool inverted = convention.direction == PoseConvention::Direction::kCameraFromWorld;
  Pose pose = inverted ? stored.inverse() : stored;
  Eigen::Matrix3d stored_from_ours = Eigen::Matrix3d::Identity();
  if (convention.axes == PoseConvention::Axes::kOpenGl)
    stored_from_ours << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  if (convention.axes == PoseConvention::Axes::kRos)
    stored_from_ours << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  pose.linear() = pose.linear() * stored_from_ours;
  return pose;
}

Pose CameraRig::world_from_depth_camera(const Eigen::Matrix4d& stored) const {
  const Pose pose = pose_by_convention(poses, rigid_pose(stored));
  return poses.camera == PoseConvention::Camera::kColor ? pose * color_from_depth : pose;
}

void apply_calibration(const std::filesystem::path& file, CameraRig& rig) {
  apply_calibration(read_bounded_text(file, kSmallDocument), file.string(), rig);
}

void apply_calibration(const std::string& yaml, const std::string& name, CameraRig& rig) {
  const YAML::Node root = parse_yaml(yaml, name, kSmallDocument);
  if (root.IsNull()) return;
  apply(Section(name, "", root), rig);
}

std::string calibration_text(const CameraRig& rig) {
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10);
  text << "depth_camera: {" << camera_text(rig.depth_camera, rig.depth_lens)
       << ", depth_scale: " << rig.depth_units_per_m << ", invalid: [";
  for (std::size_t i = 0; i < rig.invalid_depth.size(); ++i)
    text << (i == 0 ? "" : ", ") << rig.invalid_depth[i];
  text << "]}\ncolor_camera: {" << camera_text(rig.color_camera, rig.color_lens) << "}\n"
       << "# x_in_color = R * x_in_depth + t; rotation as a rotation vector (radians), translation "
          "in metres\n"
       << "color_from_depth: {rotation_vector: "
       << vector_text(rotation_vector(rig.color_from_depth))
       << ", translation: " << vector_text(rig.color_from_depth.translation()) << "}\n";
  text << "poses: {direction: " << kDirections[static_cast<std::size_t>(rig.poses.direction)]
       << ", axes: " << kAxes[static_cast<std::size_t>(rig.poses.axes)]
       << ", camera: " << kCameras[static_cast<std::size_t>(rig.poses.camera)] << "}\n";
  return text.str();
}

}  // namespace ovimap
