// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/command/command.h"
#include "apps/command/teach_option.h"
#include "ovimap/pipeline/search/history_search.h"
#include "query_approach.h"

namespace ovimap::apps {

/// What `ovimap query` was told to ask.
struct QueryOptions {
  std::filesystem::path map, heat_map;
  TeachOption teach;
  std::vector<std::string> texts, negatives, settings;
  std::string near, encoder = "auto";
  std::string at, since;
  std::vector<std::filesystem::path> images, model_dirs;
  std::vector<InstanceId> like;
  int top = 0, threads = 0;  // 0: as configured
  bool json = false;
  ApproachOptions approach;
};

/// A text, and what it asks of the past; nothing: it asks of the present.
struct AskedText {
  std::string text;
  std::optional<HistoryPhrase> past;
};

/// What is asked, text by text. Throws Error for a text that is none, and for what is no time.
std::vector<AskedText> asked_texts(const QueryOptions& options, const QueryConfig& config);

/// An answer, and the objects that it speaks of.
struct Answered {
  QueryAnswer answer;
  const SearchIndex* index;
  std::shared_ptr<const std::vector<std::string>> titles;
  std::shared_ptr<const HistorySearch> past = {};  ///< null: it speaks of the present

  const SearchObject& object(const QueryMatch& match) const {
    return index->object(match.position);
  }
  const std::string& title(const QueryMatch& match) const { return (*titles)[match.position]; }
  /// Whether the object is not where the answer shows it any more.
  bool is_past(const QueryMatch& match) const { return past && past->events[match.position] != 0; }
};

/// Asks one map about its present and its past. The references must outlive it.
class QueryAsker {
 public:
  QueryAsker(const QueryOptions& options, const QueryConfig& config)
      : options_(options), config_(config) {}

  /// One answer for each text, then for each picture, then for each object. They refer to this
  /// asker, which is asked once. Throws Error for a map that cannot be read, and for what cannot be
  /// asked of it.
  std::vector<Answered> ask(const std::vector<AskedText>& texts);
  const Eigen::Vector3f& up() const { return search_.info.up; }

 private:
  bool relevance() const { return !options_.heat_map.empty(); }
  void open(const std::vector<AskedText>& texts);
  MapSearch open_map() const;
  void open_encoder();
  const QueryEngine& present();
  Answered ask_names(const std::string& text);
  Answered in_present(QueryAnswer answer) const;
  Answered ask_past(const AskedText& asked);

  const QueryOptions& options_;
  const QueryConfig& config_;
  MapSearch search_;
  std::unique_ptr<ImageTextEncoder> encoder_;
  std::unique_ptr<QueryEngine> engine_;
  std::shared_ptr<const std::vector<std::string>> titles_;
  std::optional<MapRecord> record_;
};

}  // namespace ovimap::apps
