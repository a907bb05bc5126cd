// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_file_by_instance.h"

#include <algorithm>

#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/map_file_semantics.h"

namespace ovimap {

namespace {

using namespace map_tables;

/// Finds the super-point that stands for an instance.
class Heirs {
 public:
  Heirs(LabelForest& forest, MapRecord& record)
      : record_(record), registry_(record.instance_config) {
    for (InstanceSummary& instance : record.instances)
      if (instance.super_points.empty()) give_label(instance, forest);
    registry_.restore(InstanceRegistry::State(record.registry));
  }

  /// kNoLabel: nothing of the instance is left.
  Label of(InstanceId id) const {
    Label heir = voter(registry_.super_points_of(id), id);
    if (heir != kNoLabel) return heir;
    std::vector<Label> all;
    for (const auto& [label, point] : registry_.super_points()) all.push_back(label);
    heir = voter(all, id);
    if (heir != kNoLabel) return heir;
    const InstanceId now = registry_.resolve(id);
    return now == id ? kNoLabel : of(now);
  }

 private:
  /// The one with most votes for the instance; the oldest of equals.
  Label voter(const std::vector<Label>& labels, InstanceId id) const {
    Label best = kNoLabel;
    int most = 0;
    for (const Label label : labels) {
      const auto& votes = registry_.super_points().at(label).votes;
      const auto found = votes.find(id);
      if (found != votes.end() && found->second > most) best = label, most = found->second;
    }
    return best;
  }

  void give_label(InstanceSummary& instance, LabelForest& forest) {
    instance.super_points = {forest.create()};
    SuperPoint& point = record_.registry.super_points[instance.super_points.front()];
    point.frames_seen = std::max(1, instance.views);
    point.votes[instance.id] = point.frames_seen;
  }

  MapRecord& record_;
  InstanceRegistry registry_;
};

void read_records(SQLite::Database& database, const Heirs& heirs, InstanceRegistry::State& state) {
  RowReader rows(database, kInstanceRecords);
  while (rows.next()) {
    const Label heir = heirs.of(take_instance(rows, state.last_id));
    const auto views = rows.integer<std::uint32_t>();
    const auto first = rows.integer<std::int64_t>(), last = rows.integer<std::int64_t>();
    if (heir == kNoLabel || views == 0) continue;
    SuperPoint& point = state.super_points[heir];
    const bool known = !point.seen.runs().empty();
    point.first_frame = known ? std::min(point.first_frame, first) : first;
    point.last_frame = known ? std::max(point.last_frame, last) : last;
    point.seen |= FrameRuns({{0, views}});  // how many is told, but not which
    state.frames = std::max(state.frames, static_cast<int>(views));
  }
}

/// Looks by instance as they were stored: with directions of all views together.
struct OldLook {
  SuperPointLook look;
  ViewDirections directions;
};

std::map<InstanceId, OldLook> read_old_looks(SQLite::Database& database, const MapRecord& record) {
  const SphereGrid grid = record.semantics.views.grid(record.depth_camera);
  std::map<InstanceId, OldLook> result;
  RowReader rows(database, kAppearances);
  while (rows.next()) {
    auto& [look, directions] = result[rows.integer<InstanceId>()];
    for (Eigen::Vector3f* point :
         {&directions.center_in_world, &look.seen_in_world.min(), &look.seen_in_world.max()})
      for (float& coordinate : *point) coordinate = static_cast<float>(rows.real());
    directions.bins = take_bins(rows, grid);
    (void)rows.integer<int>();  // of the largest view, which is among the views
    look.offered = rows.integer<int>();
    look.queries = rows.integer<int>();
  }
  RowReader views(database, kViews);
  while (views.next()) {
    const auto owner = result.find(views.integer<InstanceId>());
    const auto ordinal = views.integer<std::size_t>();
    if (owner == result.end() || ordinal != owner->second.look.views.size())
      views.fail("has a view out of place");
    ObjectView view;
    view.frame = views.integer<std::int64_t>();
    view.visible_px = views.integer<int>();
    take_picture(views, record.semantics.encoder, view);
    owner->second.look.views.push_back(std::move(view));
  }
  return result;
}

/// Which view showed which direction is not told: the first one stands for all.
void inherit(OldLook old, Label heir, SuperPointLook& into) {
  into.seen_in_world.extend(old.look.seen_in_world);
  into.offered += old.look.offered;
  into.queries += old.look.queries;
  for (ObjectView& view : old.look.views) {
    view.super_point = heir;
    view.directions.center_in_world = old.directions.center_in_world;
    view.directions.bins = std::exchange(old.directions.bins, {});
    if (!find_view(into, view.key())) insert_view(into, std::move(view));
  }
}

}  // namespace

void read_by_instance(SQLite::Database& database, int schema, LabelForest& forest,
                      MapRecord& record) {
  const Heirs heirs(forest, record);
  record.registry.frames =
      static_cast<int>(std::count_if(record.frames.begin(), record.frames.end(),
                                     [](const FrameLogEntry& frame) { return frame.labelled; }));
  read_records(database, heirs, record.registry);
  if (schema < kSchemaWithSemantics) return;
  for (auto& [id, old] : read_old_looks(database, record))
    if (const Label heir = heirs.of(id); heir != kNoLabel)
      inherit(std::move(old), heir, record.semantics.looks[heir]);
}

}  // namespace ovimap
