// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/checkpointer.h"

#include "ovimap/base/config.h"
#include "ovimap/base/thread_priority.h"
#include "ovimap/io/map_file_access.h"
#include "ovimap/map/block_tiles.h"

namespace ovimap {

void list_fields(CheckpointConfig& config, ConfigFields& fields) {
  fields.add("seconds", config.seconds, 0.f, 1e6f,
             "time between checkpoints of a run; 0: no checkpoint for time's sake");
  fields.add("frames", config.frames, 0, 1 << 30, "frames between checkpoints; 0: likewise");
}

Checkpointer::Checkpointer(std::filesystem::path path, const CheckpointConfig& config,
                           MapHeader header, std::size_t frames, CheckpointFile::Start start)
    : path_(std::move(path)),
      config_(config),
      header_(std::move(header)),
      start_(start),
      last_(std::chrono::steady_clock::now()),
      last_frames_(frames) {}

Checkpointer::~Checkpointer() {
  if (writing_.valid()) writing_.wait();
}

void Checkpointer::after_frame(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                               const PinholeCamera& depth_camera) {
  if (off()) return;
  note_changes(mapper);
  if (next_) return go_on_writing(mapper);
  if (!due(frames.size())) return;
  begin(mapper, frames, depth_camera);
  go_on_writing(mapper);
}

bool Checkpointer::due(std::size_t frames) const {
  const std::chrono::duration<float> passed = std::chrono::steady_clock::now() - last_;
  return (config_.seconds > 0 && passed.count() >= config_.seconds) ||
         (config_.frames > 0 && frames >= last_frames_ + static_cast<std::size_t>(config_.frames));
}

void Checkpointer::note_changes(const Mapper& mapper) {
  std::optional<std::uint64_t> last;  // most blocks lie in the tile of the one before
  for (const std::uint32_t slot : mapper.touched_blocks()) {
    const std::uint64_t key = tile_key(mapper.map().block_index(slot));
    if (key != last) changed_.insert(key);
    last = key;
  }
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
  looks_ = mapper.remember_appearances();
  last_ = std::chrono::steady_clock::now();
  last_frames_ = frames.size();
}

void Checkpointer::freeze_changes(VoxelMap& map) {
  if (!file_ && start_ == CheckpointFile::Start::kAnew)
    for (const Tile& tile : tiles_of(map)) changed_.insert(tile.key);
  std::vector<std::uint32_t> slots;
  for (const std::uint64_t key : changed_) {
    const Tile tile = tile_at(map, key);
    slots.insert(slots.end(), tile.slots.begin(), tile.slots.end());
    next_->tiles.push_back({key, tile.present, std::vector<const VoxelBlock*>(tile.slots.size())});
  }
  changed_.clear();
  const std::vector<const VoxelBlock*> frozen = map.freeze(slots);
  auto block = frozen.begin();
  for (ChangedTile& tile : next_->tiles)
    for (const VoxelBlock*& place : tile.blocks) place = *block++;
}

void Checkpointer::go_on_writing(Mapper& mapper) {
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    auto t = mapper.timers().measure("checkpoint_end");
    mapper.map().thaw();
    next_.reset();
    writing_.get();
  } else if (looks_->complete()) {
    next_->record.semantics.appearances = looks_->take();
    looks_.reset();
    writing_ = std::async(std::launch::async, [this] {
      lower_thread_priority();
      if (!file_) file_.emplace(path_, start_);
      file_->write(*next_);
    });
  }
}

void Checkpointer::remove() {
  if (writing_.valid()) writing_.wait();
  if (file_)
    file_->remove();
  else  // what an earlier run left, be it a checkpoint or the beginning of one
    remove_map(path_);
}

}  // namespace ovimap
