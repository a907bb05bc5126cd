// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "ovimap/track/alignment/sensor_evidence.h"
#include "ovimap/track/gyroscope_prior.h"
#include "ovimap/track/places/track_config.h"

namespace ovimap {

/// What the tracker made of a frame.
struct TrackedFrame {
  std::int64_t index = 0;  ///< of the frame in its source
  double timestamp_s = 0;
  std::string name;
  bool tracked = false;    ///< else lost: the pose is the last one known, and means nothing
  bool relocated = false;  ///< found again in this frame
  bool dark = false;       ///< too little depth to be tracked by
  Pose world_from_camera = Pose::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< as Alignment has it
  int degenerate = 0;
  AlignmentQuality quality;
  std::optional<Pose> given;  ///< the pose that came with the frame, in its own world
};

struct TrackSummary {
  std::size_t frames = 0, tracked = 0, lost_times = 0, found_times = 0, degenerate = 0;
  std::size_t unplaced = 0;  ///< frames before the first whose place in a begun map was known
  std::vector<std::pair<std::int64_t, std::int64_t>> lost;  ///< first and last index, in order
};

/// Follows a camera through a map that is made from its frames. A frame is tracked against the
/// map's surface as the last reference pose sees it; whoever fuses tracked frames into the map does
/// so before the next one comes.
class Tracker {
 public:
  explicit Tracker(const TrackConfig& config) : config_(config) {}

  /// Where the frame was taken. The first frame with depth is the world, or where its own pose is
  /// (`frame.posed`); later poses of frames predict motion and do no more, and so do orientations.
  const TrackedFrame& track(const Frame& frame, const VoxelMap& map);

  /// Begins in a map that is there already, whose places these are: the first frame is one that is
  /// to be found.
  void begin_in(std::vector<Keyframe> places);

  /// Places of which something else than images says where in the map they lie: a frame that is
  /// lost and like no keyframe is held against what the map has of them. They become no keyframes.
  void propose(std::vector<Keyframe> places);

  /// Keyframes get numbers from there on: that of frame 0. Before the first frame.
  void number_from(std::int64_t first) { first_number_ = first; }

  /// Moves the keyframes to these poses, and with the last of them the camera: a loop was closed.
  /// What was logged stays. The map must be that of the new poses when the next frame comes.
  void correct(const std::vector<Pose>& poses);

  const std::vector<TrackedFrame>& log() const { return log_; }
  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  const TrackConfig& config() const { return config_; }
  /// What the frames so far say of the camera.
  const SensorEvidence& sensor() const { return sensor_; }
  const GyroscopePrior& gyroscope() const { return gyroscope_; }

 private:
  bool start(const Frame& frame);
  bool follow(const Frame& frame);
  bool find_again(const Frame& frame, const VoxelMap& map);
  bool try_view(const Pose& world_from_camera, const VoxelMap& map);
  bool try_place(const Keyframe& keyframe, const VoxelMap& map, int most_degenerate,
                 const FrameAlignmentConfig& config);
  bool try_proposed(Keyframe place, const VoxelMap& map);
  std::vector<Pose> predictions(const Frame& frame) const;
  std::optional<Alignment> best_alignment(const Frame& frame, std::int64_t gap) const;
  std::optional<Alignment> aligned(const std::vector<Pose>& starts, float prior_sigma_rad,
                                   std::int64_t gap) const;
  std::vector<Pose> turned(std::vector<Pose> predictions, const Eigen::Quaterniond& turn) const;
  void accept(std::int64_t index, const Alignment& alignment, const Reference& reference,
              bool relocated);
  void refresh_reference(const VoxelMap& map);
  std::optional<Vector6d> motion_change(const Pose& reference_from_frame) const;
  void keep_keyframe();

  TrackConfig config_;
  TrackPyramid pyramid_, last_pyramid_;  ///< of the present frame and of the last tracked one
  std::optional<Reference> reference_;
  bool reference_is_old_ = false;
  int reference_age_ = 0;
  double last_overlap_ = 1;  ///< of the last tracked frame with the reference
  Pose last_pose_ = Pose::Identity();
  Pose last_motion_ = Pose::Identity();  ///< last camera from the one before
  /// Of the camera, from frame to frame, in its own frame: at the last tracked one and at the one
  /// from whose pose the reference was cast; nullopt: found there, so not known.
  std::optional<Vector6d> speed_, reference_speed_;
  std::int64_t first_number_ = 0;
  std::int64_t last_index_ = 0;
  std::int64_t last_gap_ = 1;       ///< frames between those
  std::optional<Pose> last_given_;  ///< pose that came with that frame
  SensorEvidence sensor_;
  GyroscopePrior gyroscope_;
  bool begun_ = false, lost_ = false;
  std::vector<TrackedFrame> log_;
  std::vector<Keyframe> keyframes_;
  std::vector<PlaceCode> codes_;
  std::vector<Keyframe> proposed_;
  std::vector<PlaceCode> proposed_codes_;
};

TrackSummary summarise(const std::vector<TrackedFrame>& log);
/// Frames on end, first and last index, in which the camera was lost and `least` of which or more
/// have depth: they show a place of which nothing says where it lies.
std::vector<std::pair<std::int64_t, std::int64_t>> unknown_places(
    const std::vector<TrackedFrame>& log, int least);
/// "tracked 498 of 500 frames, lost 1 time (frames 100 to 101)".
std::string summary_line(const TrackSummary& summary);

}  // namespace ovimap
