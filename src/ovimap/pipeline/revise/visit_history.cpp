// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/visit_history.h"

#include <algorithm>
#include <map>
#include <set>

#include "ovimap/base/error.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/pipeline/revise/thing_look.h"

namespace ovimap {

namespace {

const InstanceSummary* find_instance(const MapRecord& record, InstanceId id) {
  const auto found =
      std::find_if(record.instances.begin(), record.instances.end(),
                   [id](const InstanceSummary& instance) { return instance.id == id; });
  return found == record.instances.end() ? nullptr : &*found;
}

/// The box of a thing's surface without pieces that lie apart from the rest and are less than a
/// twentieth of it, nor a hundredth at either end of each axis: stray points would tell of another
/// place.
Eigen::AlignedBox3f box_of(const MapRecord& record, InstanceId id) {
  constexpr float kApart_m = 0.05f, kLeastPiece = 0.05f;
  constexpr std::size_t kLeftOut = 100;
  const auto surface = record.surfaces.find(id);
  if (surface == record.surfaces.end() || surface->second.empty()) {
    const InstanceSummary* instance = find_instance(record, id);
    return instance ? instance->box : Eigen::AlignedBox3f();
  }
  const std::vector<Eigen::Vector3f> points = large_pieces(surface->second, kApart_m, kLeastPiece);
  std::vector<float> values(points.size());
  Eigen::Vector3f low, high;
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [axis](const Eigen::Vector3f& point) { return point[axis]; });
    std::sort(values.begin(), values.end());
    low[axis] = values[values.size() / kLeftOut];
    high[axis] = values[values.size() - 1 - values.size() / kLeftOut];
  }
  return {low, high};
}

/// What will be known of an object when it is not there any more; null where it has no surface.
std::shared_ptr<const PastObject> past_of(const MapDocument& map, InstanceId id) {
  const InstanceSummary* instance = find_instance(map, id);
  const auto surface = map.surfaces.find(id);
  if (instance == nullptr || surface == map.surfaces.end() || surface->second.empty())
    return nullptr;
  auto was = std::make_shared<PastObject>(PastObject{instance->centroid, instance->points,
                                                     instance->views, instance->super_points,
                                                     surface->second, {}});
  VoxelFinder finder(map.map);
  for (const Eigen::Vector3f& point : was->surface) was->colors.push_back(color_at(finder, point));
  map.map.trim();
  return was;
}

/// A gone object and a found one that may be it.
struct Pair {
  std::size_t gone, found;  ///< in the list of changes
  float distance;           ///< how much of what both could see speaks against it
};

/// What the last visit says, object by object.
class VisitTeller {
 public:
  VisitTeller(const MapDocument& before, MapDocument& after, const VisitHistoryConfig& config)
      : before_(before), after_(after), config_(config) {}

  void tell() {
    changes_ = changes_of_visit();
    find_remains();
    match_by_shape();
    for (const ObjectChange& change : changes_) tell(change);
    keep_ids();
    std::stable_sort(events_.begin(), events_.end(),
                     [](const auto& a, const auto& b) { return a.instance < b.instance; });
    auto& all = after_.history.events;
    all.insert(all.end(), events_.begin(), events_.end());
  }

 private:
  /// Only the visit's own frames bear witness that something is gone.
  std::vector<ObjectChange> changes_of_visit() {
    std::vector<FrameLogEntry> all = after_.frames;
    after_.frames.erase(after_.frames.begin(),
                        after_.frames.begin() + after_.history.visits.back().first_frame);
    std::vector<ObjectChange> changes =
        diff_maps(before_, after_, Pose::Identity(), config_.diff);
    after_.frames = std::move(all);
    return changes;
  }

  /// Of a thing that is gone, sides may be left that the visit did not look at: they are not it. And
  /// what shifted by no more than surfaces are rough has not.
  void find_remains() {
    for (ObjectChange& change : changes_)
      if (change.kind == ChangeKind::kMoved && change.shift_m.norm() < config_.least_shift_m)
        change.kind = ChangeKind::kSame;
    for (ObjectChange& change : changes_)
      if (change.kind == ChangeKind::kSame && change.before != 0 &&
          (change.before == change.after || change.overlap < config_.diff.same_iou) &&
          is_gone(change)) {
        change.kind = ChangeKind::kRemoved;
        change.after = 0;
      }
  }

  /// By what the visit looked at: what it has from earlier ones alone may only be left.
  bool is_gone(const ObjectChange& change) const {
    const float looked_at = 1.f - change.surface_unseen;
    return change.seen_through >= config_.diff.shift_share &&
           change.seen_through >= config_.diff.gone_share * looked_at;
  }

  /// Whether it is known to be gone already, and what is left of it was seen through only now.
  bool told_gone(InstanceId id) const {
    const auto& events = after_.history.events;
    const auto last = std::find_if(events.rbegin(), events.rend(), [id](const ObjectEvent& event) {
      return event.instance == id;
    });
    return last != events.rend() && last->kind == ObjectEventKind::kGone;
  }

  /// Things that the map before did not have: new ones, and those whose places nobody had looked at,
  /// which are told of only where a thing that is gone fits them.
  static bool may_have_come(const ObjectChange& change) {
    return change.before == 0 && change.after != 0 &&
           (change.kind == ChangeKind::kNew || change.kind == ChangeKind::kUnseen);
  }

  struct Looks {
    ObservedSpace seen;
    std::map<std::size_t, ThingLook> things;  ///< by place in the list of changes
  };
  template <class Which, class Id>
  Looks looks_of(const MapDocument& map, std::int64_t first_frame, const Which& which,
                 const Id& id) const {
    std::map<std::size_t, ThingLook> things;
    for (std::size_t i = 0; i < changes_.size(); ++i)
      if (which(changes_[i])) things.emplace(i, thing_look(map, id(changes_[i]), before_.up));
    std::vector<Pose> poses;  // who has nothing to ask about needs no space
    if (!things.empty())
      for (auto frame = map.frames.begin() + first_frame; frame != map.frames.end(); ++frame)
        poses.push_back(frame->world_from_camera);
    return {ObservedSpace(map.map, map.depth_camera, poses, config_.diff.space), std::move(things)};
  }

  /// Pairs that could be one thing, the likeliest first.
  std::vector<Pair> likely_pairs() const {
    std::vector<Pair> pairs;
    const Looks gone = looks_of(
        before_, 0, [](const ObjectChange& c) { return c.kind == ChangeKind::kRemoved; },
        [](const ObjectChange& c) { return c.before; });
    if (gone.things.empty()) return pairs;
    const Looks found =
        looks_of(after_, after_.history.visits.back().first_frame, may_have_come,
                 [](const ObjectChange& c) { return c.after; });
    const float voxel_m = before_.map.config().voxel_size_m;
    for (const auto& [i, left] : gone.things)
      for (const auto& [k, came] : found.things) {
        const ThingFit fit = fit_things(left, gone.seen, came, found.seen, voxel_m, config_.fit);
        if (fit.agreed >= config_.least_agreed && fit.fit() >= config_.least_fit)
          pairs.push_back({i, k, 1.f - fit.fit()});
      }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
    return pairs;
  }

  void match_by_shape() {
    const std::vector<Pair> pairs = likely_pairs();
    std::set<std::size_t> used;
    for (const Pair& pair : pairs) {
      if (used.contains(pair.gone) || used.contains(pair.found)) continue;
      const bool doubtful = std::any_of(pairs.begin(), pairs.end(), [&](const Pair& other) {
        const bool rival = (other.gone == pair.gone) != (other.found == pair.found);
        return rival && pair.distance > config_.doubt * other.distance;
      });
      if (doubtful) {
        may_be_.try_emplace(changes_[pair.found].after, changes_[pair.gone].before);
        continue;
      }
      used.insert({pair.gone, pair.found});
      changes_[pair.gone].kind = ChangeKind::kMoved;
      changes_[pair.gone].after = changes_[pair.found].after;
      changes_[pair.found].after = 0;  // told with where it went from
    }
  }

  void tell(const ObjectChange& change) {
    const InstanceId id = change.before != 0 ? change.before : change.after;
    if (id == 0) return;
    if (change.kind == ChangeKind::kRemoved && !told_gone(id) && shows(before_, id))
      add(ObjectEventKind::kGone, id, box_of(before_, id), {}, last_frame());
    if (change.kind == ChangeKind::kNew && shows(after_, id)) {
      add(ObjectEventKind::kAppeared, id, {}, box_of(after_, id), first_frame(id));
      if (const auto known = may_be_.find(id); known != may_be_.end())
        events_.back().may_be = known->second;
    }
    if (change.kind == ChangeKind::kMoved)
      add(ObjectEventKind::kMoved, id, box_of(before_, id), box_of(after_, change.after),
          first_frame(change.after));
  }

  /// Whether there is enough of a thing to tell of it.
  bool shows(const MapRecord& record, InstanceId id) const {
    const auto surface = record.surfaces.find(id);
    return surface != record.surfaces.end() &&
           surface->second.size() >= static_cast<std::size_t>(config_.least_points);
  }

  void add(ObjectEventKind kind, InstanceId id, const Eigen::AlignedBox3f& from,
           const Eigen::AlignedBox3f& to, std::int64_t frame) {
    events_.push_back({id, kind, static_cast<int>(after_.history.visits.size()), frame, from, to, 0,
                       from.isEmpty() ? nullptr : past_of(before_, id)});
  }

  std::int64_t last_frame() const { return static_cast<std::int64_t>(after_.frames.size()) - 1; }

  /// Place of the visit's frame that showed the instance first.
  std::int64_t first_frame(InstanceId id) const {
    const InstanceSummary* instance = find_instance(after_, id);
    const std::int64_t begin = after_.history.visits.back().first_frame;
    if (instance == nullptr) return begin;
    const std::int64_t number =
        record_of(after_.registry.super_points, instance->super_points).first_frame;
    const auto found =
        std::find_if(after_.frames.begin() + begin, after_.frames.end(),
                     [number](const FrameLogEntry& frame) { return frame.index >= number; });
    return std::min(found - after_.frames.begin(), std::ptrdiff_t{last_frame()});
  }

  /// Objects that are known go on under the ids that they had.
  void keep_ids() {
    for (const ObjectChange& change : changes_) {
      const bool known = change.kind == ChangeKind::kMoved || change.kind == ChangeKind::kSame;
      if (!known || change.before == 0 || change.after == 0 || change.before == change.after)
        continue;
      const bool free = change.kind == ChangeKind::kMoved ||  // else what is left of it
                        find_instance(after_, change.before) == nullptr;
      if (free && find_instance(before_, change.after) == nullptr)
        swap_instances(after_, change.before, change.after);
    }
  }

  const MapDocument& before_;
  MapDocument& after_;
  const VisitHistoryConfig& config_;
  std::vector<ObjectChange> changes_;
  std::map<InstanceId, InstanceId> may_be_;  ///< found objects and the gone ones that they resemble
  std::vector<ObjectEvent> events_;
};

/// Aliases after ids were exchanged: of ids that stand for one thing the oldest stands for all.
template <class Exchange>
std::map<InstanceId, InstanceId> oldest_of_each(const std::map<InstanceId, InstanceId>& aliases,
                                                const Exchange& other) {
  const auto last = [&](InstanceId id) {
    for (auto found = aliases.find(id); found != aliases.end(); found = aliases.find(id))
      id = found->second;
    return id;
  };
  std::map<InstanceId, InstanceId> oldest;  // by what stood for them before
  for (const auto& [id, target] : aliases) {
    const InstanceId all = last(id);
    const InstanceId least = std::min(other(id), other(all));
    const auto [found, first] = oldest.try_emplace(all, least);
    if (!first) found->second = std::min(found->second, least);
  }
  std::map<InstanceId, InstanceId> result;
  for (const auto& [id, target] : aliases) {
    const InstanceId all = last(id), least = oldest.at(all);
    for (const InstanceId one : {other(id), other(all)})
      if (one != least) result[one] = least;
  }
  return result;
}

}  // namespace

void swap_instances(MapRecord& record, InstanceId a, InstanceId b) {
  const auto other = [a, b](InstanceId id) { return id == a ? b : id == b ? a : id; };
  for (auto& [label, point] : record.registry.super_points) {
    std::map<InstanceId, int> votes;
    for (const auto& [id, count] : point.votes) votes.emplace(other(id), count);
    point.votes = std::move(votes);
  }
  const std::map<InstanceId, InstanceId> aliases = oldest_of_each(record.registry.aliases, other);
  const auto now = [&](InstanceId id) {
    const auto alias = aliases.find(other(id));
    return alias == aliases.end() ? other(id) : alias->second;
  };
  for (InstanceSummary& instance : record.instances) instance.id = now(instance.id);
  std::sort(record.instances.begin(), record.instances.end(),
            [](const auto& x, const auto& y) { return x.id < y.id; });
  InstanceSurfaces surfaces;
  for (auto& [id, points] : record.surfaces) surfaces.emplace(now(id), std::move(points));
  record.surfaces = std::move(surfaces);
  record.registry.aliases = aliases;
}

void begin_visit(const MapRecord& begun, MapHeader& header) {
  MapHistory history = begun.history;
  if (history.visits.empty()) history.visits.push_back({begun.source, 0, 0});
  const std::int64_t next = begun.frames.empty() ? 0 : begun.frames.back().index + 1;
  history.visits.push_back({header.source, static_cast<std::int64_t>(begun.frames.size()), next});
  if (!header.history.visits.empty())
    history.visits.back().recorded_s = header.history.visits.front().recorded_s;
  header.history = std::move(history);
}

void tell_visit(const MapDocument& before, MapDocument& after, const VisitHistoryConfig& config) {
  OVIMAP_ASSERT(after.history.visits.size() > 1);
  VisitTeller(before, after, config).tell();
}

}  // namespace ovimap
