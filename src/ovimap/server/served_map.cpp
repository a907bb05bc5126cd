// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served_map.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/map_file.h"

namespace ovimap {

namespace {

constexpr std::size_t kLongestName = 200;  // bytes

void check_name(const std::string& name) {
  if (name.size() > kLongestName)
    throw Error(
        concat("a name of ", name.size(), " bytes is too long; ", kLongestName, " are allowed"));
  if (std::any_of(name.begin(), name.end(),
                  [](unsigned char letter) { return letter < 0x20 || letter == 0x7f; }))
    throw Error("a name must not hold control characters such as line breaks; leave them out");
}

}  // namespace

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

const InstanceSummary* MapSnapshot::find(InstanceId id) const {
  const auto& all = record->instances;
  const auto found = std::lower_bound(
      all.begin(), all.end(), id,
      [](const InstanceSummary& instance, InstanceId wanted) { return instance.id < wanted; });
  return found != all.end() && found->id == id ? &*found : nullptr;
}

std::string MapSnapshot::name_of(InstanceId id) const {
  const auto found = names.find(id);
  return found == names.end() ? "" : found->second;
}

ServedMap::ServedMap(const std::filesystem::path& map, const ServedMapConfig& config)
    : path_(map), config_(config), corrections_(corrections_in_map_file(map)) {
  MapDocument document = load_map(map);
  search_ = open_map_search(map, config.query.shapes);
  mesh_ = std::make_unique<MeshStore>(ChunkGrid{document.map.config().voxel_size_m}, config.levels);
  mesh_->replace(extract_instance_mesh(document.map, document.instances));
  auto first = std::make_shared<MapSnapshot>();
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
  try {
    require_embeddings(search_.index);
    RuntimeConfig runtime;
    runtime.threads = config_.threads;
    auto encoder =
        needed_encoder_of_map(search_.info.encoder, config_.encoder, runtime, config_.model_dirs);
    auto engine = std::make_unique<const QueryEngine>(search_.index, encoder.get(), config_.query,
                                                      Embeddings{}, search_.scene);
    change([&](MapSnapshot& next) {
      encoder_ = std::move(encoder);
      engine_ = std::move(engine);
      next.search = SearchState::kReady;
    });
    guess_names(*encoder_);
  } catch (const std::exception& error) {
    change([&](MapSnapshot& next) {
      if (next.search == SearchState::kReady) return;  // only names are lacking
      next.search = SearchState::kUnavailable;
      next.why_no_search = error.what();
    });
  }
}

void ServedMap::guess_names(ImageTextEncoder& encoder) {
  auto guesses = std::make_shared<ObjectGuesses>();
  guesses->set = read_label_set(config_.classes);
  guesses->of_object = project_classes(search_.index, encoder, guesses->set,
                                       static_cast<std::size_t>(config_.guesses));
  change([&](MapSnapshot& next) { next.guesses = std::move(guesses); });
}

QueryAnswer ServedMap::ask(const MapQuestion& question) const {
  const QueryEngine* engine = nullptr;
  {
    std::unique_lock lock(mutex_);
    prepared_.wait(lock, [&] { return snapshot_->search != SearchState::kPreparing; });
    if (!engine_) throw Error(snapshot_->why_no_search);
    engine = engine_.get();
  }
  if (question.like) return engine->find_like(*question.like, question.query.relevance);
  return engine->find(question.query);
}

void ServedMap::correct(const Correction& correction) {
  const auto kinds = corrections_->kinds();
  if (std::find(kinds.begin(), kinds.end(), correction.kind) == kinds.end())
    throw Error(concat("this map cannot keep a '", correction_name(correction.kind),
                       "'; it keeps names (rename) alone"));
  check_name(correction.name);
  const std::lock_guard one_at_a_time(correcting_);
  if (snapshot()->find(correction.instance) == nullptr)
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
