// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ovimap/base/error.h"
#include "ovimap/io/map_document.h"
#include "ovimap/pipeline/map_search.h"
#include "ovimap/semantics/label_set.h"
#include "ovimap/semantics/query_engine.h"
#include "ovimap/server/corrections.h"
#include "ovimap/server/event_hub.h"
#include "ovimap/server/mesh_store.h"

namespace ovimap {

struct ServedMapConfig {
  std::string encoder = "auto";  ///< as encoder_of_map takes it
  std::vector<std::filesystem::path> model_dirs;
  std::string classes = "scannet200";  ///< the names that objects are given by guess
  int guesses = 3;                     ///< names an object is given
  int threads = 0;
  QueryConfig query;
  MeshLevelConfig levels;
};

/// The names that fit objects best, best first.
struct ObjectGuesses {
  LabelSet set;
  std::map<InstanceId, std::vector<ClassGuess>> of_object;
};

enum class SearchState { kPreparing, kReady, kUnavailable };
const char* search_state_name(SearchState state);  ///< "preparing", "ready", "unavailable"

/// What is known of the map at one moment. Never changes; a change makes a new one.
struct MapSnapshot {
  std::uint64_t version = 1;
  std::shared_ptr<const MapRecord> record;
  std::shared_ptr<const MapSearch> objects;      ///< in the order of record->instances
  std::map<InstanceId, std::string> names;       ///< given by people
  std::shared_ptr<const QueryEngine> engine;     ///< of `objects`; null: there is none, or not yet
  std::shared_ptr<const ObjectGuesses> guesses;  ///< null: likewise
  SearchState search = SearchState::kPreparing;
  std::string why_no_search;  ///< a sentence

  const SearchIndex& index() const { return objects->index; }
  std::string name_of(InstanceId id) const;  ///< as given; empty: none
};

/// This map cannot be searched, whatever is asked.
class SearchUnavailable : public Error {
 public:
  using Error::Error;
};

struct MapQuestion {
  Query query;                     ///< what to look for in words
  std::optional<InstanceId> like;  ///< instead: what looks like this object
};

/// An answer, and the state of the map that it speaks of.
struct MapAnswer {
  QueryAnswer answer;
  std::shared_ptr<const MapSnapshot> map;
};

/// One map as clients see it: its surface, its objects, answers to queries, corrections. Whoever
/// serves it over a network only reads it. Thread-safe.
class ServedMap {
 public:
  /// Reads the map and makes its surface ready; search and names follow in the background, since
  /// they need the encoder. Throws what load_map throws.
  ServedMap(const std::filesystem::path& map, const ServedMapConfig& config = {});
  ~ServedMap();
  ServedMap(const ServedMap&) = delete;
  ServedMap& operator=(const ServedMap&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const MeshStore& mesh() const { return *mesh_; }
  const RelationConfig& relations() const { return config_.query.relations; }
  EventHub& events() const { return events_; }
  std::shared_ptr<const MapSnapshot> snapshot() const;

  /// Waits until search is ready. Throws Error for what the asker can mend, SearchUnavailable where
  /// this map cannot be searched.
  MapAnswer ask(const MapQuestion& question) const;

  std::vector<CorrectionKind> correctable() const { return corrections_->kinds(); }
  /// Throws Error when the correction could not be kept; then nothing changed.
  void correct(const Correction& correction);

 private:
  void prepare_search();
  void guess_names();
  template <class Change>
  void change(Change&& change);

  const std::filesystem::path path_;
  const ServedMapConfig config_;
  std::unique_ptr<MeshStore> mesh_;
  std::unique_ptr<CorrectionStore> corrections_;
  std::mutex correcting_;
  mutable EventHub events_;

  mutable std::mutex mutex_;
  mutable std::condition_variable prepared_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  std::unique_ptr<ImageTextEncoder> encoder_;  // engines of snapshots use it
  std::thread preparation_;
};

}  // namespace ovimap
