// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/checkpointer.h"

#include "ovimap/base/config.h"
#include "ovimap/base/thread_priority.h"

namespace ovimap {

void list_fields(CheckpointConfig& config, ConfigFields& fields) {
  fields.add("seconds", config.seconds, 0.f, 1e6f,
             "time between checkpoints of a run; 0: no checkpoint for time's sake");
  fields.add("frames", config.frames, 0, 1 << 30, "frames between checkpoints; 0: likewise");
}

Checkpointer::Checkpointer(std::shared_ptr<TileKeeper> tiles, const CheckpointConfig& config,
                           MapHeader header, std::size_t frames)
    : tiles_(std::move(tiles)),
      config_(config),
      header_(std::move(header)),
      last_(std::chrono::steady_clock::now()),
      last_frames_(frames) {}

Checkpointer::~Checkpointer() {
  if (writing_.valid()) writing_.wait();
}

void Checkpointer::after_frame(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                               const PinholeCamera& depth_camera) {
  if (off() && !tiles_->bounded()) return;
  tiles_->note_changes(mapper.map(), mapper.touched_blocks());
  news_ = true;
  while_waiting(mapper, frames, depth_camera);
}

void Checkpointer::while_waiting(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                                 const PinholeCamera& depth_camera) {
  if (!next_ && news_ && due(frames.size())) begin(mapper, frames, depth_camera);
  if (next_) go_on_writing(mapper);
  if (tiles_->bounded()) make_room(mapper);  // whoever shows the map reads voxels meanwhile
}

void Checkpointer::set_edits(MapEdits edits) {
  news_ |= edits.size() != header_.edits.size();
  header_.edits = std::move(edits);
}

void Checkpointer::make_room(Mapper& mapper) {
  VoxelMap& map = mapper.map();
  if (!map.has_store()) map.keep_in(tiles_);
  map.set_room(tiles_->bound_bytes());
  if (tiles_->wants_room(map)) finish_writing(mapper);
  map.trim();
}

void Checkpointer::require_room(const Mapper& mapper) const {
  tiles_->require_room(mapper.map());
}

void Checkpointer::let_tiles_leave(Mapper& mapper) {
  if (tiles_->bounded()) finish_writing(mapper);
}

void Checkpointer::store(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                         const PinholeCamera& depth_camera) {
  if (off()) return;
  finish_writing(mapper);
  begin(mapper, frames, depth_camera);
  finish_writing(mapper);
}

bool Checkpointer::due(std::size_t frames) const {
  const std::chrono::duration<float> passed = std::chrono::steady_clock::now() - last_;
  return (config_.seconds > 0 && passed.count() >= config_.seconds) ||
         (config_.frames > 0 && frames >= last_frames_ + static_cast<std::size_t>(config_.frames));
}

void Checkpointer::begin(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                         const PinholeCamera& depth_camera) {
  auto t = mapper.timers().measure("checkpoint");
  next_.emplace();
  next_->record = mapper.record(header_, frames, depth_camera);
  next_->record.unfinished = true;
  next_->map_config = mapper.map().config();
  next_->labels = mapper.map().labels();
  next_->blocks = mapper.map().block_count();
  freeze_changes(mapper.map());
  looks_ = mapper.remember_looks();
  last_ = std::chrono::steady_clock::now();
  last_frames_ = frames.size();
  news_ = false;
}

void Checkpointer::freeze_changes(VoxelMap& map) {
  std::vector<std::uint32_t> slots;
  for (const Tile& tile : tiles_->take_changed(map)) {
    slots.insert(slots.end(), tile.slots.begin(), tile.slots.end());
    next_->tiles.push_back(
        {tile.key, tile.present, std::vector<const VoxelBlock*>(tile.slots.size())});
  }
  const std::vector<const VoxelBlock*> frozen = map.freeze(slots);
  auto block = frozen.begin();
  for (ChangedTile& tile : next_->tiles)
    for (const VoxelBlock*& place : tile.blocks) place = *block++;
}

void Checkpointer::go_on_writing(Mapper& mapper) {
  if (looks_ && !looks_->complete()) mapper.take_embeddings();  // in a pause nobody else does
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    auto t = mapper.timers().measure("checkpoint_end");
    mapper.map().thaw();
    next_.reset();
    writing_.get();
  } else if (looks_->complete()) {
    next_->record.semantics.looks = looks_->take();
    looks_.reset();
    writing_ = std::async(std::launch::async, [this] {
      lower_thread_priority();
      tiles_->file().write(*next_);
    });
  }
}

void Checkpointer::finish_writing(Mapper& mapper) {
  if (!next_) return;
  if (looks_) {
    mapper.await_encoder();
    go_on_writing(mapper);
  }
  auto t = mapper.timers().measure("await_checkpoint");
  writing_.wait();
  go_on_writing(mapper);
}

void Checkpointer::remove() {
  if (writing_.valid()) writing_.wait();
  tiles_->remove();
}

}  // namespace ovimap
