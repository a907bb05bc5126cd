// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tsl/robin_map.h>

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "ovimap/instance/consensus/edge_contraction.h"
#include "ovimap/instance/consensus/indexed_map.h"
#include "ovimap/instance/consensus/super_point_shapes.h"

namespace ovimap {

class ConfigFields;

struct ConsensusConfig {
  float apart_weight = 0.5f;  ///< what a frame that keeps two super-points apart weighs against one
                              ///< that joins them; networks cut objects up more often than they
                              ///< join them
  int recent_sightings = 64;  ///< of each super-point that count while frames come; all at the end
};
void list_fields(ConsensusConfig& config, ConfigFields& fields);

/// An object that frames may have changed.
struct RegroupedObject {
  std::vector<Label> roots;  ///< ascending: those of it that were in sight or came from elsewhere
  Label resting = 0;  ///< one of its others, who were one object before as well; 0: there are none
  bool operator==(const RegroupedObject&) const = default;
};

/// Which super-points are one object, by what the 2D entities of all frames say together.
///
/// A frame joins two super-points when one entity shows both, and keeps them apart when different
/// entities do. Objects are the clusters of greedy additive edge contraction over joined -
/// apart_weight * apart. Unlike votes that are cast frame by frame, the result does not depend on
/// the order of the frames, and a mask that once spans two objects does no lasting harm.
///
/// That is what settle() finds. While frames come, update() asks of the super-points in sight
/// alone: a chain of single mistakes soon links everything that was ever seen, and what a frame
/// costs must not grow with it. The others of an object rest: they stay together, and with those in
/// sight unless these are kept apart from them more often than joined with them.
///
/// Kept are sightings, by super-point and by frame, not pairs: their number grows with what is
/// seen, that of pairs with its square.
class EntityConsensus {
 public:
  explicit EntityConsensus(const ConsensusConfig& config = {}) : config_(config) {}

  /// Adds one frame: the entity of each root seen in one, and how its masks are rated
  /// (Segments::ratings).
  void observe(const std::map<Label, std::uint16_t>& entity_of_root,
               std::span<const float> ratings = {});

  /// Finds the objects of super-points that frames showed since this was asked last. Returns those
  /// that these are in now, or were in; all others are what they were.
  std::vector<RegroupedObject> update();

  /// The same of all super-points, by all sightings: the oldest (lowest) root of each one's object.
  std::map<Label, Label> settle();
  /// Of all super-points by a judge that looks at their surfaces as well (contract_by_judge).
  std::map<Label, Label> settle(const SuperPointShapes& shapes, bool masked);

  const EntitySightings& sightings() const { return sightings_.ordered(); }
  /// The roots of the object that a root is in, ascending.
  const std::set<Label>& object_with(Label root) const { return members_.at(object_of_.at(root)); }
  std::uint32_t frames() const { return frames_; }
  /// Goes on where another stopped. `frames`: how many were observed; more than the sightings tell
  /// when the last showed nothing. `objects`: any root of each root's object; those that are
  /// missing are objects of their own.
  void restore(EntitySightings sightings, std::uint32_t frames,
               const std::map<Label, Label>& objects);

 private:
  using Object = std::uint32_t;  // a number that no other object ever had
  struct Shown {
    Label root;
    EntitySighting sighting;
  };
  struct Graph;

  std::vector<Label> take_all();
  std::map<Label, Label> regrouped(std::map<Label, Label> object_of);
  void add_sighting(Label root, const EntitySighting& sighting);
  Graph graph_of(const std::set<Label>& shown) const;
  std::vector<Presences> presences_in(const Graph& graph) const;
  void see_resting(const Graph& graph, std::uint32_t frame,
                   std::vector<Presences>& presences) const;
  RegroupedObject regroup(const Graph& graph, std::span<const Node> cluster);
  void move(Label root, Object object);

  ConsensusConfig config_;
  IndexedMap<std::vector<EntitySighting>> sightings_;
  std::vector<std::vector<Shown>> shown_in_;  ///< the same by frame
  std::set<Label> shown_;                     ///< since update()
  tsl::robin_map<Label, Object> object_of_;
  tsl::robin_map<Object, std::set<Label>> members_;
  Object last_object_ = 0;
  std::uint32_t frames_ = 0;
};

}  // namespace ovimap
