// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "ovimap/instance/consensus/edge_contraction.h"
#include "ovimap/instance/consensus/super_point_shapes.h"

namespace ovimap {

class ConfigFields;

struct ConsensusConfig {
  float apart_weight = 0.5f;  ///< what a frame that keeps two super-points apart weighs against one
                              ///< that joins them; networks cut objects up more often than they
                              ///< join them
};
void list_fields(ConsensusConfig& config, ConfigFields& fields);

/// Which super-points are one object, by what the 2D entities of all frames say together.
///
/// A frame joins two super-points when one entity shows both, and keeps them apart when different
/// entities do. Objects are the clusters of greedy additive edge contraction over joined -
/// apart_weight * apart. Unlike votes that are cast frame by frame, the result does not depend on the
/// order of the frames, and a mask that once spans two objects does no lasting harm.
///
/// That is what settle() finds. While frames come, update() finds it among the objects in sight
/// alone, because a chain of single mistakes soon links everything that was ever seen.
///
/// Kept are sightings, not pairs: their number grows with what is seen, that of pairs with its
/// square.
class EntityConsensus {
 public:
  explicit EntityConsensus(const ConsensusConfig& config = {}) : config_(config) {}

  /// Adds one frame: the entity of each root seen in one, and how its masks are rated
  /// (Segments::ratings).
  void observe(const std::map<Label, std::uint16_t>& entity_of_root,
               std::span<const float> ratings = {});

  /// Contracts anew the super-points that frames showed since this was asked last, with all others of
  /// the objects that they were in. Returns the oldest (lowest) root of each one's object; all others
  /// are what they were.
  std::map<Label, Label> update();

  /// The same of all super-points.
  std::map<Label, Label> settle();
  /// Of all super-points by a judge that looks at their surfaces as well (contract_by_judge).
  std::map<Label, Label> settle(const SuperPointShapes& shapes);

  const EntitySightings& sightings() const { return sightings_; }
  std::uint32_t frames() const { return frames_; }
  /// Goes on where another stopped. `frames`: how many were observed; more than the sightings tell
  /// when the last showed nothing. `objects`: any root of each root's object; those that are missing
  /// are objects of their own.
  void restore(EntitySightings sightings, std::uint32_t frames,
               const std::map<Label, Label>& objects);

 private:
  std::vector<Label> take_all();
  std::map<Label, Label> regrouped(std::map<Label, Label> object_of);
  void regroup(const std::map<Label, Label>& object_of);

  ConsensusConfig config_;
  EntitySightings sightings_;
  std::set<Label> shown_;                       ///< since update()
  std::map<Label, Label> object_of_;            ///< some root of each root's object
  std::map<Label, std::vector<Label>> members_;  ///< of each object
  std::uint32_t frames_ = 0;
};

}  // namespace ovimap
