// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "ovimap/map/surface/incremental_mesh.h"
#include "ovimap/pipeline/mapping/mapper.h"
#include "ovimap/server/served/served_map.h"
#include "ovimap/track/tracker.h"

namespace ovimap {

struct LiveFeedConfig {
  double surface_share = 0.03;    ///< of the fusing thread's time that goes to making patches
  double objects_share = 0.01;    ///< ... and to copying what is known of objects
  double spare_share = 0.05;      ///< of one core that naming what objects there are may take
  double vertices_per_s = 50000;  ///< of the surface that are sent at most
  std::chrono::milliseconds mesh_interval{200};
  std::chrono::milliseconds objects_interval{1000};
  std::chrono::milliseconds pose_interval{100};
  std::chrono::milliseconds lost_interval{1000};  ///< between saying again that the camera is lost
};

/// Shows clients a map while it is made. What happens on the fusing thread is copying, bounded by a
/// share of its time; the rest is done by a thread that lets mapping go first. Clients only read
/// what that thread leaves, so that none of them can hold up the mapping.
class LiveFeed {
 public:
  explicit LiveFeed(ServedMap& map, const LiveFeedConfig& config = {});
  /// Call when the mapping has ended.
  ~LiveFeed();

  /// Call after every frame and every change of labels, on the fusing thread.
  void after_frame(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                   const PinholeCamera& depth_camera);
  /// Call now and then while no frame comes, on the fusing thread: shows what the pace of frames
  /// left no time for.
  void while_waiting(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                     const PinholeCamera& depth_camera);
  /// Call with what the tracker made of each frame, on the fusing thread: clients hear when the
  /// camera is lost and from where it can be found again, and when it is found.
  void after_tracking(const TrackedFrame& frame);

 private:
  using Clock = std::chrono::steady_clock;

  void note_all(const VoxelMap& map);
  void note_changes(const std::vector<std::uint32_t>& slots);
  void send_pose(const std::vector<FrameLogEntry>& frames);
  void hand_over_surface(Mapper& mapper);
  std::vector<std::uint32_t> next_slots();
  void hand_over_objects(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                         const PinholeCamera& depth_camera);
  static Clock::time_point pause_after(Clock::time_point start, double share,
                                       std::chrono::milliseconds least);
  void publish();

  ServedMap& map_;
  const LiveFeedConfig config_;
  const std::map<InstanceId, std::string> names_;  ///< that the map had before

  // The fusing thread's.
  IncrementalMesh mesh_;
  std::deque<std::uint32_t> dirty_;  ///< slots, those that wait longest first
  std::vector<bool> waits_;          ///< by slot: whether it is in dirty_
  std::vector<bool> shown_;          ///< by slot: whether clients know surface of it
  double allowance_ = 0;             ///< vertices that may be sent
  double vertices_per_slot_ = 50;
  bool objects_wait_ = false;  ///< for what is known of them by now to be shown
  Clock::time_point allowed_until_, next_mesh_, next_pose_, next_lost_;
  CameraTracking tracking_;  ///< what clients know

  std::mutex mutex_;  ///< guards what follows; held for a moment only
  std::condition_variable changed_;
  std::vector<SurfacePatch> patches_;
  std::optional<FoundMap> found_;
  InstanceSummaryConfig summary_;
  Clock::time_point next_objects_;
  bool busy_ = false;  ///< objects are being named
  bool ending_ = false;
  std::thread publisher_;
};

}  // namespace ovimap
