// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/tracker.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/track/places/place_view.h"

namespace ovimap {

namespace {

constexpr std::int64_t kLongestGap = 6;  // frames; longer ones predict nothing more
constexpr int kAllDirections = 6;
constexpr float kProposed_m = 0.2f, kProposed_rad = 0.2f;  // how far off a proposed place may be
constexpr int kListenEvery = 5;  // frames; neighbours say the same of the sensor
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
    throw Error(concat("depth images are ", frame.depth_camera.width,
                       " pixels wide; a camera is "
                       "tracked by images of ",
                       kLeastWidth_px, " and more, others need poses"));
  pyramid_ = make_pyramid(frame);
  TrackedFrame result;
  result.index = frame.index, result.timestamp_s = frame.timestamp_s, result.name = frame.name;
  result.world_from_camera = last_pose_;
  result.dark = share_with_depth(pyramid_[kSurfaceLevel]) < config_.min_depth_share;
  if (frame.posed) result.given = frame.world_from_camera;
  log_.push_back(result);
  if (reference_is_old_) refresh_reference(map);
  const Pose before = last_pose_;
  const bool followed = begun_ && !lost_;
  bool found = false;
  if (!log_.back().dark) found = begun_ ? follow(frame) || find_again(frame, map) : start(frame);
  lost_ = begun_ && !found;
  if (found) {
    std::optional<Eigen::Matrix3d> turned;
    if (followed && !log_.back().relocated && log_.back().degenerate == 0)
      turned = (before.inverse() * last_pose_).linear();
    if (config_.gyroscope) gyroscope_.tracked(frame, turned);
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

void Tracker::propose(std::vector<Keyframe> places) {
  proposed_ = std::move(places);
  proposed_codes_.clear();
  for (const Keyframe& place : proposed_) proposed_codes_.push_back(place.code);
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
  return poses;
}

/// The same, turned since the last tracked frame as the gyroscope says.
std::vector<Pose> Tracker::turned(std::vector<Pose> predictions,
                                  const Eigen::Quaterniond& turn) const {
  for (Pose& pose : predictions) pose.linear() = last_pose_.linear() * turn.matrix();
  return predictions;
}

/// `prior_sigma_rad`: of how the camera turned in the starts, per frame.
std::optional<Alignment> Tracker::aligned(const std::vector<Pose>& starts, float prior_sigma_rad,
                                          std::int64_t gap) const {
  FrameAlignmentConfig config =
      config_.alignment;  // a prediction over several frames is that much worse
  config.prior_sigma_m *= static_cast<float>(gap);
  config.prior_sigma_rad = prior_sigma_rad * static_cast<float>(gap);
  return align_best(*reference_, pyramid_, seen_from(*reference_, starts), config);
}

/// A gyroscope that the images have confirmed goes first, another after them. Whoever comes second
/// is asked where the first leaves a doubt.
std::optional<Alignment> Tracker::best_alignment(const Frame& frame, std::int64_t gap) const {
  std::vector<Pose> starts = predictions(frame);
  std::optional<Alignment> best;
  const auto ask = [&](const std::vector<Pose>& from, float prior_sigma_rad) {
    if (best && beyond_doubt(best->quality)) return;
    std::optional<Alignment> found = aligned(from, prior_sigma_rad, gap);
    if (found && (!best || found->quality.cost < best->quality.cost)) best = std::move(found);
  };
  const auto turn = gyroscope_.turn_to(frame);
  const std::vector<Pose> told = turn ? turned(starts, *turn) : std::vector<Pose>();
  if (turn && gyroscope_.is_confirmed()) ask(told, config_.gyroscope_sigma_rad);
  starts.push_back(last_pose_ * turn_between(last_pyramid_, pyramid_));
  ask(starts, config_.alignment.prior_sigma_rad);
  if (turn && !gyroscope_.is_confirmed()) ask(told, config_.gyroscope_sigma_rad);
  return best;
}

bool Tracker::follow(const Frame& frame) {
  if (!reference_) return false;
  const auto gap = std::clamp<std::int64_t>(frame.index - last_index_, 1, kLongestGap);
  const std::optional<Alignment> alignment = best_alignment(frame, gap);
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
                alignment->reference_from_frame, motion_change(alignment->reference_from_frame),
                config_.alignment);
  return true;
}

/// How the camera moves now, less how it moved at the reference.
std::optional<Vector6d> Tracker::motion_change(const Pose& reference_from_frame) const {
  if (!speed_ || !reference_speed_) return std::nullopt;
  const Vector6d turned =
      motion_of(reference_from_frame * small_motion(*speed_) * reference_from_frame.inverse());
  return turned - *reference_speed_;
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
  const bool steady = reference_ && !relocated;  // else there is no frame before, or far away
  last_motion_ = steady ? last_pose_.inverse() * result.world_from_camera : Pose::Identity();
  speed_.reset();
  if (steady) speed_ = motion_of(last_motion_) / static_cast<double>(last_gap_);
  last_pose_ = result.world_from_camera;
  last_index_ = index;
  last_given_.reset();
  // What something nearer hides is as much out of sight as what is beyond the image's edge; as much
  // as went now may go again before the next frame.
  const double overlap = alignment.quality.overlap * alignment.quality.agreement;
  const double next_overlap = overlap - std::max(0., last_overlap_ - overlap);
  last_overlap_ = overlap;
  ++reference_age_;
  if (reference_age_ == 1 && !reference_speed_) reference_speed_ = speed_;  // at most a frame later
  reference_is_old_ = reference_age_ >= config_.reference_frames || relocated ||
                      next_overlap < config_.reference_overlap;
}

/// The map's surface from the last tracked pose, with that frame's intensities, settled where
/// its depth contradicts the map.
void Tracker::refresh_reference(const VoxelMap& map) {
  TrackLevel& level = last_pyramid_[kSurfaceLevel];
  Image<float> model = cast_inverse_depth(map, level.camera, last_pose_, config_.max_range_m);
  settle_contradictions(config_.alignment.noise, config_.alignment.model_sigma_m, model, level);
  reference_ = make_reference(last_pyramid_, model, last_pose_);
  reference_is_old_ = false;
  reference_age_ = 0;
  reference_speed_ = speed_;
  last_overlap_ = 1;
}

bool Tracker::find_again(const Frame& frame, const VoxelMap& map) {
  if (const auto turn = gyroscope_.turn_to(frame); turn && !keyframes_.empty())
    if (try_view(turned({last_pose_}, *turn).front(), map)) return true;
  const auto count = static_cast<std::size_t>(config_.place_candidates);
  const auto places = most_similar(place_code(pyramid_), codes_, count, config_.min_similarity);
  if (std::any_of(places.begin(), places.end(), [&](std::size_t place) {
        return try_place(keyframes_[place], map, kAllDirections, config_.alignment);
      }))
    return true;
  const auto told =
      most_similar(place_code(pyramid_), proposed_codes_, count, config_.min_similarity);
  return std::any_of(told.begin(), told.end(),
                     [&](std::size_t place) { return try_proposed(proposed_[place], map); });
}

/// Holds the frame against what the keyframes around a pose show together from there. Nothing but a
/// prediction speaks for the pose, so what the images do not tell is not taken from it.
bool Tracker::try_view(const Pose& world_from_camera, const VoxelMap& map) {
  const auto count = static_cast<std::size_t>(config_.place_candidates);
  const std::vector<Keyframe> near = nearest_keyframes(keyframes_, world_from_camera, count);
  Keyframe view{0, world_from_camera, {}, {}};
  view.image = place_view(near, near.front().image.camera, world_from_camera);
  return try_place(view, map, 0, config_.alignment);
}

/// Holds the frame against a place as the map has it, with the intensities of the keyframe.
/// `most_degenerate`: directions that the images need not tell.
bool Tracker::try_place(const Keyframe& keyframe, const VoxelMap& map, int most_degenerate,
                        const FrameAlignmentConfig& config) {
  const TrackPyramid place = pyramid_of(keyframe);
  const Image<float> model = cast_inverse_depth(map, keyframe.image.camera,
                                                keyframe.world_from_camera, config_.max_range_m);
  const Reference reference = make_reference(place, model, keyframe.world_from_camera);
  const std::optional<Alignment> alignment =
      align_best(reference, pyramid_, {Pose::Identity(), turn_between(place, pyramid_)}, config);
  if (!alignment || alignment->degenerate > most_degenerate ||
      !believable(alignment->quality, config_, true))
    return false;
  accept(log_.back().index, *alignment, reference, true);
  return true;
}

/// What the map does not have of the place must not speak for it, nor its own images for where it
/// is said to be: depth alone says where in the map the frame is.
bool Tracker::try_proposed(Keyframe place, const VoxelMap& map) {
  const Image<float> model =
      cast_inverse_depth(map, place.image.camera, place.world_from_camera, config_.max_range_m);
  place.image.intensity.fill(-1);
  FrameAlignmentConfig by_depth = config_.alignment;
  by_depth.prior_sigma_m = kProposed_m;
  by_depth.prior_sigma_rad = kProposed_rad;
  return keep_what_map_has(model, place.image) >= static_cast<double>(config_.min_overlap) &&
         try_place(place, map, kAllDirections, by_depth);
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
    summary.unplaced += !frame.tracked && summary.tracked == 0;
    summary.degenerate += frame.tracked && frame.degenerate > 0;
    summary.found_times += frame.tracked && lost;
    if (!frame.tracked && !lost) summary.lost.emplace_back(frame.index, frame.index);
    if (!frame.tracked) summary.lost.back().second = frame.index;
    lost = !frame.tracked;
  }
  summary.lost_times = summary.lost.size();
  return summary;
}

std::vector<std::pair<std::int64_t, std::int64_t>> unknown_places(
    const std::vector<TrackedFrame>& log, int least) {
  std::vector<std::pair<std::int64_t, std::int64_t>> places;
  for (std::size_t begin = 0; begin < log.size();) {
    std::size_t end = begin;
    int seen = 0;
    for (; end < log.size() && !log[end].tracked; ++end) seen += !log[end].dark;
    if (seen > 0 && seen >= least) places.emplace_back(log[begin].index, log[end - 1].index);
    begin = std::max(end, begin + 1);
  }
  return places;
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

}  // namespace ovimap
