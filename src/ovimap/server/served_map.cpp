// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served_map.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/map_file.h"

namespace ovimap {

const char* search_state_name(SearchState state) {
  switch (state) {
    case SearchState::kPreparing:
      return "preparing";
    case SearchState::kReady:
      return "ready";
    default:
      return "unavailable";
  }
}

std::string MapSnapshot::name_of(InstanceId id) const {
  const auto found = names.find(id);
  return found == names.end() ? "" : found->second;
}

ServedMap::ServedMap(const std::filesystem::path& map, const ServedMapConfig& config)
    : path_(map), config_(config), corrections_(corrections_in_map_file(map)) {
  MapDocument document = load_map(map);
  mesh_ = std::make_unique<MeshStore>(ChunkGrid{document.map.config().voxel_size_m}, config.levels);
  mesh_->replace(extract_instance_mesh(document.map, document.instances));
  auto first = std::make_shared<MapSnapshot>();
  first->objects = std::make_shared<MapSearch>(open_map_search(map, config.query.shapes));
  first->names = document.names;
  first->record = std::make_shared<MapRecord>(std::move(static_cast<MapRecord&>(document)));
  snapshot_ = first;
  preparation_ = std::thread([this] { prepare_search(); });
}

ServedMap::~ServedMap() {
  events_.close();
  preparation_.join();
}

std::shared_ptr<const MapSnapshot> ServedMap::snapshot() const {
  const std::lock_guard lock(mutex_);
  return snapshot_;
}

template <class Change>
void ServedMap::change(Change&& change) {
  std::uint64_t version = 0;
  {
    const std::lock_guard lock(mutex_);
    auto next = std::make_shared<MapSnapshot>(*snapshot_);
    version = ++next->version;
    change(*next);
    snapshot_ = std::move(next);
  }
  prepared_.notify_all();
  events_.publish("map", concat("{\"version\":", version, "}"));
}

void ServedMap::prepare_search() {
  const auto now = snapshot();
  try {
    require_embeddings(now->index());
    RuntimeConfig runtime;
    runtime.threads = config_.threads;
    encoder_ = needed_encoder_of_map(now->objects->info.encoder, config_.encoder, runtime,
                                     config_.model_dirs);
    auto engine = std::make_shared<const QueryEngine>(now->index(), encoder_.get(), config_.query,
                                                      Embeddings{}, now->objects->scene);
    change([&](MapSnapshot& next) {
      next.engine = std::move(engine);
      next.search = SearchState::kReady;
    });
    guess_names();
  } catch (const std::exception& error) {
    change([&](MapSnapshot& next) {
      if (next.search == SearchState::kReady) return;  // only names are lacking
      next.search = SearchState::kUnavailable;
      next.why_no_search = error.what();
    });
  }
}

void ServedMap::guess_names() {
  const auto now = snapshot();
  auto guesses = std::make_shared<ObjectGuesses>();
  guesses->set = read_label_set(config_.classes);
  auto all = project_classes(now->index(), *encoder_, guesses->set,
                             static_cast<std::size_t>(config_.guesses));
  for (std::size_t i = 0; i < all.size(); ++i)
    guesses->of_object[now->index().object(i).id] = std::move(all[i]);
  change([&](MapSnapshot& next) { next.guesses = std::move(guesses); });
}

MapAnswer ServedMap::ask(const MapQuestion& question) const {
  std::shared_ptr<const MapSnapshot> now;
  {
    std::unique_lock lock(mutex_);
    prepared_.wait(lock, [&] { return snapshot_->search != SearchState::kPreparing; });
    now = snapshot_;
  }
  if (!now->engine) throw SearchUnavailable(now->why_no_search);
  const bool relevance = question.query.relevance;
  return {question.like ? now->engine->find_like(*question.like, relevance)
                        : now->engine->find(question.query),
          now};
}

void ServedMap::correct(const Correction& correction) {
  const auto kinds = corrections_->kinds();
  if (std::find(kinds.begin(), kinds.end(), correction.kind) == kinds.end())
    throw Error(concat("this map cannot keep a '", correction_name(correction.kind),
                       "'; it keeps names (rename) alone"));
  const std::lock_guard one_at_a_time(correcting_);
  if (!snapshot()->index().find(correction.instance))
    throw Error(concat("the map has no object ", correction.instance,
                       "; GET /api/instances lists those it has"));
  corrections_->append(correction);
  change([&](MapSnapshot& next) {
    if (correction.name.empty())
      next.names.erase(correction.instance);
    else
      next.names[correction.instance] = correction.name;
  });
}

}  // namespace ovimap
