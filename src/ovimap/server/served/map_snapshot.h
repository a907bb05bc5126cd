// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ovimap/io/corrections/map_corrections.h"
#include "ovimap/pipeline/search/map_search.h"
#include "ovimap/semantics/classes/label_set.h"
#include "ovimap/semantics/classes/object_names.h"
#include "ovimap/semantics/query/query_engine.h"
#include "ovimap/server/surface/surface_measure.h"

namespace ovimap {

/// A map as mapping found it: what corrections are applied to.
struct FoundMap {
  MapRecord record;
  LabelForest forest;
  MapInfo info;       ///< what the record does not tell
  bool live = false;  ///< it is still being made: measures are those of its surface
};

/// The names that fit objects best, best first.
struct ObjectGuesses {
  LabelSet set;
  std::map<InstanceId, std::vector<ClassGuess>> of_object;
};

enum class SearchState { kPreparing, kReady, kUnavailable };
const char* search_state_name(SearchState state);  ///< "preparing", "ready", "unavailable"

/// What is known of the map at one moment, as people corrected it. Never changes; a change makes a
/// new one.
struct MapSnapshot {
  std::uint64_t version = 1;
  bool live = false;
  std::shared_ptr<const MapRecord> record;
  InstanceAliases aliases;
  LabelTable instance_of_label;
  std::shared_ptr<const MapSearch> objects;      ///< in the order of record->instances
  std::shared_ptr<const QueryEngine> engine;     ///< of `objects`; null: there is none, or not yet
  std::shared_ptr<const ObjectGuesses> guesses;  ///< null: likewise
  std::vector<ObjectName> names;                 ///< by position; empty: not known
  SearchState search = SearchState::kPreparing;
  std::string why_no_search;       ///< a sentence
  bool waits_for_objects = false;  ///< it cannot be searched because none has an embedding yet

  const SearchIndex& index() const { return objects->index; }
  std::string name_of(InstanceId id) const;  ///< as given; empty: none
  std::set<InstanceId> hidden() const;
  /// The id by which an object goes now: that of an older one, where the two turned out to be one
  /// or were merged; the same for any other.
  InstanceId current_id(InstanceId id) const;
  /// Whether it is an object, hidden or not.
  bool knows(InstanceId id) const;
};

}  // namespace ovimap
