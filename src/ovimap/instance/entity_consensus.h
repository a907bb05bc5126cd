// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "ovimap/map/voxels/label_forest.h"

namespace ovimap {

class ConfigFields;

struct ConsensusConfig {
  float apart_weight = 0.5f;  ///< what a frame that keeps two super-points apart weighs against one
                              ///< that joins them; networks cut objects up more often than they
                              ///< join them
};
void list_fields(ConsensusConfig& config, ConfigFields& fields);

/// A super-point was seen in a 2D entity.
struct EntitySighting {
  std::uint32_t frame = 0;   ///< counts frames with entities
  std::uint16_t entity = 0;  ///< not 0; means nothing beyond its frame
  auto operator<=>(const EntitySighting&) const = default;
};

using EntitySightings = std::map<Label, std::vector<EntitySighting>>;  ///< by root; frames ascend

/// Which super-points are one object, by what the 2D entities of all frames say together.
///
/// A frame joins two super-points when one entity shows both, and keeps them apart when different
/// entities do. Objects are the clusters of greedy additive edge contraction (Keuper et al., ICCV
/// 2015) over joined - apart_weight * apart: the pair most clearly one is contracted first, its
/// edges are added up, until no edge speaks for joining. Unlike votes that are cast frame by frame,
/// the result does not depend on the order of the frames, and a mask that once spans two objects
/// does no lasting harm.
///
/// Kept are sightings, not pairs: their number grows with what is seen, that of pairs with its
/// square.
class EntityConsensus {
 public:
  explicit EntityConsensus(const ConsensusConfig& config = {}) : config_(config) {}

  /// Adds one frame: the entity of each root seen in one.
  void observe(const std::map<Label, std::uint16_t>& entity_of_root);

  /// The oldest (lowest) root of each root's object. What a frame says changes the objects of those
  /// super-points alone that chains of entities link to what it shows: only they are looked at anew.
  const std::map<Label, Label>& objects();

  const EntitySightings& sightings() const { return sightings_; }
  std::uint32_t frames() const { return frames_; }
  /// `frames`: how many were observed; more than the sightings tell when the last showed nothing.
  void restore(EntitySightings sightings, std::uint32_t frames);

 private:
  using Part = std::uint32_t;  ///< super-points that chains of entities link

  void enter(Label root);
  void link(Label a, Label b);

  ConsensusConfig config_;
  EntitySightings sightings_;
  std::map<Label, Part> part_of_;
  std::map<Part, std::vector<Label>> parts_;
  Part last_part_ = 0;
  std::set<Part> changed_;          ///< those whose objects are to be found anew
  std::map<Label, Label> objects_;  ///< as of when they were last asked for
  std::uint32_t frames_ = 0;
};

}  // namespace ovimap
