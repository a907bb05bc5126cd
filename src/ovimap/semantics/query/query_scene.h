// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ovimap/geometry/pose.h"
#include "ovimap/semantics/query/query_config.h"
#include "ovimap/semantics/query/query_grammar.h"
#include "ovimap/semantics/query/query_matcher.h"
#include "ovimap/semantics/query/room_kinds.h"
#include "ovimap/semantics/relations/object_shapes.h"

namespace ovimap {

struct QueryParts;

/// The geometry that relations are judged by.
struct QueryScene {
  ObjectShapes shapes;                            ///< of each object of the index, by position
  GroundViewpoint viewpoint;                      ///< for left, right, in front and behind
  std::shared_ptr<const ObjectColors> colors;     ///< of each object; null: not known
  std::vector<std::vector<WrittenLine>> writing;  ///< on each object; empty: none was read
  std::shared_ptr<const ObjectRooms> rooms;       ///< where each object is; null: not known
  SeenThings things;                              ///< of each object; no words: nothing looked
  TaughtThings taught;                            ///< in other maps
  std::shared_ptr<const QueryParts> parts;        ///< of the objects; null: none are known

  /// Positions in parts->index of what is of the object at a position, by number.
  std::vector<std::size_t> parts_of(std::size_t position) const;
};

/// Parts of objects, searched as objects are.
struct QueryParts {
  SearchIndex index;                ///< by ObjectPart::id
  QueryScene scene;                 ///< their boxes
  std::vector<std::size_t> owners;  ///< position of the object that each is of, side by side
  std::vector<int> numbers;         ///< among the parts of its object, from 1
};

/// A scene of the objects' boxes, exact where an axis of the world is up.
QueryScene scene_of_boxes(const SearchIndex& index, const Eigen::Vector3f& up_in_world);

/// The mean of the cameras: where a recording looks from on the whole. At least one pose.
GroundViewpoint mean_viewpoint(const Eigen::Matrix3f& ground_from_world,
                               std::span<const Pose> world_from_camera);

/// How well the objects fit a query with relations.
struct PhraseMatch {
  Eigen::VectorXf scores;             ///< [objects] chance in [0, 1] that the whole phrase fits
  std::vector<bool> holds;            ///< whether it is the thing and its relations are true
  std::vector<std::string> evidence;  ///< why; empty where the score is 0
  std::vector<std::string> missing;   ///< things named that are not in the map
  MatchScores things;                 ///< what the text alone says; no rows for "anything"
  bool of_parts = false;              ///< rows are parts (QueryScene::parts) instead of objects

  float& score(std::size_t row) { return scores[static_cast<Eigen::Index>(row)]; }
  float score(std::size_t row) const { return scores[static_cast<Eigen::Index>(row)]; }
  /// The rows that may fit at all.
  std::vector<std::size_t> possible() const;
};

/// Judges phrases in a scene. Scores combine as chances: a thing and its anchor and the relation
/// between them must hold, and "the nearest" or "the largest" is one that no better one beats. The
/// references must outlive it. Thread-safe.
class PhraseSearch {
 public:
  /// `matcher` may be null: then only "anything" can be asked for. `among`: [objects] which may be
  /// the thing that is looked for; empty: all. `part_matcher`: of scene.parts; null: likewise.
  PhraseSearch(const SearchIndex& index, const TextMatcher* matcher, const QueryScene& scene,
               const QueryConfig& config, std::vector<bool> among = {},
               const TextMatcher* part_matcher = nullptr);

  /// `negatives`: what the things looked for must not be. Throws Error when a text needs a matcher.
  PhraseMatch match(const QueryPhrase& phrase, const std::vector<std::string>& negatives) const;

 private:
  /// What is looked for must be found; an anchor may be what resembles it.
  enum class Role { kThing, kAnchor };

  PhraseMatch match_phrase(const QueryPhrase& phrase, const std::vector<std::string>& negatives,
                           Role role) const;
  /// [parts] "drawer of the cabinet".
  PhraseMatch match_parts(const QueryPhrase& phrase,
                          const std::vector<std::string>& negatives) const;
  /// Where no part was seen well enough to look like anything.
  static PhraseMatch none_of(const QueryParts& parts, const QueryPhrase& part);
  /// The objects of which some part fits.
  PhraseMatch owners_of(const PhraseMatch& parts) const;
  PhraseMatch match_things(const QueryPhrase& phrase, const std::vector<std::string>& negatives,
                           Role role) const;
  /// Lowers what has not the colour, the size or the writing that was asked for.
  void apply_attributes(const QueryPhrase& phrase, PhraseMatch& result) const;
  bool may_be(std::size_t position, Role role) const {
    return role == Role::kAnchor || among_.empty() || among_[position];
  }
  /// Takes away whatever one of the negatives is found to be.
  void leave_out(const std::vector<std::string>& negatives, PhraseMatch& result) const;
  const TextMatcher& needed_matcher(const std::string& what) const;
  void require_writing(const std::string& wanted) const;
  void rate_by_text(const QueryPhrase& phrase, Role role, PhraseMatch& result) const;
  /// Whether the anchor is a room ("in the kitchen"); then its objects are rated.
  bool apply_room(const QueryPhrase& phrase, PhraseMatch& result) const;
  struct PairRating {
    float score = 0;  ///< of the best pair, by its anchor's score
    bool holds = false;
    std::string evidence;
  };
  struct BoxedAnchor {
    std::size_t position = 0;
    Eigen::AlignedBox3f box;
  };
  /// The object at a position beside the anchors `near`, the better of equals first.
  PairRating rate_pairs(const QueryPhrase& phrase, std::size_t object,
                        std::span<const BoxedAnchor> near, const PhraseMatch& anchors) const;
  void apply_pairs(const QueryPhrase& phrase, const PhraseMatch& anchors,
                   PhraseMatch& result) const;
  void apply_order(const QueryPhrase& phrase, const PhraseMatch& anchors,
                   PhraseMatch& result) const;
  void apply_between(const PhraseMatch& first, const PhraseMatch& second, bool same_kind,
                     PhraseMatch& result) const;
  void apply_superlative(Superlative superlative, PhraseMatch& result) const;
  std::vector<std::size_t> anchors_of(const PhraseMatch& match) const;
  InstanceId id_of(std::size_t position) const { return index_.object(position).id; }

  const SearchIndex& index_;
  const TextMatcher* matcher_;
  const QueryScene& scene_;
  const QueryConfig& config_;
  const std::vector<bool> among_;
  const TextMatcher* part_matcher_;
};

}  // namespace ovimap
