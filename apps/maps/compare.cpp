// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Two maps, or one at two times: what changed from one to the other; and one map of both.
#include <cstdio>

#include "apps/command/box_json.h"
#include "apps/command/command.h"
#include "apps/command/save_again.h"
#include "ovimap/base/parallel.h"
#include "ovimap/frames/recording/number_text.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/exports/json_values.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/mesh/ply.h"
#include "ovimap/io/pictures/pictures.h"
#include "ovimap/pipeline/alignment/map_alignment.h"
#include "ovimap/pipeline/report/change_mesh.h"
#include "ovimap/pipeline/revise/map_diff.h"
#include "ovimap/pipeline/revise/map_merge.h"
#include "ovimap/pipeline/search/history_search.h"

namespace ovimap::apps {

namespace {

struct CompareOptions {
  std::filesystem::path a, b, out, transform;
  std::string since, until;
  bool align = false;
  int threads = 0;
  bool json = false;
};

Pose read_transform(const std::filesystem::path& path) {
  const auto numbers = read_numbers(path);
  if (!numbers || (numbers->size() != 16 && numbers->size() != 12))
    throw Error(concat("'", path.string(),
                       "' is no transform; give 16 numbers, a 4x4 matrix row by row that takes "
                       "points of the second map to the first"));
  const Eigen::Matrix4d matrix = matrix_from_rows(*numbers);
  if (const std::string fault = pose_fault(matrix); !fault.empty())
    throw Error(concat("'", path.string(), "' is no rigid transform: ", fault,
                       "; give a rotation and a shift in metres"));
  return rigid_pose(matrix);
}

/// How the second map lies to the first, and how sure that is.
MapAlignment find_alignment(const CompareOptions& options, const MapDocument& a,
                            const MapDocument& b) {
  if (options.align) return align_maps(a, b);
  const Pose pose =
      options.transform.empty() ? Pose::Identity() : read_transform(options.transform);
  return judge_alignment(a, b, pose);
}

nlohmann::json alignment_json(const MapAlignment& alignment, bool found) {
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) rows.push_back(alignment.a_from_b.matrix()(i, j));
  nlohmann::json result = {
      {"a_from_b", rows}, {"overlap", alignment.overlap}, {"fit", alignment.fit}, {"found", found}};
  if (found)
    result["runner_up"] = alignment.score() > 0 ? alignment.runner_up / alignment.score() : 0;
  return result;
}

void print_alignment(const MapAlignment& alignment) {
  std::printf(
      "surfaces: %.0f %% of the smaller map meets the other; where both looked, %.0f %% agrees\n",
      100. * double{alignment.overlap}, 100. * double{alignment.fit});
}

nlohmann::json change_json(const ObjectChange& change) {
  const auto id = [](InstanceId value) {
    return value == 0 ? nlohmann::json() : nlohmann::json(value);
  };
  nlohmann::json result = {
      {"change", change_name(change.kind)},  {"before", id(change.before)},
      {"after", id(change.after)},           {"overlap", change.overlap},
      {"seen_through", change.seen_through}, {"surface_there", change.surface_there},
      {"evidence", change.evidence}};
  if (change.cosine) result["cosine"] = *change.cosine;
  if (change.kind == ChangeKind::kMoved)
    result["shift"] = {change.shift_m.x(), change.shift_m.y(), change.shift_m.z()};
  return result;
}

void check_drawing(const std::filesystem::path& path) {
  if (path.empty()) return;
  if (path.extension() != ".png" && path.extension() != ".ply")
    throw Error(
        concat("cannot draw into '", path.string(), "'; the name must end in .png or .ply"));
  check_file_target(path);
}

void draw(const std::filesystem::path& path, const Mesh& changes, const Eigen::Vector3f& up) {
  if (path.extension() == ".ply") return write_ply(path, changes);
  PictureConfig config;
  config.coloring = MeshColoring::kColors;
  write_file(path, encode_png(top_down(changes, up, config)));
}

void print_changes(const std::vector<ObjectChange>& changes, const MapDocument& a,
                   const MapDocument& b) {
  const auto name = [](const MapRecord& map, InstanceId id) {
    const auto found = map.names.find(id);
    return found == map.names.end() ? std::string() : " " + found->second;
  };
  std::size_t same = 0, unseen = 0;
  for (const ObjectChange& change : changes) {
    same += change.kind == ChangeKind::kSame;
    unseen += change.kind == ChangeKind::kUnseen;
    if (change.kind == ChangeKind::kSame || change.kind == ChangeKind::kUnseen) continue;
    std::printf("%-8s", change_name(change.kind));
    if (change.before != 0) std::printf(" #%u%s", change.before, name(a, change.before).c_str());
    if (change.before != 0 && change.after != 0) std::printf(" ->");
    if (change.after != 0) std::printf(" #%u%s", change.after, name(b, change.after).c_str());
    std::printf(": %s\n", change.evidence.c_str());
  }
  std::printf("%zu objects are where they were; of %zu nothing can be said\n", same, unseen);
}

nlohmann::json change_json(const HistoryChange& change, const MapHistory& history,
                           const HistoryDates& dates) {
  const ObjectEvent &first = history.events[change.first], &last = history.events[change.last];
  const bool came = change.kind == ObjectEventKind::kAppeared,
             went = change.kind == ObjectEventKind::kGone;
  const auto date = dates.date_of(change.last);
  return {{"change", change_name(came   ? ChangeKind::kNew
                                 : went ? ChangeKind::kRemoved
                                        : ChangeKind::kMoved)},
          {"before", came ? nlohmann::json() : nlohmann::json(change.instance)},
          {"after", went ? nlohmann::json() : nlohmann::json(change.instance)},
          {"box_before", box_json<nlohmann::json>(first.before)},
          {"box_after", box_json<nlohmann::json>(last.after)},
          {"visit", last.visit},
          {"time_s", json_or_null(date)},
          {"evidence", change_text(change, history, dates)}};
}

/// One map at two times, by what its visits found. Exit code 1: something changed.
int diff_times(const CompareOptions& options) {
  if (!options.transform.empty() || options.align)
    throw Error(
        "--since and --until compare one map with itself; leave --transform and --align out");
  const MapRecord map = read_corrected_record(options.a);
  const HistoryDates dates(map.history, map.frames);
  const auto [since, until, changes] =
      changes_between(map.history, dates, options.since, options.until, seconds_now());
  if (!options.out.empty()) {
    const MapDocument whole = load_corrected_map(options.a);
    draw(options.out, change_mesh(whole, changes), whole.up);
  }
  if (options.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const HistoryChange& change : changes)
      list.push_back(change_json(change, map.history, dates));
    print_json({{"map", options.a.string()},
                {"since", dates.text_of(since)},
                {"until", dates.text_of(until)},
                {"changes", list}});
    return changes.empty() ? kDone : kAnswerIsNo;
  }
  for (const HistoryChange& change : changes) {
    const auto name = map.names.find(change.instance);
    std::printf("#%u%s: %s\n", change.instance,
                name == map.names.end() ? "" : (" " + name->second).c_str(),
                change_text(change, map.history, dates).c_str());
  }
  std::printf("%zu changes from %s to %s\n", changes.size(), dates.text_of(since).c_str(),
              dates.text_of(until).c_str());
  return changes.empty() ? kDone : kAnswerIsNo;
}

/// Where one map goes on with the other, its own history tells more: of each thing that went it
/// kept what that was.
void tell_own_history(const CompareOptions& options, const MapRecord& a, const MapRecord& b) {
  const std::size_t before = std::max<std::size_t>(a.history.visits.size(), 1);
  const std::string& begun = a.history.visits.empty() ? a.source : a.history.visits[0].source;
  if (b.history.visits.size() <= before || b.history.visits[0].source != begun) return;
  warn(concat(options.b.string(), " goes on with ", options.a.string(), "; `ovimap diff ",
              options.b.string(), " --since \"visit ", before, "\"` tells what its history says"));
}

/// Exit code 1: something changed.
int diff(const CompareOptions& options) {
  const ThreadLimit limit(options.threads);
  const bool times = !options.since.empty() || !options.until.empty();
  if (times == !options.b.empty())
    throw Error("say what to compare the map with: another map, or with --since TIME its own past");
  check_drawing(options.out);
  if (times) return diff_times(options);
  const MapDocument a = load_corrected_map(options.a), b = load_corrected_map(options.b);
  const MapAlignment alignment = find_alignment(options, a, b);
  tell_own_history(options, a, b);
  const auto changes = diff_maps(a, b, alignment.a_from_b);
  if (!options.out.empty()) draw(options.out, change_mesh(a, b, alignment.a_from_b, changes), a.up);
  const bool changed = std::any_of(changes.begin(), changes.end(), [](const ObjectChange& change) {
    return change.kind != ChangeKind::kSame && change.kind != ChangeKind::kUnseen;
  });
  if (options.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const ObjectChange& change : changes) list.push_back(change_json(change));
    print_json({{"before", options.a.string()},
                {"after", options.b.string()},
                {"alignment", alignment_json(alignment, options.align)},
                {"changes", list}});
  } else {
    print_alignment(alignment);
    print_changes(changes, a, b);
  }
  return changed ? kAnswerIsNo : kDone;
}

/// A given frame in which the maps speak against each other is a mistake more often than a change.
void refuse_contradiction(const MapAlignment& alignment) {
  constexpr float kLeastFit = 0.5f;
  if (alignment.fit >= kLeastFit || alignment.overlap + alignment.fit == 0.f) return;
  throw Error(
      concat("the maps contradict each other as they lie: of the surface where both looked, ",
             "only ", std::lround(100 * alignment.fit),
             " % agrees; give the transform with --transform FILE, or find it with --align"));
}

/// Says that a map's past does not go into a merged one, and refuses to replace the only one.
void tell_lost_past(const CompareOptions& options) {
  for (const std::filesystem::path& map : {options.a, options.b}) {
    if (read_map_info(map).history.visits.size() < 2) continue;
    std::error_code ignored;
    if (std::filesystem::equivalent(map, options.out, ignored))
      throw Error(concat("'", map.string(),
                         "' is of several visits, whose history a merged map does not have; write "
                         "to another file with -o"));
    warn(concat(map.string(),
                " is of several visits; what changed between them (`info --history`) does not go "
                "into the merged map"));
  }
}

int merge(const CompareOptions& options) {
  const ThreadLimit limit(options.threads);
  check_map_target(options.out);
  tell_lost_past(options);
  const MapDocument b = load_map(options.b);
  MapAlignment alignment;
  {
    const MapDocument seen_a = load_corrected_map(options.a),
                      seen_b = load_corrected_map(options.b);
    alignment = find_alignment(options, seen_a, seen_b);
  }
  refuse_contradiction(alignment);
  MapMerge merged = merge_maps(load_map(options.a), b, alignment.a_from_b);
  save_again(options.a, options.out, merged.map);
  const std::size_t objects = read_map_info(options.out).instances.size();
  if (options.json) {
    nlohmann::json pairs = nlohmann::json::array(), conflicts = nlohmann::json::array();
    for (const MergedPair& pair : merged.pairs)
      pairs.push_back({{"a", pair.a},
                       {"b", pair.b},
                       {"overlap", pair.overlap},
                       {"cosine", json_or_null(pair.cosine)}});
    for (const MergeConflict& conflict : merged.conflicts)
      conflicts.push_back({{"a", conflict.a}, {"b", conflict.b}, {"what", conflict.what}});
    print_json({{"map", options.out.string()},
                {"alignment", alignment_json(alignment, options.align)},
                {"instances", objects},
                {"pairs", pairs},
                {"conflicts", conflicts}});
    return kDone;
  }
  print_alignment(alignment);
  std::printf("%s: %zu objects, %zu of them in both maps\n", options.out.c_str(), objects,
              merged.pairs.size());
  for (const MergeConflict& conflict : merged.conflicts)
    std::printf("conflict: #%u and #%u: %s\n", conflict.a, conflict.b, conflict.what.c_str());
  return kDone;
}

CLI::Option* add_compare_options(CLI::App& command, CompareOptions& options) {
  command.add_option("A", options.a, "map file")->required();
  CLI::Option* other = command.add_option("B", options.b, "another map of the same place");
  CLI::Option* given = command.add_option(
      "--transform", options.transform,
      "text file with the 4x4 matrix that takes B's points to A's frame; without it and without "
      "--align the frames are taken to be the same");
  command.add_flag("--align", options.align, "find that transform; refuses where it is not sure")
      ->excludes(given);
  command.add_option("--threads", options.threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options.json, "print one JSON object");
  return other;
}

}  // namespace

Action add_diff(CLI::App& command) {
  auto options = std::make_shared<CompareOptions>();
  add_compare_options(command, *options);
  command.add_option(
      "-o,--output", options->out,
      "draw it, .png (from above) or .ply: new green, moved blue, where it was light "
      "blue, removed red");
  command.add_option(
      "--since", options->since,
      "instead of B: what changed in A since a time, as `ovimap query --at` takes it");
  command.add_option("--until", options->until,
                     "and until this one; without, until its last visit");
  return [options] { return diff(*options); };
}

Action add_merge(CLI::App& command) {
  auto options = std::make_shared<CompareOptions>();
  add_compare_options(command, *options)->required();
  command.add_option("-o,--output", options->out, "map file to write")->required();
  return [options] { return merge(*options); };
}

}  // namespace ovimap::apps
