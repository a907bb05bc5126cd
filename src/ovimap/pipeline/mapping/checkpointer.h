// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "ovimap/io/map_file/map_checkpoint.h"
#include "ovimap/pipeline/mapping/mapper.h"
#include "ovimap/pipeline/mapping/tile_keeper.h"

namespace ovimap {

struct CheckpointConfig {
  float seconds = 10;  ///< between checkpoints; 0: time makes none
  int frames = 0;      ///< between checkpoints; 0: their number makes none
};
void list_fields(CheckpointConfig& config, ConfigFields& fields);

/// Stores a map while it is made, beside the mapping: what changed since the last time is frozen in
/// a moment (VoxelMap::freeze) and written by another thread while the mapper goes on. One
/// checkpoint at a time; when the disk is slow there are fewer. Also keeps the map within a bound
/// on memory: tiles leave it between checkpoints, so that the mapper waits for one that is being
/// written. The map must outlive it.
class Checkpointer {
 public:
  /// `tiles`: where the map is stored; opens nothing before the first checkpoint is due. `frames`:
  /// how many the map has already.
  Checkpointer(std::shared_ptr<TileKeeper> tiles, const CheckpointConfig& config, MapHeader header,
               std::size_t frames);
  /// Waits for what is being written.
  ~Checkpointer();

  /// Call after every frame and every change of labels. Throws Error when the checkpoint before
  /// could not be written; the one before that stays.
  void after_frame(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                   const PinholeCamera& depth_camera);
  /// Call now and then while no frame comes: what a pause leaves time for is stored as well. Throws
  /// what after_frame throws.
  void while_waiting(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                     const PinholeCamera& depth_camera);
  /// Throws Error when the bound on memory, if there is one, is less than what the last frame
  /// needs: so will be that of most others. A live run goes on; what one frame needs leaves with
  /// it.
  void require_room(const Mapper& mapper) const;
  /// The last frame is fused, or many blocks are about to change: waits for what is being written,
  /// if tiles may have to leave memory from here on.
  void let_tiles_leave(Mapper& mapper);
  /// Stores everything by now and waits for it, unless there are no checkpoints (CheckpointConfig):
  /// what comes next takes long. Throws what after_frame throws.
  void store(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
             const PinholeCamera& depth_camera);
  /// Adds what tiles' leaving memory and coming back took (TileKeeper::report).
  void report(StageTimers& timers) { tiles_->report(timers); }
  /// The log of corrections, as later checkpoints keep it.
  void set_edits(MapEdits edits);
  /// The map is saved: no checkpoint is needed any more.
  void remove();

 private:
  bool off() const { return config_.seconds <= 0 && config_.frames <= 0; }
  bool due(std::size_t frames) const;
  void begin(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
             const PinholeCamera& depth_camera);
  void freeze_changes(VoxelMap& map);
  void go_on_writing(Mapper& mapper);
  void finish_writing(Mapper& mapper);
  void make_room(Mapper& mapper);

  std::shared_ptr<TileKeeper> tiles_;
  CheckpointConfig config_;
  MapHeader header_;
  std::chrono::steady_clock::time_point last_;
  std::size_t last_frames_;
  bool news_ = false;  ///< since then

  // The checkpoint under way.
  std::optional<MapCheckpoint> next_;
  std::shared_ptr<PendingLooks> looks_;  ///< of next_, until the encoder has answered
  std::future<void> writing_;            ///< valid while next_ is being written
};

}  // namespace ovimap
