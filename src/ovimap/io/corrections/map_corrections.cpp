// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/corrections/map_corrections.h"

#include <algorithm>
#include <set>

#include "ovimap/instance/object_boxes.h"
#include "ovimap/io/corrections/map_edit_log.h"

namespace ovimap {

namespace {

/// A super-point of an object that mapping found, and the object it belongs to by now (0: none). An
/// object without super-points, as `ovimap embed` makes them, is one unit with label 0.
struct Unit {
  InstanceId found_in;
  Label label;
  InstanceId owner;
};

/// Who owns what after the edits.
class Ownership {
 public:
  Ownership(const MapRecord& record, const LabelForest& forest)
      : registry_(record.registry),
        by_consensus_(record.instance_config.instances == InstanceReading::kConsensus),
        forest_(forest),
        aliases_(record.registry.aliases),
        names_(record.names) {
    for (const InstanceSummary& instance : record.instances) {
      for (const Label label : instance.super_points)
        units_.push_back({instance.id, label, instance.id});
      if (instance.super_points.empty()) units_.push_back({instance.id, kNoLabel, instance.id});
    }
  }

  void apply(const MapEdit& edit) {
    const InstanceId id = edit.instances.empty() ? 0 : resolve(edit.instances.front());
    switch (edit.action) {
      case EditAction::kRename:
        return rename(id, edit.name);
      case EditAction::kMerge:
        for (std::size_t i = 1; i < edit.instances.size(); ++i)
          merge(id, resolve(edit.instances[i]));
        return;
      case EditAction::kSplit:
        return split(id, roots_of(edit.super_points), edit.new_instance);
      case EditAction::kLock:
        return lock(edit.instances.front(), roots_of(edit.super_points));
      case EditAction::kDelete:
        return give(id, 0);
      case EditAction::kHide:
        hidden_.insert(id);
        return;
      case EditAction::kUndo:
        return;
    }
  }

  const std::vector<Unit>& units() const { return units_; }
  bool hidden(InstanceId id) const { return hidden_.contains(id); }
  const std::set<InstanceId>& locked() const { return locked_; }
  const InstanceAliases& aliases() const { return aliases_; }
  const std::map<InstanceId, std::string>& names() const { return names_; }

 private:
  InstanceId resolve(InstanceId id) const { return resolve_alias(aliases_, id); }

  std::set<Label> roots_of(const std::vector<Label>& labels) const {
    std::set<Label> roots;
    for (const Label label : labels) roots.insert(forest_.root(label));
    return roots;
  }

  bool owns_any(InstanceId id) const {
    return std::any_of(units_.begin(), units_.end(), [&](const Unit& u) { return u.owner == id; });
  }

  void rename(InstanceId id, const std::string& name) {
    if (name.empty())
      names_.erase(id);
    else
      names_[id] = name;
  }

  void give(InstanceId from, InstanceId to) {
    for (Unit& unit : units_)
      if (unit.owner == from) unit.owner = to;
  }

  /// Also where one of them has lost all its surface since: what later joins it joins the other.
  void merge(InstanceId keep, InstanceId drop) {
    if (keep == drop) return;
    give(drop, keep);
    aliases_[drop] = keep;
    if (const auto name = names_.find(drop); name != names_.end()) {
      names_.try_emplace(keep, name->second);
      names_.erase(drop);
    }
  }

  /// Nothing happens when all of it would leave, or nothing.
  void split(InstanceId id, const std::set<Label>& leaving, InstanceId new_id) {
    const auto leaves = [&](const Unit& u) { return u.owner == id && leaving.contains(u.label); };
    const auto stays = [&](const Unit& u) { return u.owner == id && !leaving.contains(u.label); };
    if (std::none_of(units_.begin(), units_.end(), stays)) return;
    for (Unit& unit : units_)
      if (leaves(unit)) unit.owner = new_id;
  }

  /// The super-points are the object's, whoever took them since; others that joined it go.
  void lock(InstanceId id, const std::set<Label>& kept) {
    locked_.insert(id);
    aliases_.erase(id);
    for (Unit& unit : units_) {
      if (kept.contains(unit.label))
        unit.owner = id;
      else if (unit.owner == id && unit.label != kNoLabel)
        unit.owner = own_id(unit.label, id);
    }
  }

  /// The id that mapping gave a super-point for itself, if nobody else goes by it.
  InstanceId own_id(Label label, InstanceId not_this) const {
    const auto point = registry_.super_points.find(label);
    if (!by_consensus_ || point == registry_.super_points.end() || point->second.votes.empty())
      return 0;
    const InstanceId own = point->second.votes.begin()->first;
    return own == not_this || owns_any(own) ? 0 : own;
  }

  const InstanceRegistry::State& registry_;
  bool by_consensus_;
  const LabelForest& forest_;
  InstanceAliases aliases_;
  std::map<InstanceId, std::string> names_;
  std::set<InstanceId> hidden_, locked_;
  std::vector<Unit> units_;
};

/// An object as it is put together from what was found.
struct Composition {
  std::set<InstanceId> sources;  ///< found objects of which it has parts
  std::set<InstanceId> whole;    ///< those it has altogether
  std::vector<Label> super_points;
};

std::map<InstanceId, Composition> compose(const std::vector<Unit>& units) {
  std::map<InstanceId, std::size_t> found_units;
  std::map<std::pair<InstanceId, InstanceId>, std::size_t> shared_units;
  std::map<InstanceId, Composition> objects;
  for (const Unit& unit : units) {
    ++found_units[unit.found_in];
    if (unit.owner == 0) continue;
    ++shared_units[{unit.owner, unit.found_in}];
    Composition& object = objects[unit.owner];
    object.sources.insert(unit.found_in);
    if (unit.label != kNoLabel) object.super_points.push_back(unit.label);
  }
  for (const auto& [pair, count] : shared_units)
    if (count == found_units.at(pair.second)) objects[pair.first].whole.insert(pair.second);
  for (auto& [id, object] : objects)
    std::sort(object.super_points.begin(), object.super_points.end());
  return objects;
}

InstanceSummary united(const InstanceSummary& a, const InstanceSummary& b) {
  InstanceSummary both = a;
  both.box.extend(b.box);
  const double share = static_cast<double>(b.points) /
                       std::max(1., static_cast<double>(a.points) + static_cast<double>(b.points));
  both.centroid += (b.centroid - a.centroid) * static_cast<float>(share);
  both.points += b.points;
  both.views = std::max(a.views, b.views);
  both.confidence.reset();  // what masks said of either is not said of both
  return both;
}

/// Builds the corrected parts of a record.
class Assembly {
 public:
  Assembly(const MapRecord& found, const VoxelSource& voxels) : found_(found), voxels_(voxels) {
    for (const InstanceSummary& instance : found.instances) by_id_[instance.id] = &instance;
  }

  /// Measures what no found object is made of: the parts of those taken apart.
  void measure(const std::map<InstanceId, Composition>& objects) {
    std::vector<InstanceSummary> parts;
    for (const auto& [id, object] : objects) {
      if (object.whole == object.sources) continue;
      InstanceSummary& part = parts.emplace_back();
      part.id = id;
      part.super_points = object.super_points;
      part.views = record_of(found_.registry.super_points, part.super_points).views;
      if (part.views > 0) continue;
      for (const InstanceId source : object.sources)  // an older map does not tell
        part.views = std::max(part.views, by_id_.at(source)->views);
    }
    if (parts.empty()) return;
    const VoxelMap& map = voxels_();
    measure_instances(map, parts);
    surfaces_ = surfaces_and_boxes(map, parts);
    for (InstanceSummary& part : parts) measured_[part.id] = std::move(part);
  }

  InstanceSummary summary(InstanceId id, const Composition& object) const {
    if (const auto part = measured_.find(id); part != measured_.end()) return part->second;
    InstanceSummary result = *by_id_.at(*object.whole.begin());
    for (auto other = std::next(object.whole.begin()); other != object.whole.end(); ++other)
      result = united(result, *by_id_.at(*other));
    result.id = id;
    result.super_points = object.super_points;
    return result;
  }

  std::vector<Eigen::Vector3f> surface(InstanceId id, const Composition& object) const {
    if (measured_.contains(id)) {
      const auto part = surfaces_.find(id);
      return part == surfaces_.end() ? std::vector<Eigen::Vector3f>{} : part->second;
    }
    std::vector<Eigen::Vector3f> points;
    for (const InstanceId source : object.whole)
      if (const auto found = found_.surfaces.find(source); found != found_.surfaces.end())
        points.insert(points.end(), found->second.begin(), found->second.end());
    return points;
  }

 private:
  const MapRecord& found_;
  const VoxelSource& voxels_;
  std::map<InstanceId, const InstanceSummary*> by_id_;
  std::map<InstanceId, InstanceSummary> measured_;
  InstanceSurfaces surfaces_;
};

}  // namespace

InstanceAliases apply_edits(MapRecord& record, const LabelForest& forest,
                            const VoxelSource& voxels) {
  const MapEdits edits = effective_edits(record.edits);
  if (edits.empty()) return record.registry.aliases;
  Ownership ownership(record, forest);
  for (const MapEdit& edit : edits) ownership.apply(edit);
  const std::map<InstanceId, Composition> objects = compose(ownership.units());
  Assembly assembly(record, voxels);
  assembly.measure(objects);
  std::vector<InstanceSummary> visible, hidden;
  InstanceSurfaces surfaces;
  for (const auto& [id, object] : objects) {
    (ownership.hidden(id) ? hidden : visible).push_back(assembly.summary(id, object));
    if (auto points = assembly.surface(id, object); !points.empty())
      surfaces.emplace(id, std::move(points));
  }
  record.instances = std::move(visible);
  record.hidden = std::move(hidden);
  record.surfaces = std::move(surfaces);
  record.names = ownership.names();
  record.locked = ownership.locked();
  return ownership.aliases();
}

}  // namespace ovimap
