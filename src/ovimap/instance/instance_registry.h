// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <span>
#include <vector>

#include "ovimap/instance/association.h"
#include "ovimap/instance/consensus/entity_consensus.h"
#include "ovimap/instance/consensus/indexed_map.h"
#include "ovimap/instance/frame_runs.h"
#include "ovimap/instance/super_point_merging.h"

namespace ovimap {

using InstanceId = std::uint32_t;  ///< 0 = none

enum class InstanceReading {
  kSuperPoints,  ///< an instance is a super-point (the paper's text)
  kEntityVotes,  ///< super-points vote for instances keyed by 2D entities (released code, printed
                 ///< numbers)
  kConsensus,    ///< super-points that 2D entities join more often than they keep them apart; in a
                 ///< frame without masks every segment is one
};

struct InstanceConfig {
  InstanceReading instances = InstanceReading::kConsensus;
  float min_vote_share =
      0.1f;  ///< votes needed per frame in which the super-point was seen without voting so
  bool judged = true;  ///< kConsensus: settle() asks a judge that was trained on rendered rooms,
                       ///< who looks at surfaces as well as at masks
  ConsensusConfig consensus;
  MergeConfig merging;
};
void list_fields(InstanceConfig& config, ConfigFields& fields);

/// What is known of a super-point.
struct SuperPoint {
  int frames_seen = 0;              ///< frames with 2D entities in which it was seen
  std::map<InstanceId, int> votes;  ///< kConsensus: one, for an id of its own, counts the frames in
                                    ///< which it was in an entity
  FrameRuns seen;                   ///< every frame that showed it, as counted by the registry
  std::int64_t first_frame = 0;     ///< of these, as Frame::index
  std::int64_t last_frame = 0;
};

/// What is known of an instance besides its geometry.
struct InstanceRecord {
  int views = 0;  ///< frames in which it was seen
  std::int64_t first_frame = 0;
  std::int64_t last_frame = 0;
};

/// The record of an instance that consists of these super-points (roots); those that are not known
/// add nothing.
InstanceRecord record_of(const std::map<Label, SuperPoint>& known,
                         std::span<const Label> super_points);

/// Which super-points are which object, over time (method sections 6 and 7). Ids, once given, stay:
/// when two instances turn out to be one, the older id survives and the other becomes its alias.
///
/// By consensus a union may be taken back by later frames, and super-points are never merged. So
/// nothing is gathered by instance: what is known is known of super-points, and an instance's
/// record is put together from those that it has now.
class InstanceRegistry {
 public:
  explicit InstanceRegistry(const InstanceConfig& config = {})
      : config_(config), merging_(config.merging), consensus_(config.consensus) {}

  /// Adds one frame: counts entity votes, updates instances; other readings than kConsensus merge
  /// super-points in `forest`. `has_entities`: the frame had 2D masks (else every segment, or, by
  /// kEntityVotes, every super-point is an entity of its own).
  void observe(const Segments& segments, std::span<const SegmentAssociation> associations,
               std::int64_t frame_index, bool has_entities, LabelForest& forest);

  /// After the last frame: finds the objects anew from all that was seen. observe() does so among
  /// those in sight.
  void settle();
  /// The same by what the map's surface tells as well; for consensus alone. `masked`: entities are
  /// masks, not regions of depth.
  void settle(const SuperPointShapes& shapes, bool masked);

  /// The instance of a super-point root; 0 when it is none (background, too little evidence).
  InstanceId instance_of(Label root) const;

  /// Instance by label, index 0 .. forest.last_label(): for translating images and meshes in one
  /// pass.
  std::vector<InstanceId> instance_table(const LabelForest& forest) const;

  /// The id that an id once given goes by now.
  InstanceId resolve(InstanceId id) const;

  /// The roots of which an instance consists now, ascending; none when it is none.
  const std::vector<Label>& super_points_of(InstanceId id) const;
  InstanceRecord record(InstanceId id) const {
    return record_of(super_points(), super_points_of(id));
  }
  /// Whether at least so many frames showed it, record(id).views; mostly the first super-point that
  /// is asked tells.
  bool seen_in(InstanceId id, int frames) const;

  const std::map<Label, SuperPoint>& super_points() const { return super_points_.ordered(); }
  /// Super-points by the instance they are now.
  const std::map<InstanceId, std::vector<Label>>& instances() const { return members_.ordered(); }
  const std::map<InstanceId, InstanceId>& aliases() const { return aliases_.ordered(); }
  /// In which 2D entities each root was seen; nothing by other readings than kConsensus.
  const EntitySightings& entity_sightings() const { return consensus_.sightings(); }
  const SuperPointMerging& merging() const { return merging_; }
  const InstanceConfig& config() const { return config_; }

  /// Everything needed to go on where another registry stopped.
  struct State {
    std::map<Label, SuperPoint> super_points;
    std::map<InstanceId, InstanceId> aliases;
    SuperPointMerging::PairCounts pair_counts;
    EntitySightings entity_sightings;
    int entity_frames = 0;  ///< frames with entities; older maps do not tell
    int frames = 0;         ///< all that were observed
    InstanceId last_id = 0;
  };
  State state() const {
    return {super_points(),
            aliases(),
            merging_.counts(),
            consensus_.sightings(),
            static_cast<int>(consensus_.frames()),
            static_cast<int>(frames_),
            last_id_};
  }
  void restore(State state);

 private:
  void vote(const Segments& segments, std::span<const SegmentAssociation> associations,
            const LabelForest& forest);
  void see_entities(const Segments& segments, std::span<const SegmentAssociation> associations,
                    const LabelForest& forest, bool has_entities);
  void group(std::vector<RegroupedObject> objects);
  InstanceId own_id(Label root) const;
  void merge_super_points(std::span<const SegmentAssociation> associations, LabelForest& forest);
  void absorb(Label keep, Label drop);
  bool supported(const SuperPoint& point, int votes) const;
  InstanceId best_free_instance(const SuperPoint& point, const std::set<InstanceId>& used);
  void see_super_points(std::span<const SegmentAssociation> associations,
                        const LabelForest& forest);
  void merge(Label keep, Label drop);
  void unify(InstanceId a, InstanceId b);
  bool owns_super_point(InstanceId id) const;
  void count_sightings(std::span<const SegmentAssociation> associations, std::int64_t frame_index,
                       const LabelForest& forest);
  void regroup(Label root);
  void leave(Label root);

  InstanceConfig config_;
  SuperPointMerging merging_;
  EntityConsensus consensus_;
  IndexedMap<SuperPoint> super_points_;  ///< by root
  IndexedMap<InstanceId> aliases_;
  IndexedMap<std::vector<Label>> members_;
  tsl::robin_map<Label, InstanceId> member_of_;  ///< the inverse of members_
  std::uint32_t frames_ = 0;
  InstanceId last_id_ = 0;
};

}  // namespace ovimap
