// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served/live_feed.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "ovimap/base/thread_priority.h"
#include "ovimap/io/pictures/scene_axes.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/map/surface/surface_precision.h"

namespace ovimap {

namespace {

constexpr double kMostBurst_s = 0.5;     // of the allowance
constexpr std::size_t kMostSlots = 512;  // at once: no frame shall wait long
constexpr double kNewSlotsWeight = 0.2;  // of the latest figure in the running mean

Mesh with_normals(Mesh mesh) {
  add_normals(mesh);
  return mesh;
}

/// Adds the objects, as they are seen on the surface that clients have.
void name_objects(const ServedSurface& surface, const InstanceSummaryConfig& config,
                  const MapEdits& edits, FoundMap& found) {
  const Mesh mesh = joined_surface(surface);
  InstanceRegistry registry(found.record.instance_config);
  registry.restore(found.record.registry);
  found.record.instances = find_instances(mesh, found.forest, registry, config, edits);
  std::vector<Pose> poses;
  for (const FrameLogEntry& frame : found.record.frames) poses.push_back(frame.world_from_camera);
  found.record.up = guess_up(mesh, poses);
}

std::string pose_json(const FrameLogEntry& frame, std::size_t count) {
  std::string pose;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      pose += concat(pose.empty() ? "" : ",", frame.world_from_camera.matrix()(row, column));
  return concat("{\"frames\":", count, ",\"index\":", frame.index, ",\"world_from_camera\":[", pose,
                "]}");
}

}  // namespace

LiveFeed::LiveFeed(ServedMap& map, const LiveFeedConfig& config)
    : map_(map),
      config_(config),
      names_(map.snapshot()->record->names),
      allowed_until_(Clock::now()),
      publisher_([this] { publish(); }) {}

LiveFeed::~LiveFeed() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  publisher_.join();
}

// -------------------------------------------------------------------------------- fusing thread

void LiveFeed::after_frame(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                           const PinholeCamera& depth_camera) {
  if (waits_.empty()) note_all(mapper.map());  // of an earlier run that this one goes on with
  note_changes(mapper.touched_blocks());
  if (Clock::now() >= next_pose_) send_pose(frames);
  objects_wait_ = true;
  while_waiting(mapper, frames, depth_camera);
}

void LiveFeed::while_waiting(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                             const PinholeCamera& depth_camera) {
  if (Clock::now() >= next_mesh_) hand_over_surface(mapper);
  if (objects_wait_) hand_over_objects(mapper, frames, depth_camera);
}

void LiveFeed::note_all(const VoxelMap& map) {
  std::vector<std::uint32_t> slots(map.block_count());
  std::iota(slots.begin(), slots.end(), 0u);
  note_changes(slots);
}

void LiveFeed::note_changes(const std::vector<std::uint32_t>& slots) {
  for (const std::uint32_t slot : slots) {
    if (slot >= waits_.size()) waits_.resize(slot + 1, false);
    if (waits_[slot]) continue;
    waits_[slot] = true;
    dirty_.push_back(slot);
  }
}

void LiveFeed::send_pose(const std::vector<FrameLogEntry>& frames) {
  next_pose_ = Clock::now() + config_.pose_interval;
  map_.events().publish("frame", pose_json(frames.back(), frames.size()));
}

void LiveFeed::after_tracking(const TrackedFrame& frame) {
  const auto now = Clock::now();
  const bool was_lost = tracking_.state == CameraState::kLost;
  if (frame.tracked) {
    tracking_.world_from_camera = frame.world_from_camera;
    const bool news = was_lost || tracking_.state == CameraState::kGiven;
    tracking_.state = CameraState::kTracked;
    tracking_.frames_lost = 0;
    if (news) map_.show(tracking_);
    return;
  }
  ++tracking_.frames_lost;
  if (was_lost && now < next_lost_) return;
  next_lost_ = now + config_.lost_interval;
  tracking_.state = CameraState::kLost;
  map_.show(tracking_);
}

/// As many of the slots that wait as the allowance is good for.
std::vector<std::uint32_t> LiveFeed::next_slots() {
  const auto now = Clock::now();
  allowance_ +=
      std::chrono::duration<double>(now - allowed_until_).count() * config_.vertices_per_s;
  allowance_ = std::min(allowance_, kMostBurst_s * config_.vertices_per_s);
  allowed_until_ = now;
  const auto affordable =
      static_cast<std::size_t>(std::max(0., allowance_ / std::max(vertices_per_slot_, 1.)));
  const std::size_t count = std::min({affordable, dirty_.size(), kMostSlots});
  const std::vector<std::uint32_t> slots(dirty_.begin(),
                                         dirty_.begin() + static_cast<std::ptrdiff_t>(count));
  dirty_.erase(dirty_.begin(), dirty_.begin() + static_cast<std::ptrdiff_t>(count));
  for (const std::uint32_t slot : slots) waits_[slot] = false;
  return slots;
}

void LiveFeed::hand_over_surface(Mapper& mapper) {
  const auto start = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    if (!patches_.empty()) return;  // the publisher has no time: what waits must not pile up
  }
  const std::vector<std::uint32_t> slots = next_slots();
  if (slots.empty()) return;
  auto t = mapper.timers().measure("show_surface");
  std::vector<SurfacePatch> patches;
  std::size_t vertices = 0;
  for (const std::uint32_t slot : mesh_.update(mapper.map(), slots)) {
    const MeshPatch* patch = mesh_.patch(slot);
    if (slot >= shown_.size()) shown_.resize(slot + 1, false);
    if (patch == nullptr && !shown_[slot]) continue;
    shown_[slot] = patch != nullptr;
    const VoxelMap& map = mapper.map();
    patches.push_back(
        {map.block_index(slot), 0, patch ? std::make_shared<Mesh>(patch->mesh) : nullptr,
         patch ? error_byte(surface_error_m(map, map.block(slot))) : std::uint8_t{0}});
    if (patch) vertices += patch->mesh.vertices.size();
  }
  allowance_ -= static_cast<double>(vertices);
  vertices_per_slot_ +=
      kNewSlotsWeight *
      (static_cast<double>(vertices) / static_cast<double>(slots.size()) - vertices_per_slot_);
  next_mesh_ = pause_after(start, config_.surface_share, config_.mesh_interval);
  {
    const std::lock_guard lock(mutex_);
    patches_ = std::move(patches);
  }
  changed_.notify_one();
}

void LiveFeed::hand_over_objects(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                                 const PinholeCamera& depth_camera) {
  const auto start = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    if (busy_ || found_ || start < next_objects_) return;
  }
  auto t = mapper.timers().measure("show_objects");
  FoundMap found;
  found.record.instance_config = mapper.config().instance;
  found.record.registry = mapper.registry().state();
  found.record.semantics.views = mapper.config().semantics.views;
  found.record.semantics.crops = mapper.config().semantics.crops;
  if (mapper.encoder()) found.record.semantics.encoder = mapper.encoder()->identity();
  found.record.semantics.recognizer = mapper.recognizer();
  found.record.semantics.looks = mapper.looks();
  found.record.frames = frames;
  found.record.seen_free = mapper.seen_free();
  found.record.depth_camera = depth_camera;
  found.record.mask_frames = mapper.mask_frames();
  found.record.names = names_;
  found.forest = mapper.map().labels();
  found.info.voxel_size_m = mapper.map().config().voxel_size_m;
  found.info.blocks = mapper.map().block_count();
  const std::lock_guard lock(mutex_);
  found_ = std::move(found);
  summary_ = mapper.config().summary;
  next_objects_ = pause_after(start, config_.objects_share, config_.objects_interval);
  objects_wait_ = !dirty_.empty();  // they are found on the surface that clients have
  changed_.notify_one();
}

/// Until when to leave the mapping alone, so that what began at `start` takes no more than its
/// share.
LiveFeed::Clock::time_point LiveFeed::pause_after(Clock::time_point start, double share,
                                                  std::chrono::milliseconds least) {
  const auto now = Clock::now();
  const auto pause = std::chrono::duration_cast<Clock::duration>((now - start) / share);
  return now + std::max<Clock::duration>(least, pause);
}

// ------------------------------------------------------------------------------------ publisher

void LiveFeed::publish() {
  lower_thread_priority();
  std::unique_lock lock(mutex_);
  while (!ending_) {
    changed_.wait(lock, [&] { return ending_ || !patches_.empty() || found_; });
    std::vector<SurfacePatch> patches = std::exchange(patches_, {});
    std::optional<FoundMap> found = std::exchange(found_, std::nullopt);
    const InstanceSummaryConfig summary = summary_;
    busy_ = found.has_value();
    lock.unlock();
    for (SurfacePatch& patch : patches)
      if (patch.mesh) patch.mesh = std::make_shared<Mesh>(with_normals(*patch.mesh));
    if (!patches.empty()) map_.show(std::move(patches));
    const auto start = Clock::now();
    if (found) {
      name_objects(*map_.surface(), summary, map_.snapshot()->record->edits, *found);
      map_.show(std::move(*found));
    }
    lock.lock();
    if (busy_)
      next_objects_ =
          std::max(next_objects_, Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                     (Clock::now() - start) / config_.spare_share));
    busy_ = false;
  }
}

}  // namespace ovimap
