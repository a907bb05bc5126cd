// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/io/map_tables/map_edit.h"
#include "ovimap/pipeline/approach/standing_space.h"
#include "ovimap/pipeline/search/history_search.h"
#include "ovimap/semantics/classes/object_names.h"
#include "ovimap/semantics/query/query_engine.h"

namespace ovimap::python {

namespace nb = nanobind;

/// A map file, open for questions. The encoder is opened at the first one that needs it.
class SavedMap {
 public:
  /// `encoder`: null where `encoder_spec` names it. `taught`: file of what corrections teach;
  /// empty: nothing.
  SavedMap(std::filesystem::path path, const QueryConfig& config,
           std::shared_ptr<ImageTextEncoder> encoder, std::string encoder_spec,
           std::vector<std::filesystem::path> model_dirs, std::filesystem::path taught = {});

  const std::filesystem::path& path() const { return path_; }
  const MapInfo& info() const { return search_.info; }
  const SearchIndex& index() const { return search_.index; }
  const QueryScene& scene() const { return search_.scene; }
  const MapSearch& search() const { return search_; }

  /// Thread-safe. `words`: whether the question needs the encoder.
  const QueryEngine& engine(bool words);

  /// What it says of its past, with looks and without voxels. Read the first time. Thread-safe.
  const MapRecord& record();

  /// What the map says of its past; positions of matches are those of the objects as they are now,
  /// or kGone. Thread-safe.
  QueryAnswer ask_past(const HistoryPhrase& phrase, const Query& query);
  /// What is asked of the past, as history_of_question takes it; nothing: it is of the present.
  std::optional<HistoryPhrase> past_of(const std::string& text, const std::string& at,
                                       const std::string& since) const;
  static constexpr std::size_t kGone = ~std::size_t{0};

  /// Keeps a correction, and what it teaches. Returns its number in the log.
  std::int64_t correct(MapEdit edit) const;

  /// The map as its file is by now. An encoder that is open already stays open for it.
  std::shared_ptr<SavedMap> reopened();

  /// What objects are called where nobody named them, by position; empty where that cannot be told:
  /// there are no embeddings, or their encoder is not on this machine. Thread-safe.
  const std::vector<ObjectName>& guessed_names();

  /// The same by id, also of objects that are gone. Thread-safe.
  const WordsOfObjects& words_with_gone();

  /// The JPEG files of the pictures that the map keeps of an object, by frame. Thread-safe. Throws
  /// Error for an unknown id.
  std::vector<Bytes> crops(InstanceId id);

  /// Where an object is, drawn from above. Reads the voxels the first time. Thread-safe. Throws
  /// Error for an unknown id and for a map without voxels.
  RgbImage place(InstanceId id);

  /// What is asked where to stand. Reads the voxels the first time. Thread-safe. Throws Error for a
  /// map without voxels.
  const StandingSpace& standing_space();

  /// Position of an object. Throws Error for an unknown id.
  std::size_t position(InstanceId id) const;

  /// Frames that were left out when it was made, where that is known.
  std::vector<FaultCount> skipped;

  /// The surface with instance ids as labels. Throws Error for a map without voxels.
  Mesh mesh() const;

 private:
  void require_encoder_of_map() const;

  std::filesystem::path path_;
  QueryConfig config_;
  std::string encoder_spec_;
  std::vector<std::filesystem::path> model_dirs_;
  std::filesystem::path taught_;
  MapSearch search_;

  std::mutex mutex_;  ///< guards what follows
  std::shared_ptr<ImageTextEncoder> encoder_;
  std::unique_ptr<QueryEngine> word_engine_, object_engine_;

  std::mutex words_mutex_;  ///< guards what follows
  std::optional<WordsOfObjects> words_;

  std::mutex details_mutex_;  ///< guards what follows
  std::optional<std::vector<ObjectName>> names_;
  std::optional<SuperPointLooks> looks_;
  std::optional<MapRecord> record_;
  std::optional<Mesh> surface_;
  std::optional<StandingSpace> standing_;
};

/// Adds the questions to Map.
void bind_query(nb::module_& module, nb::class_<SavedMap>& map);

/// Adds its visits and what they found to Map.
void bind_history(nb::module_& module, nb::class_<SavedMap>& map);

/// Adds where to stand to Map.
void bind_approach(nb::module_& module, nb::class_<SavedMap>& map);

/// Adds rooms and what is in them to Map.
void bind_scene(nb::class_<SavedMap>& map);

/// Adds to Map what is known of single objects, and corrections.
void bind_objects(nb::module_& module, nb::class_<SavedMap>& map);

}  // namespace ovimap::python
