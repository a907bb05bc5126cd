// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/tracker.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr std::int64_t kLongestGap = 6;  // frames; longer ones predict nothing more
constexpr int kListenEvery = 5;          // frames; neighbours say the same of the sensor
constexpr int kLeastWidth_px = 2 * kCoarsestWidth_px;  // smaller images lack levels

double share_with_depth(const TrackLevel& level) {
  const auto valid = std::count_if(level.inverse_depth.begin(), level.inverse_depth.end(),
                                   [](float inverse) { return inverse > 0; });
  return static_cast<double>(valid) / static_cast<double>(level.inverse_depth.size());
}

double angle_of(const Pose& motion) {
  return Eigen::AngleAxisd(motion.linear()).angle();
}

std::vector<Pose> seen_from(const Reference& reference, std::vector<Pose> world_from_camera) {
  for (Pose& pose : world_from_camera) pose = reference.world_from_camera.inverse() * pose;
  return world_from_camera;
}

}  // namespace

const TrackedFrame& Tracker::track(const Frame& frame, const VoxelMap& map) {
  if (frame.depth_camera.width < kLeastWidth_px)
    throw Error(concat("depth images are ", frame.depth_camera.width, " pixels wide; a camera is "
                       "tracked by images of ", kLeastWidth_px, " and more, others need poses"));
  pyramid_ = make_pyramid(frame);
  TrackedFrame result;
  result.index = frame.index, result.timestamp_s = frame.timestamp_s, result.name = frame.name;
  result.world_from_camera = last_pose_;
  log_.push_back(result);
  if (reference_is_old_) refresh_reference(map);
  const bool enough = share_with_depth(pyramid_[kSurfaceLevel]) >= config_.min_depth_share;
  bool found = false;
  if (enough) found = begun_ ? follow(frame) || find_again(map) : start(frame);
  lost_ = begun_ && !found;
  if (found) {
    keep_keyframe();
    last_pyramid_ = std::move(pyramid_);
  }
  return log_.back();
}

void Tracker::begin_in(std::vector<Keyframe> places) {
  keyframes_ = std::move(places);
  for (const Keyframe& keyframe : keyframes_) codes_.push_back(keyframe.code);
  begun_ = lost_ = true;
}

void Tracker::correct(const std::vector<Pose>& poses) {
  OVIMAP_ASSERT(poses.size() == keyframes_.size() && !poses.empty());
  const Pose moved = poses.back() * keyframes_.back().world_from_camera.inverse();
  for (std::size_t i = 0; i < poses.size(); ++i) keyframes_[i].world_from_camera = poses[i];
  last_pose_ = moved * last_pose_;
  reference_is_old_ = true;  // it shows the map as it was
}

/// The first frame is where the world is.
bool Tracker::start(const Frame& frame) {
  begun_ = true;
  Alignment alignment;
  alignment.quality = {1, 1, 1, 0, 0};
  Reference reference;
  if (frame.posed) reference.world_from_camera = frame.world_from_camera;
  accept(frame.index, alignment, reference, false);
  last_motion_ = Pose::Identity();
  if (frame.posed) last_given_ = frame.world_from_camera;
  reference_is_old_ = true;
  return true;
}

/// Poses at which the frame may have been taken, the likeliest first.
std::vector<Pose> Tracker::predictions(const Frame& frame) const {
  std::vector<Pose> poses;
  if (frame.posed && last_given_)
    poses.push_back(last_pose_ * last_given_->inverse() * frame.world_from_camera);
  const double ratio =
      static_cast<double>(frame.index - last_index_) / static_cast<double>(last_gap_);
  if (!lost_)
    poses.push_back(last_pose_ * small_motion(std::clamp(ratio, 0., 3.) * motion_of(last_motion_)));
  poses.push_back(last_pose_);
  poses.push_back(last_pose_ * turn_between(last_pyramid_, pyramid_));
  return poses;
}

bool Tracker::follow(const Frame& frame) {
  if (!reference_) return false;
  const auto gap = std::clamp<std::int64_t>(frame.index - last_index_, 1, kLongestGap);
  FrameAlignmentConfig config =
      config_.alignment;  // a prediction over several frames is that much worse
  config.prior_sigma_m *= static_cast<float>(gap),
      config.prior_sigma_rad *= static_cast<float>(gap);
  const std::optional<Alignment> alignment =
      align_best(*reference_, pyramid_, seen_from(*reference_, predictions(frame)), config);
  if (!alignment) return false;
  log_.back().quality = alignment->quality;
  if (!believable(alignment->quality, config_, lost_)) return false;
  const Pose pose = reference_->world_from_camera * alignment->reference_from_frame;
  const Pose step = last_pose_.inverse() * pose;
  const auto most = static_cast<double>(gap);
  if (step.translation().norm() > most * config_.max_step_m ||
      angle_of(step) > most * config_.max_step_rad)
    return false;
  accept(frame.index, *alignment, *reference_, lost_);
  if (frame.posed) last_given_ = frame.world_from_camera;
  // Frames that are far from their reference tell the most.
  if (!lost_ && (reference_is_old_ || reference_age_ % kListenEvery == 0))
    sensor_.add(reference_->levels[kSurfaceLevel], pyramid_[kSurfaceLevel],
                alignment->reference_from_frame, config_.alignment);
  return true;
}

void Tracker::accept(std::int64_t index, const Alignment& alignment, const Reference& reference,
                     bool relocated) {
  TrackedFrame& result = log_.back();
  result.tracked = true;
  result.relocated = relocated;
  result.world_from_camera = reference.world_from_camera * alignment.reference_from_frame;
  result.information = alignment.information;
  result.degenerate = alignment.degenerate;
  result.quality = alignment.quality;
  last_gap_ = std::max<std::int64_t>(1, index - last_index_);
  last_motion_ = relocated ? Pose::Identity() : last_pose_.inverse() * result.world_from_camera;
  last_pose_ = result.world_from_camera;
  last_index_ = index;
  last_given_.reset();
  // What something nearer hides is as much out of sight as what is beyond the image's edge; as much
  // as went now may go again before the next frame.
  const double overlap = alignment.quality.overlap * alignment.quality.agreement;
  const double next_overlap = overlap - std::max(0., last_overlap_ - overlap);
  last_overlap_ = overlap;
  reference_is_old_ = ++reference_age_ >= config_.reference_frames || relocated ||
                      next_overlap < config_.reference_overlap;
}

/// The map's surface from the last tracked pose, with that frame's intensities.
void Tracker::refresh_reference(const VoxelMap& map) {
  const Image<float> model =
      cast_inverse_depth(map, last_pyramid_[kSurfaceLevel].camera, last_pose_, config_.max_range_m);
  reference_ = make_reference(last_pyramid_, model, last_pose_);
  reference_is_old_ = false;
  reference_age_ = 0;
  last_overlap_ = 1;
}

bool Tracker::find_again(const VoxelMap& map) {
  const auto count = static_cast<std::size_t>(config_.place_candidates);
  const auto places = most_similar(place_code(pyramid_), codes_, count, config_.min_similarity);
  return std::any_of(places.begin(), places.end(),
                     [&](std::size_t place) { return try_place(keyframes_[place], map); });
}

/// Holds the frame against a place as the map has it, with the intensities of the keyframe.
bool Tracker::try_place(const Keyframe& keyframe, const VoxelMap& map) {
  const TrackPyramid place = pyramid_of(keyframe);
  const Image<float> model = cast_inverse_depth(map, keyframe.image.camera,
                                                keyframe.world_from_camera, config_.max_range_m);
  const Reference reference = make_reference(place, model, keyframe.world_from_camera);
  const std::optional<Alignment> alignment = align_best(
      reference, pyramid_, {Pose::Identity(), turn_between(place, pyramid_)}, config_.alignment);
  if (!alignment || !believable(alignment->quality, config_, true)) return false;
  accept(log_.back().index, *alignment, reference, true);
  return true;
}

void Tracker::keep_keyframe() {
  TrackedFrame& result = log_.back();
  if (!keyframes_.empty() && !result.relocated &&
      !config_.keyframes.far(keyframes_.back().world_from_camera, result.world_from_camera))
    return;
  keyframes_.push_back(
      make_keyframe(pyramid_, first_number_ + result.index, result.world_from_camera));
  codes_.push_back(keyframes_.back().code);
}

TrackSummary summarise(const std::vector<TrackedFrame>& log) {
  TrackSummary summary;
  summary.frames = log.size();
  bool lost = false;
  for (const TrackedFrame& frame : log) {
    summary.tracked += frame.tracked;
    summary.degenerate += frame.tracked && frame.degenerate > 0;
    summary.found_times += frame.tracked && lost;
    if (!frame.tracked && !lost) summary.lost.emplace_back(frame.index, frame.index);
    if (!frame.tracked) summary.lost.back().second = frame.index;
    lost = !frame.tracked;
  }
  summary.lost_times = summary.lost.size();
  return summary;
}

std::string summary_line(const TrackSummary& summary) {
  std::string line = concat("tracked ", summary.tracked, " of ", summary.frames, " frames, lost ",
                            summary.lost_times, summary.lost_times == 1 ? " time" : " times");
  constexpr std::size_t kMostNamed = 5;
  for (std::size_t i = 0; i < std::min(kMostNamed, summary.lost.size()); ++i) {
    const auto [first, last] = summary.lost[i];
    line += concat(i == 0 ? " (" : ", ", first == last ? concat("frame ", first)
                                                       : concat("frames ", first, " to ", last));
  }
  if (summary.lost.size() > kMostNamed) line += ", ...";
  if (!summary.lost.empty()) line += ")";
  return line;
}

std::string sensor_doubt(const SensorEvidence& evidence, const TrackConfig& config) {
  const auto focal = evidence.log_focal_ratio();
  if (!focal || !focal->beyond(static_cast<double>(config.focal_off),
                               static_cast<double>(config.focal_sigmas)))
    return {};
  return concat("the images say that the focal length is some ",
                std::lround(100 * std::fabs(std::expm1(focal->value))), " % ",
                focal->value > 0 ? "larger" : "smaller",
                " than given; check fx and fy of camera.yaml or of the recording");
}

}  // namespace ovimap
