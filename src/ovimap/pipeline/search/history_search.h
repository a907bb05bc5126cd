// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ovimap/pipeline/search/map_search.h"
#include "ovimap/pipeline/search/past_objects.h"
#include "ovimap/semantics/query/query_engine.h"

namespace ovimap {

/// A map as it was, ready for a QueryEngine.
struct HistorySearch {
  HistoryPhrase phrase;
  MapSearch search;  ///< things that are gone included where they may be asked for
  std::vector<std::size_t>
      events;  ///< by position: 1 + the event that ended that state, 0: it is so now
  std::vector<std::string> told;  ///< by position: what the history says of it; empty: nothing
  std::vector<bool> among;        ///< by position: which may be the answer; empty: all
  std::string reading;            ///< " that moved since visit 1"

  /// Whether it asks for whatever there is, which takes no encoder.
  bool for_anything() const { return phrase.text == "anything"; }
};

/// The question that a text and the times beside it ask of a map's past; nothing where they ask of
/// the present. `at`, `since`: as time_of_text takes them; empty: not said. Throws Error for what
/// is no time, and where both text and options name one.
std::optional<HistoryPhrase> history_of_question(const std::string& text, const std::string& at,
                                                 const std::string& since, double now_s);

/// The map as the question means it. `corrected`: as people made it, with looks; `info`: what it
/// does not tell. Throws MomentUnknown.
HistorySearch search_history(const MapRecord& corrected, const MapInfo& info,
                             const HistoryPhrase& phrase);

/// Such a record of a map file, without voxels. Throws what load_map throws.
MapRecord read_corrected_record(const std::filesystem::path& map);

/// What the map says. `engine`: of `history.search`; null where it asks for anything without
/// negatives. `query`: the rest of the question; its text is taken from `history`. Throws what
/// QueryEngine::find throws.
QueryAnswer ask_history(const HistorySearch& history, const QueryEngine* engine, Query query);

using WordsOfObjects = std::map<InstanceId, std::string>;

/// What each object clearly is, those that are gone included; ObjectName::kUnclear for what is
/// not clearly anything. `encoder`: of the map's embeddings. Throws what QueryEngine throws.
WordsOfObjects words_with_gone(const MapRecord& corrected, const MapInfo& info,
                               ImageTextEncoder& encoder, const QueryConfig& config,
                               const TaughtThings& taught);

}  // namespace ovimap
