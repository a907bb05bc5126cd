// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/visit_history.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "ovimap/base/error.h"
#include "ovimap/instance/instance_aliases.h"
#include "ovimap/pipeline/revise/scattered.h"
#include "ovimap/pipeline/revise/thing_look.h"
#include "ovimap/pipeline/revise/visit_surface.h"

namespace ovimap {

namespace {

/// A gone object and a found one that may be it.
struct Pair {
  std::size_t gone, found;  ///< in the list of changes
  float difference;         ///< of their shapes, and the share of colours that they do not share
};

/// What the last visit says, object by object.
class VisitTeller {
 public:
  VisitTeller(const MapDocument& before, MapDocument& after, const VisitHistoryConfig& config,
              std::shared_ptr<BlockStore> store)
      : before_(before),
        after_(after),
        config_(config),
        seen_(seen_in_visit(before, after, std::move(store))),
        gone_before_(gone_objects(before.history)) {}

  void tell() {
    changes_ = changes_of_visit();
    find_remains();
    leave_out_scattered();
    part_strangers();
    match_by_shape();
    join_unknown_strangers();
    for (const ObjectChange& change : changes_) tell(change);
    forget_remains(before_, seen_, places_left(), after_);
    keep_ids();
    std::stable_sort(events_.begin(), events_.end(),
                     [](const auto& a, const auto& b) { return a.instance < b.instance; });
    auto& all = after_.history.events;
    all.insert(all.end(), events_.begin(), events_.end());
    drop_gone();
  }

 private:
  /// Only what the visit itself saw bears witness.
  std::vector<ObjectChange> changes_of_visit() {
    std::swap(seen_.semantics, after_.semantics);
    std::vector<ObjectChange> changes = diff_maps(before_, seen_, Pose::Identity(), config_.diff);
    std::swap(seen_.semantics, after_.semantics);
    return changes;
  }

  /// Of a thing that is gone, what it stood on keeps some of its labels: that is not it. And what
  /// shifted by no more than surfaces are rough has not.
  void find_remains() {
    for (ObjectChange& change : changes_)
      if (change.kind == ChangeKind::kMoved && change.shift_m.norm() < config_.least_shift_m)
        change.kind = ChangeKind::kSame;
    for (ObjectChange& change : changes_)
      if (change.kind == ChangeKind::kSame && change.before != 0 && has_left(change)) {
        change.kind = ChangeKind::kRemoved;
        change.after = 0;
      }
  }

  /// They go, and nothing is said of it.
  void leave_out_scattered() {
    for (ObjectChange& change : changes_) {
      if (change.kind == ChangeKind::kRemoved &&
          is_scattered(before_, change.before, config_.least_filled)) {
        remains_.insert(change.before);
        change.kind = ChangeKind::kUnseen;
      }
      if (change.before == 0 && change.after != 0 &&
          is_scattered(seen_, change.after, config_.least_filled))
        change.after = 0;
    }
  }

  bool has_left(const ObjectChange& change) const {
    if (change.overlap < config_.diff.same_iou) return is_away(change, config_.diff);
    return change.before == change.after && change.seen_through >= config_.diff.gone_share;
  }

  /// The things that are not where they were.
  std::set<InstanceId> places_left() const {
    std::set<InstanceId> left = remains_;
    for (const ObjectChange& change : changes_)
      if (change.kind == ChangeKind::kRemoved || change.kind == ChangeKind::kMoved)
        left.insert(change.before);
    return left;
  }

  /// What came to where another thing left has that one's id in the map, and looks like a shift of
  /// it where they overlap: unless it does not look like it.
  void part_strangers() {
    const std::size_t known = changes_.size();
    for (std::size_t i = 0; i < known; ++i) {
      if (changes_[i].kind != ChangeKind::kMoved || changes_[i].overlap == 0.f) continue;
      if (difference_of(look_before(changes_[i].before), look_now(changes_[i].after))) continue;
      strangers_.emplace_back(i, changes_.size());
      const ObjectChange come = part_arrival(changes_[i]);
      changes_[i].kind = ChangeKind::kRemoved;
      changes_.push_back(come);
    }
  }

  /// A stranger that nothing else is was taken for one without need.
  void join_unknown_strangers() {
    for (const auto& [left, come] : strangers_) {
      if (changes_[left].kind != ChangeKind::kRemoved || changes_[come].after == 0) continue;
      changes_[left].kind = ChangeKind::kMoved;
      changes_[left].after = std::exchange(changes_[come].after, 0);
    }
  }

  /// Things that the map before did not have: new ones, and those whose places nobody had looked
  /// at, which are told of only where a thing that is gone fits them.
  static bool may_have_come(const ObjectChange& change) {
    return change.before == 0 && change.after != 0 &&
           (change.kind == ChangeKind::kNew || change.kind == ChangeKind::kUnseen);
  }

  const ThingLook& look_before(InstanceId id) { return look_in(before_, id, looks_before_); }
  /// While ids are those that the map gave.
  const ThingLook& look_now(InstanceId id) { return look_in(seen_, id, looks_now_); }

  const ThingLook& look_in(const MapDocument& map, InstanceId id,
                           std::map<InstanceId, ThingLook>& made) const {
    auto found = made.find(id);
    if (found == made.end()) found = made.emplace(id, thing_look(map, id, before_.up)).first;
    return found->second;
  }

  /// In shape and colours, of what could be one thing; none where two things cannot be one.
  std::optional<float> difference_of(const ThingLook& was, const ThingLook& is) const {
    const float coarse = config_.coarse_voxels * before_.map.config().voxel_size_m /
                         std::max(was.reach_m, is.reach_m);
    const float shapes = shape_distance(was, is) / std::max(config_.same_shape, coarse);
    const float difference = shapes + 1.f - common_colors(was, is);
    if (difference > config_.most_difference) return std::nullopt;
    return difference;
  }

  /// Pairs that could be one thing, the likeliest first.
  std::vector<Pair> likely_pairs() {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      if (changes_[i].kind != ChangeKind::kRemoved) continue;
      const ThingLook& gone = look_before(changes_[i].before);
      for (std::size_t k = 0; k < changes_.size(); ++k)
        if (may_have_come(changes_[k]))
          if (const auto difference = difference_of(gone, look_now(changes_[k].after)))
            pairs.push_back({i, k, *difference});
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.difference < b.difference; });
    return pairs;
  }

  void match_by_shape() {
    const std::vector<Pair> pairs = likely_pairs();
    std::set<std::size_t> used;
    std::set<InstanceId> doubted;  // each gone one may be one found one
    for (const Pair& pair : pairs) {
      if (used.contains(pair.gone) || used.contains(pair.found)) continue;
      const bool doubtful = std::any_of(pairs.begin(), pairs.end(), [&](const Pair& other) {
        const bool rival = (other.gone == pair.gone) != (other.found == pair.found);
        return rival && other.difference < pair.difference + config_.doubt;
      });
      if (doubtful) {
        const InstanceId found = changes_[pair.found].after, gone = changes_[pair.gone].before;
        if (!may_be_.contains(found) && doubted.insert(gone).second) may_be_.emplace(found, gone);
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
    // What is left of a thing that is known to be gone may be seen through only now.
    if (change.kind == ChangeKind::kRemoved && !gone_before_.contains(id))
      add(ObjectEventKind::kGone, id, box_of(before_, id), {}, last_frame());
    if (change.kind == ChangeKind::kNew) {
      add(ObjectEventKind::kAppeared, id, {}, box_of(seen_, id), first_frame(id));
      if (const auto known = may_be_.find(id); known != may_be_.end())
        events_.back().may_be = known->second;
    }
    if (change.kind == ChangeKind::kMoved)
      add(ObjectEventKind::kMoved, id, box_of(before_, id), box_of(seen_, change.after),
          first_frame(change.after));
  }

  void add(ObjectEventKind kind, InstanceId id, const Eigen::AlignedBox3f& from,
           const Eigen::AlignedBox3f& to, std::int64_t frame) {
    events_.push_back({id, kind, static_cast<int>(after_.history.visits.size()), frame, from, to, 0,
                       from.isEmpty() ? nullptr : past_of(before_, id)});
  }

  std::int64_t last_frame() const { return static_cast<std::int64_t>(after_.frames.size()) - 1; }

  /// Place of the visit's frame that showed the instance first.
  std::int64_t first_frame(InstanceId id) const {
    const InstanceSummary* instance = find_instance(after_.instances, id);
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
      if (change.before == 0 || change.after == 0 || change.before == change.after) continue;
      const bool new_id = find_instance(before_.instances, change.after) == nullptr;
      const bool nothing_left = find_instance(after_.instances, change.before) == nullptr;
      const bool trades = change.kind == ChangeKind::kMoved  ? new_id || is_alone(change)
                          : change.kind == ChangeKind::kSame ? new_id && nothing_left
                                                             : false;
      if (trades) trade_ids(change.before, change.after, new_id);
    }
  }

  /// Whether no other thing of before is what was found: it has that one's id by its place alone.
  bool is_alone(const ObjectChange& change) const {
    return std::count_if(changes_.begin(), changes_.end(), [&](const ObjectChange& other) {
             return other.before != 0 && other.after == change.after;
           }) == 1;
  }

  /// What is left of a thing that is gone, on what it stood on or where this visit looked without
  /// seeing through, is no object.
  void drop_gone() {
    const std::set<InstanceId> gone = gone_objects(after_.history);
    std::erase_if(after_.instances,
                  [&](const auto& instance) { return gone.contains(instance.id); });
    std::erase_if(after_.surfaces, [&](const auto& entry) { return gone.contains(entry.first); });
  }

  void trade_ids(InstanceId a, InstanceId b, bool new_id) {
    if (new_id)
      swap_instances(after_, a, b);
    else
      take_place(after_, a, b);
    pass_corrections(b, a);
    const auto other = [a, b](InstanceId id) { return id == a ? b : id == b ? a : id; };
    for (ObjectChange& change : changes_) change.after = other(change.after);
    for (ObjectEvent& event : events_)
      if (event.kind == ObjectEventKind::kAppeared) event.instance = other(event.instance);
  }

  /// What people said of an object while a live visit took it for another.
  void pass_corrections(InstanceId from, InstanceId to) {
    MapEdits& edits = after_.edits;
    for (std::size_t i = before_.edits.size(); i < edits.size(); ++i)
      if (auto& ids = edits[i].instances; std::find(ids.begin(), ids.end(), to) == ids.end())
        std::replace(ids.begin(), ids.end(), from, to);
  }

  const MapDocument& before_;
  MapDocument& after_;
  const VisitHistoryConfig& config_;
  MapDocument seen_;  ///< of `after`, in the visit
  const std::set<InstanceId> gone_before_;
  std::vector<ObjectChange> changes_;
  std::set<InstanceId> remains_;  ///< of what was no thing any more before the visit
  std::vector<std::pair<std::size_t, std::size_t>> strangers_;  ///< what left, and what came there
  std::map<InstanceId, InstanceId> may_be_;  ///< found objects and the gone ones that they resemble
  std::map<InstanceId, ThingLook> looks_before_, looks_now_;
  std::vector<ObjectEvent> events_;
};

/// Aliases after ids were exchanged: of ids that stand for one thing the oldest stands for all.
template <class Exchange>
InstanceAliases oldest_of_each(const InstanceAliases& aliases, const Exchange& other) {
  std::map<InstanceId, InstanceId> oldest;  // by what stood for them before
  for (const auto& [id, target] : aliases) {
    const InstanceId all = resolve_alias(aliases, id);
    const InstanceId least = std::min(other(id), other(all));
    const auto [found, first] = oldest.try_emplace(all, least);
    if (!first) found->second = std::min(found->second, least);
  }
  InstanceAliases result;
  for (const auto& [id, target] : aliases) {
    const InstanceId all = resolve_alias(aliases, id), least = oldest.at(all);
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
  const InstanceAliases aliases = oldest_of_each(record.registry.aliases, other);
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

void take_place(MapRecord& record, InstanceId known, InstanceId gone) {
  std::map<InstanceId, InstanceId> fresh;  // by the ids that it gives back
  InstanceId last = last_instance(record);
  for (const auto& [id, target] : record.registry.aliases)
    if (id < known && resolve_alias(record.registry.aliases, id) == gone) fresh[id] = ++last;
  for (auto& [label, point] : record.registry.super_points)
    for (const auto& [id, instead] : fresh)
      if (auto votes = point.votes.extract(id)) {
        votes.key() = instead;
        point.votes.insert(std::move(votes));
      }
  for (const auto& [id, instead] : fresh) {
    record.registry.aliases.erase(id);
    record.registry.aliases[instead] = gone;
    record.registry.last_id = instead;
  }
  swap_instances(record, known, gone);
  for (const auto& [id, instead] : fresh) record.registry.aliases[id] = gone;
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

void begin_visit(MapDocument& begun, const PastEvidenceConfig& past, MapHeader& header) {
  discount_past(begun.map, past);
  begun.seen_free.clear();
  begin_visit(begun, header);
}

void tell_visit(const MapDocument& before, MapDocument& after, const VisitHistoryConfig& config,
                std::shared_ptr<BlockStore> store) {
  OVIMAP_ASSERT(after.history.visits.size() > 1);
  VisitTeller(before, after, config, std::move(store)).tell();
}

}  // namespace ovimap
