// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served/served_map.h"

#include "ovimap/base/thread_priority.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/corrections/map_corrections.h"
#include "ovimap/io/corrections/map_edit_desk.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/map_file/saved_tiles.h"
#include "ovimap/pipeline/rooms/map_rooms.h"
#include "ovimap/pipeline/search/teaching.h"

namespace ovimap {

namespace {

/// The voxels of a map file, read when they are needed: where an object was taken apart. Without a
/// path none are: parts of what was taken apart are measured on the surface.
VoxelSource voxels_of(const std::filesystem::path& path, std::size_t max_bytes,
                      std::optional<VoxelMap>& place) {
  return [path, max_bytes, &place]() -> const VoxelMap& {
    if (!place)
      place = path.empty() ? VoxelMap() : std::move(load_map_by_tiles(path, max_bytes).map);
    return *place;
  };
}

/// What is asked of the file must be of the map that clients see.
void require_same_map(const std::filesystem::path& path, const MapInfo& seen) {
  if (read_map_identity(path).content_hash != seen.content_hash)
    throw Error(concat("the map file '", path.string(), "' was replaced by another map since it ",
                       "was read; start `ovimap serve` anew"));
}

}  // namespace

ServedMap::ServedMap(const std::filesystem::path& map, const ServedMapConfig& config)
    : path_(map), config_(config) {
  open_saved();
  background_ = std::thread([this] { prepare_search(), follow_file(); });
}

ServedMap::ServedMap(const std::filesystem::path& map, FoundMap begun,
                     const ServedMapConfig& config)
    : path_(map),
      config_(config),
      live_surface_(std::make_shared<LiveSurface>(ChunkGrid{begun.info.voxel_size_m})),
      log_(begun.record.edits),
      surface_(live_surface_) {
  begun.live = true;
  found_ = std::make_shared<FoundMap>(std::move(begun));
  rebuild();
  background_ = std::thread([this] { prepare_search(), follow_file(); });
}

ServedMap::~ServedMap() {
  events_.close();
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ending_.notify_all();
  background_.join();
}

std::shared_ptr<const ServedSurface> ServedMap::surface() const {
  const std::lock_guard lock(mutex_);
  return surface_;
}

std::shared_ptr<const MapSnapshot> ServedMap::snapshot() const {
  const std::lock_guard lock(mutex_);
  return snapshot_;
}

CameraTracking ServedMap::tracking() const {
  const std::lock_guard lock(mutex_);
  return tracking_;
}

// ------------------------------------------------------------------------------------ new states

/// `changing_` is held, or nobody else knows this map yet.
void ServedMap::open_saved() {
  MapDocument document = load_map_by_tiles(path_, config_.voxel_bytes);
  auto found = std::make_shared<FoundMap>();
  found->info = read_map_info(path_);
  found->forest = document.map.labels();
  found->record = std::move(static_cast<MapRecord&>(document));
  log_ = found->record.edits;
  found_ = std::move(found);
  rebuild();  // before the surface, which takes all cores to be made ahead
  auto shown = live_surface_ ? live_surface_->blocks() : ShownBlocks();
  const std::uint64_t version = live_surface_ ? live_surface_->version() + 1 : 1;
  SavedSurfaceConfig config;
  if (!found_->info.unfinished)  // whose voxels have no hash
    config.levels_file = levels_file(config_.cache, found_->info.content_hash);
  auto surface = std::make_shared<const SavedSurface>(std::move(document.map), config, version,
                                                      std::move(shown));
  live_surface_.reset();
  const std::lock_guard lock(mutex_);
  surface_ = std::move(surface);
}

InstanceAliases ServedMap::correct(MapRecord& record) const {
  record.edits = log_;
  std::optional<VoxelMap> place;
  return apply_edits(
      record, found_->forest,
      voxels_of(found_->live ? std::filesystem::path() : path_, config_.voxel_bytes, place));
}

/// Makes the snapshot of what is found and corrected by now. `changing_` is held, or nobody else
/// knows this map yet.
void ServedMap::rebuild() {
  auto next = std::make_shared<MapSnapshot>();
  MapRecord record = found_->record;
  next->aliases = correct(record);
  next->live = found_->live;
  next->instance_of_label = label_table(record, found_->forest);
  if (found_->live)
    measure_on_surface(labelled_surface(*surface(), next->instance_of_label, {}),
                       surface_spacing_m(found_->info.voxel_size_m), record);
  auto objects = std::make_shared<MapSearch>(make_map_search(record, found_->info));
  objects->scene.taught = taught_;
  if (!next->live)
    objects->scene.rooms =
        std::make_shared<const ObjectRooms>([this, ids = ids_of(objects->index)] {
          const auto space = standing_space();
          return rooms_of_objects(find_rooms(space->grid), *space, ids);
        });
  next->objects = std::move(objects);
  next->record = std::make_shared<MapRecord>(std::move(record));
  set_search(*next);
  std::uint64_t version = 0;
  {
    const std::lock_guard lock(mutex_);
    version = next->version = snapshot_ ? snapshot_->version + 1 : 1;
    snapshot_ = std::move(next);
  }
  prepared_.notify_all();
  if (version > 1) events_.publish("map", concat("{\"version\":", version, "}"));
}

void ServedMap::set_search(MapSnapshot& next) const {
  const bool none_embedded = next.index().embedded() == 0;
  if (!why_no_encoder_.empty())
    next.why_no_search = why_no_encoder_;
  else if ((next.waits_for_objects = none_embedded && next.live))
    next.why_no_search = "no object has an embedding yet; mapping goes on";
  if (!next.why_no_search.empty()) {
    next.search = SearchState::kUnavailable;
    return;
  }
  if (!encoder_) return;
  try {
    next.engine = std::make_shared<const QueryEngine>(next.index(), encoder_.get(), config_.query,
                                                      Embeddings{}, next.objects->scene);
    next.search = SearchState::kReady;
  } catch (const Error& error) {
    next.search = SearchState::kUnavailable;
    next.why_no_search = error.what();
    return;
  }
  if (const TextEvidence* evidence = next.engine->matcher()->evidence())
    next.names = name_objects(*evidence);
  if (!classes_) return;
  auto guesses = std::make_shared<ObjectGuesses>();
  guesses->set = *classes_;
  auto all = project_classes(next.index(), *encoder_, *classes_,
                             static_cast<std::size_t>(config_.guesses));
  for (std::size_t i = 0; i < all.size(); ++i)
    guesses->of_object[next.index().object(i).id] = std::move(all[i]);
  next.guesses = std::move(guesses);
}

// ---------------------------------------------------------------------------------------- search

/// What takes long is done before a new snapshot is made: opening the encoder, and encoding the
/// lists of words, which it then remembers.
void ServedMap::prepare_search() {
  const auto now = snapshot();
  if (now->live) lower_thread_priority();  // mapping goes first
  try {
    open_encoder(*now);
    const LabelSet set = read_label_set(config_.classes);
    encode_labels(*encoder_, set);
    {
      const std::lock_guard lock(changing_);
      classes_ = set;
      rebuild();
    }
    // Who asks for "red" first shall not wait for the colours of all objects.
    const auto ready = snapshot();
    if (!ready->live && ready->objects->scene.colors) ready->objects->scene.colors->surfaces();
  } catch (const std::exception& error) {
    const std::lock_guard lock(changing_);
    if (encoder_) return;  // only names are lacking
    why_no_encoder_ = error.what();
    rebuild();
  }
}

void ServedMap::open_encoder(const MapSnapshot& now) {
  if (!now.live) require_embeddings(now.index());
  const EncoderIdentity& wanted = now.objects->info.encoder;
  if (now.live && wanted.name.empty())
    throw Error("the map is made without an encoder; map with --encoder");
  RuntimeConfig runtime;
  runtime.threads = config_.threads;
  auto encoder = needed_encoder_of_map(wanted, config_.encoder, runtime, config_.model_dirs);
  TextMatcher::encode_vocabulary(*encoder, config_.query);
  TextMatcher::encode_word_lists(*encoder, config_.query);
  const std::lock_guard lock(changing_);
  encoder_ = std::move(encoder);
  learn_names();
  rebuild();
}

Teaching ServedMap::teaching() const {
  const std::lock_guard lock(mutex_);
  Teaching now = teaching_;
  now.on = !config_.taught.empty();
  return now;
}

void ServedMap::show(const Teaching& teaching) {
  const std::lock_guard lock(mutex_);
  teaching_ = teaching;
}

/// What other maps taught by now. A file that cannot be read takes nothing from the map.
/// `changing_` is held.
void ServedMap::learn_names() {
  if (config_.taught.empty() || !encoder_) return;
  Teaching now;
  try {
    taught_ = taught_elsewhere(config_.taught, path_, encoder_->identity());
    now.examples = taught_.names.size();
  } catch (const Error& error) {
    now.fault = error.what();
  }
  show(now);
}

/// What people named in this map is an example for others. A correction that teaches nothing
/// stands. `changing_` is held.
void ServedMap::teach_names() {
  if (config_.taught.empty()) return;
  Teaching now = teaching();
  try {
    teach(config_.taught, path_, *snapshot()->objects);
    now.fault.clear();
  } catch (const std::exception& error) {
    now.fault = error.what();
  }
  show(now);
}

std::shared_ptr<const MapSnapshot> ServedMap::prepared_snapshot() const {
  std::unique_lock lock(mutex_);
  prepared_.wait(lock, [&] { return snapshot_->search != SearchState::kPreparing; });
  return snapshot_;
}

std::shared_ptr<const StandingSpace> ServedMap::standing_space() const {
  const auto now = snapshot();
  if (now->live) throw Error("the map is still being made; ask when it is finished");
  const std::lock_guard lock(standing_mutex_);
  if (!standing_ || standing_edits_ != now->record->edits.size()) {
    require_same_map(path_, now->objects->info);
    standing_ = std::make_shared<StandingSpace>(make_standing_space(load_corrected_map(path_)));
    standing_edits_ = now->record->edits.size();
  }
  return standing_;
}

// ----------------------------------------------------------------------------------- corrections

MapEdit ServedMap::correct(MapEdit edit) {
  const std::lock_guard lock(changing_);
  for (Label& label : edit.super_points) label = found_->forest.root(label);
  if (log_closed_) throw Error("the map is being saved; try again in a moment");
  if (found_->live) {
    MapRecord record = found_->record;
    record.edits = log_;
    std::optional<VoxelMap> place;
    edit = append_edit(record, found_->forest, voxels_of({}, 0, place), std::move(edit));
    log_ = std::move(record.edits);
  } else {
    require_same_map(path_, found_->info);
    edit = edit_map(path_, std::move(edit));
  }
  try {
    if (!found_->live) log_ = read_edits(path_);  // with what other programs wrote
    learn_names();
    rebuild();
    teach_names();
  } catch (const std::exception&) {  // it is kept, and shown when the file is looked at again
    if (!found_->live) log_.clear();
    written_ = {};
  }
  return edit;
}

void ServedMap::follow_file() {
  constexpr std::chrono::seconds kLook{1};
  std::unique_lock lock(mutex_);
  while (!ending_.wait_for(lock, kLook, [this] { return ended_; })) {
    lock.unlock();
    take_corrections_of_others();
    lock.lock();
  }
}

void ServedMap::take_corrections_of_others() {
  std::error_code gone;
  const auto written = std::filesystem::last_write_time(path_, gone);
  const std::lock_guard lock(changing_);
  if (gone || written == written_ || found_->live || log_closed_) return;
  written_ = written;
  try {
    require_same_map(path_, found_->info);
    MapEdits log = read_edits(path_);
    if (log == log_) return;
    log_ = std::move(log);
    learn_names();
    rebuild();
  } catch (const std::exception&) {
    // It is being written, and is looked at again once that is done; or it is another map by now,
    // which is told to who corrects.
  }
}

// ---------------------------------------------------------------------------- while it is being
// made

void ServedMap::show(FoundMap found) {
  const std::lock_guard lock(changing_);
  if (!found_->live) return;
  found.live = true;
  found_ = std::make_shared<FoundMap>(std::move(found));
  rebuild();
}

void ServedMap::show(std::vector<SurfacePatch> patches) {
  live_surface_->update(std::move(patches));
  events_.publish("mesh", concat("{\"version\":", live_surface_->version(), "}"));
}

void ServedMap::show(const CameraTracking& tracking) {
  {
    const std::lock_guard lock(mutex_);
    tracking_ = tracking;
  }
  events_.publish("tracking", tracking_json(tracking));
}

void ServedMap::loops_closed(std::size_t count) {
  CameraTracking now = tracking();
  now.state = CameraState::kTracked;
  now.loops = count;
  show(now);
}

MapEdits ServedMap::close_log() {
  const std::lock_guard lock(changing_);
  log_closed_ = true;
  return log_;
}

void ServedMap::saved() {
  const std::lock_guard lock(changing_);
  open_saved();
  log_closed_ = false;
  events_.publish("mesh", concat("{\"version\":", surface()->version(), "}"));
}

}  // namespace ovimap
