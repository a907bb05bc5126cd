// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ovimap/base/error.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/pipeline/approach/gaps.h"
#include "ovimap/pipeline/approach/standing_space.h"
#include "ovimap/pipeline/search/history_search.h"
#include "ovimap/server/served/camera_tracking.h"
#include "ovimap/server/served/event_hub.h"
#include "ovimap/server/served/map_snapshot.h"
#include "ovimap/server/surface/live_surface.h"
#include "ovimap/server/surface/saved_surface.h"

namespace ovimap {

struct ServedMapConfig {
  std::string encoder = "auto";  ///< as encoder_of_map takes it
  std::vector<std::filesystem::path> model_dirs;
  std::string classes = "scannet200";  ///< the names that objects are given by guess
  int guesses = 3;                     ///< names an object is given
  int threads = 0;
  std::filesystem::path taught;  ///< file of what corrections teach; empty: they teach nothing
  QueryConfig query;
  std::size_t voxel_bytes = 128 << 20;  ///< of a saved map, in memory at once
  std::filesystem::path cache;          ///< folder for what a map's surface is in less detail, for
                                        ///< the next time; empty: nothing is kept
};

/// This map cannot be searched, whatever is asked.
class SearchUnavailable : public Error {
 public:
  using Error::Error;
};

struct MapQuestion {
  Query query;                     ///< what to look for in words
  std::optional<InstanceId> like;  ///< instead: what looks like this object
  std::optional<HistoryPhrase> past =
      {};  ///< instead of the query's text: what is asked of the past
};

/// An answer, and the state of the map that it speaks of.
struct MapAnswer {
  QueryAnswer answer;
  std::shared_ptr<const MapSnapshot> map;
  std::shared_ptr<const HistorySearch> past =
      {};  ///< whose objects it speaks of; null: those of `map`

  const SearchIndex& index() const { return past ? past->search.index : map->index(); }
};

/// What names that people give teach other maps.
struct Teaching {
  bool on = false;
  std::size_t examples = 0;  ///< things in other maps that speak in this one
  std::string fault;         ///< why the latest correction taught nothing; empty: it did
};

/// One map as clients see it: its surface, its objects, answers to queries, corrections. Whoever
/// serves it over a network only reads it. A saved map, or one that is still being made, of which
/// it is told what is found. What other programs correct in the file of a saved map is seen within
/// seconds. Thread-safe.
class ServedMap {
 public:
  /// Reads the map but for its voxels, which are read as its surface is asked for. Search and names
  /// follow in the background, since they need the encoder. Throws what load_map_by_tiles throws.
  ServedMap(const std::filesystem::path& map, const ServedMapConfig& config = {});
  /// A map that is being made and will be saved at `map`, as yet with its log of corrections, its
  /// encoder and its voxel size (`begun.info`).
  ServedMap(const std::filesystem::path& map, FoundMap begun, const ServedMapConfig& config);
  ~ServedMap();
  ServedMap(const ServedMap&) = delete;
  ServedMap& operator=(const ServedMap&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const RelationConfig& relations() const { return config_.query.relations; }
  int max_query_chars() const { return config_.query.max_text_chars; }
  EventHub& events() const { return events_; }
  /// Another one once a map that was being made is saved.
  std::shared_ptr<const ServedSurface> surface() const;
  std::shared_ptr<const MapSnapshot> snapshot() const;
  /// The same when search is ready, or known to be impossible.
  std::shared_ptr<const MapSnapshot> prepared_snapshot() const;
  CameraTracking tracking() const;
  Teaching teaching() const;

  /// What a text asks of the past, or it and times that history_of_question takes; nothing: it asks
  /// of the present. Throws Error for what is no query and no time.
  std::optional<HistoryPhrase> past_of(const std::string& text, const std::string& at,
                                       const std::string& since) const;

  /// Waits until search is ready. Throws Error for what the asker can mend, SearchUnavailable where
  /// this map cannot be searched, MomentUnknown for times that it knows nothing of.
  MapAnswer ask(const MapQuestion& question) const;

  /// What each object clearly is, those that are gone included; empty where search is not ready.
  /// Kept until the map changes.
  WordsOfObjects words_with_gone(const MapSnapshot& now) const;

  /// Where somebody who scans should look next, of a map that is being made too.
  std::vector<Gap> gaps(const GapsConfig& config = {}) const;

  /// What is asked where to stand. Read from the map file the first time and after a correction,
  /// which takes seconds. Throws Error for a map that is still being made or cannot be read.
  std::shared_ptr<const StandingSpace> standing_space() const;

  /// Keeps a correction: in the map file, or while the map is being made in its log, which goes
  /// into the file with it. Returns it as it is kept. Throws Error when it makes no sense in this
  /// map or could not be kept; then nothing changed.
  MapEdit correct(MapEdit edit);

  // Of a map that is being made.

  /// Takes what mapping has found by now; corrections stay.
  void show(FoundMap found);
  /// Takes changed pieces of the surface.
  void show(std::vector<SurfacePatch> patches);
  /// How its camera is followed by now.
  void show(const CameraTracking& tracking);
  /// So many loops of the camera's way were closed when the map was completed.
  void loops_closed(std::size_t count);
  /// The log as it goes into the file. From now on corrections are refused, until the map is saved.
  MapEdits close_log();
  /// The map is saved: from now on it is one like any other.
  void saved();

 private:
  void prepare_search();
  void open_encoder(const MapSnapshot& now);
  void rebuild();
  void open_saved();
  InstanceAliases correct(MapRecord& record) const;
  void set_search(MapSnapshot& next) const;
  void learn_names();
  void follow_file();
  void take_corrections_of_others();
  void teach_names();
  void show(const Teaching& teaching);
  MapAnswer ask_past(std::shared_ptr<const MapSnapshot> now, const MapQuestion& question) const;

  const std::filesystem::path path_;
  const ServedMapConfig config_;
  std::shared_ptr<LiveSurface> live_surface_;  ///< null: the map is a saved one
  mutable EventHub events_;

  std::mutex changing_;  ///< guards what follows, for whoever makes a new snapshot
  std::shared_ptr<const FoundMap> found_;
  MapEdits log_;
  bool log_closed_ = false;
  std::filesystem::file_time_type written_;    ///< when the file was, as last looked at
  std::unique_ptr<ImageTextEncoder> encoder_;  ///< engines of snapshots use it
  std::string why_no_encoder_;                 ///< empty: there is one, or it is being opened
  std::optional<LabelSet> classes_;            ///< once their names are encoded
  TaughtThings taught_;                        ///< by other maps, for the encoder

  mutable std::mutex mutex_;  ///< held for a moment only
  mutable std::condition_variable prepared_;
  bool ended_ = false;
  std::condition_variable ending_;
  std::shared_ptr<const ServedSurface> surface_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  CameraTracking tracking_;
  Teaching teaching_;

  mutable std::mutex standing_mutex_;  ///< guards what follows; held while it is read
  mutable std::shared_ptr<const StandingSpace> standing_;
  mutable std::size_t standing_edits_ = 0;  ///< how many corrections it has

  mutable std::mutex words_mutex_;           ///< guards what follows; held while they are found
  mutable WordsOfObjects words_;             ///< of the objects that are and were
  mutable std::uint64_t words_version_ = 0;  ///< of the snapshot that they speak of
  std::thread background_;  ///< prepares search, then sees what others write into the file
};

}  // namespace ovimap
