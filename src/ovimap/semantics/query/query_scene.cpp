// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_scene.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/semantics/query/attribute_rating.h"
#include "ovimap/semantics/query/query_text.h"

namespace ovimap {

namespace {

float at(const Eigen::VectorXf& values, std::size_t i) {
  return values[static_cast<Eigen::Index>(i)];
}

void add_missing(PhraseMatch& result, const PhraseMatch& anchors) {
  result.missing.insert(result.missing.end(), anchors.missing.begin(), anchors.missing.end());
}

}  // namespace

std::vector<std::size_t> PhraseMatch::possible() const {
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < static_cast<std::size_t>(scores.size()); ++i)
    if (score(i) > 0.f) positions.push_back(i);
  return positions;
}

std::vector<std::size_t> QueryScene::parts_of(std::size_t position) const {
  if (!parts) return {};
  const auto first = std::find(parts->owners.begin(), parts->owners.end(), position);
  std::vector<std::size_t> of_it;
  for (auto at = first; at != parts->owners.end() && *at == position; ++at)
    of_it.push_back(static_cast<std::size_t>(at - parts->owners.begin()));
  return of_it;
}

QueryScene scene_of_boxes(const SearchIndex& index, const Eigen::Vector3f& up_in_world) {
  const Eigen::Matrix3f ground = ground_from_world(up_in_world);
  std::vector<ObjectShape> shapes;
  for (const SearchObject& object : index.objects())
    shapes.push_back(shape_of_box(ground, object.box, object.centroid));
  QueryScene scene;
  scene.shapes = ObjectShapes(std::move(shapes));
  return scene;
}

GroundViewpoint mean_viewpoint(const Eigen::Matrix3f& ground_from_world,
                               std::span<const Pose> world_from_camera) {
  OVIMAP_ASSERT(!world_from_camera.empty());
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), forward = Eigen::Vector3d::Zero();
  for (const Pose& pose : world_from_camera) {
    position += pose.translation();
    forward += pose.linear().col(2);
  }
  position /= static_cast<double>(world_from_camera.size());
  const Eigen::Vector2f ahead = (ground_from_world * forward.cast<float>()).head<2>();
  GroundViewpoint viewpoint;
  viewpoint.position = (ground_from_world * position.cast<float>()).head<2>();
  if (!ahead.isZero()) viewpoint.forward = ahead.normalized();
  return viewpoint;
}

PhraseSearch::PhraseSearch(const SearchIndex& index, const TextMatcher* matcher,
                           const QueryScene& scene, const QueryConfig& config,
                           std::vector<bool> among, const TextMatcher* part_matcher)
    : index_(index),
      matcher_(matcher),
      scene_(scene),
      config_(config),
      among_(std::move(among)),
      part_matcher_(part_matcher) {
  OVIMAP_ASSERT(scene.shapes.size() == index.size());
  OVIMAP_ASSERT(among_.empty() || among_.size() == index.size());
}

PhraseMatch PhraseSearch::match(const QueryPhrase& phrase,
                                const std::vector<std::string>& negatives) const {
  if (phrase.relation == Relation::kPartOf && scene_.parts) return match_parts(phrase, negatives);
  // What only resembles the thing may be listed, but proves nothing.
  return match_phrase(phrase, negatives, Role::kThing);
}

PhraseMatch PhraseSearch::match_phrase(const QueryPhrase& phrase,
                                       const std::vector<std::string>& negatives, Role role) const {
  if (phrase.relation == Relation::kPartOf && scene_.parts)
    return owners_of(match_parts(phrase, negatives));
  PhraseMatch result = match_things(phrase, negatives, role);
  apply_attributes(phrase, result);
  if (phrase.relation && !apply_room(phrase, result)) {
    // Which of several tables it is on need not be the one that looks most like a table.
    const PhraseMatch anchors = match_phrase(phrase.anchors[0], {}, Role::kAnchor);
    if (!phrase.negated) add_missing(result, anchors);
    if (*phrase.relation == Relation::kBetween) {
      const bool two = phrase.anchors.size() > 1;
      const PhraseMatch second = two ? match_phrase(phrase.anchors[1], {}, Role::kAnchor) : anchors;
      if (two) add_missing(result, second);
      apply_between(anchors, second, !two, result);
    } else if (*phrase.relation == Relation::kNearest || *phrase.relation == Relation::kFarthest) {
      apply_order(phrase, anchors, result);
    } else {
      apply_pairs(phrase, anchors, result);
    }
  }
  if (phrase.superlative) apply_superlative(*phrase.superlative, result);
  return result;
}

PhraseMatch PhraseSearch::none_of(const QueryParts& parts, const QueryPhrase& part) {
  PhraseMatch result;
  result.scores = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(parts.index.size()));
  result.holds.assign(parts.index.size(), false);
  result.evidence.resize(parts.index.size());
  result.missing = {part.things};
  return result;
}

PhraseMatch PhraseSearch::match_parts(const QueryPhrase& phrase,
                                      const std::vector<std::string>& negatives) const {
  const PhraseMatch anchors = match_phrase(phrase.anchors[0], {}, Role::kAnchor);
  const QueryParts& parts = *scene_.parts;
  std::vector<bool> of_anchor(parts.index.size());
  for (std::size_t p = 0; p < parts.index.size(); ++p)
    of_anchor[p] = anchors.score(parts.owners[p]) > 0.f && may_be(parts.owners[p], Role::kThing);
  QueryPhrase part = phrase;
  part.relation.reset();
  part.anchors.clear();
  const PhraseSearch search(parts.index, part_matcher_, parts.scene, config_, of_anchor);
  const bool looks_known = part_matcher_ || !matcher_ || part.anything;
  PhraseMatch result = looks_known ? search.match(part, negatives) : none_of(parts, part);
  result.of_parts = true;
  add_missing(result, anchors);
  for (const std::size_t p : result.possible()) {
    const std::size_t owner = parts.owners[p];
    result.score(p) *= anchors.score(owner);
    result.holds[p] = result.holds[p] && anchors.holds[owner];
    add_evidence(result.evidence[p],
                 with_anchor(concat("part ", parts.numbers[p], " of #", id_of(owner)),
                             anchors.evidence[owner]));
  }
  return result;
}

PhraseMatch PhraseSearch::owners_of(const PhraseMatch& parts) const {
  PhraseMatch result;
  result.scores = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(index_.size()));
  result.holds.assign(index_.size(), false);
  result.evidence.resize(index_.size());
  result.missing = parts.missing;
  for (const std::size_t p : parts.possible()) {
    const std::size_t owner = scene_.parts->owners[p];
    if (parts.holds[p]) result.holds[owner] = true;
    if (parts.score(p) <= result.score(owner)) continue;
    result.score(owner) = parts.score(p);
    result.evidence[owner] = parts.evidence[p];
  }
  return result;
}

PhraseMatch PhraseSearch::match_things(const QueryPhrase& phrase,
                                       const std::vector<std::string>& negatives, Role role) const {
  PhraseMatch result;
  result.scores = Eigen::VectorXf::Ones(static_cast<Eigen::Index>(index_.size()));
  result.holds.assign(index_.size(), true);
  result.evidence.resize(index_.size());
  const std::vector<std::string> terms = split_terms(phrase.things);
  if (phrase.anything) {
    for (std::size_t i = 0; i < index_.size(); ++i)
      if (!may_be(i, role)) result.score(i) = 0.f, result.holds[i] = false;
    if (!negatives.empty()) leave_out(negatives, result);
    return result;
  }
  if (terms.empty())
    throw Error(concat("the query names nothing in '", phrase.things, "'; say what to look for"));
  result.things = needed_matcher(phrase.things).match(terms, negatives);
  for (std::size_t i = 0; i < index_.size(); ++i)
    if (!may_be(i, role)) result.things.excluded[i] = true;
  rate_by_text(phrase, role, result);
  return result;
}

void PhraseSearch::apply_attributes(const QueryPhrase& phrase, PhraseMatch& result) const {
  const bool colored = phrase.color && scene_.colors;
  const std::vector<std::u32string> written = written_words(phrase.writing);
  if (!phrase.writing.empty()) require_writing(phrase.writing);
  for (const std::size_t i : result.possible()) {
    AttributeRating rating;
    if (colored) rate_color(scene_.colors->surfaces()[i], *phrase.color, rating);
    if (phrase.size) rate_size(scene_.shapes.measures()[i], *phrase.size, rating);
    if (!phrase.writing.empty()) rate_writing(written, scene_.writing[i], rating);
    result.score(i) *= rating.score;
    result.holds[i] = result.holds[i] && rating.score >= kRelationHolds;
    if (!rating.evidence.empty()) add_evidence(result.evidence[i], rating.evidence);
  }
}

void PhraseSearch::require_writing(const std::string& wanted) const {
  if (written_words(wanted).empty())
    throw Error(concat("text:\"", wanted, "\" has no letter or number to look for"));
  if (scene_.writing.empty())
    throw Error(concat("what is written in this map was not read, so text:\"", wanted,
                       "\" cannot be looked for; run `ovimap read` on it"));
}

void PhraseSearch::rate_by_text(const QueryPhrase& phrase, Role role, PhraseMatch& result) const {
  const MatchScores& text = result.things;
  result.scores.setZero();
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < index_.size(); ++i)
    if (index_.has_embedding(i) && !text.excluded[i] &&
        (!best || at(text.standard, i) > at(text.standard, *best)))
      best = i;
  if (!best || !matcher_->is_found(text, *best)) result.missing.push_back(phrase.things);
  result.holds.assign(index_.size(), false);
  if (!best) return;
  result.score(*best) = static_cast<float>(matcher_->probability(text, *best));  // a guess
  // A weak candidate can win a comparison of places; it cannot make a relation true.
  const bool compares = phrase.superlative || phrase.relation == Relation::kNearest ||
                        phrase.relation == Relation::kFarthest;
  const float possible = matcher_->score_at(text, double{config_.candidate_rate});
  float level = possible;
  if (compares) level = std::max(level, config_.rival_share * at(text.standard, *best));
  for (std::size_t i = 0; i < index_.size(); ++i) {
    const bool candidate = index_.has_embedding(i) && !text.excluded[i];
    if (!candidate) continue;
    const bool likely = at(text.standard, i) >= possible;
    result.holds[i] = role == Role::kAnchor ? likely : matcher_->is_found(text, i);
    if (at(text.standard, i) >= level)
      result.score(i) = static_cast<float>(matcher_->probability(text, i));
  }
}

void PhraseSearch::leave_out(const std::vector<std::string>& negatives, PhraseMatch& result) const {
  const MatchScores text = needed_matcher("--not " + negatives.front()).match(negatives, {});
  for (std::size_t i = 0; i < index_.size(); ++i) {
    if (!index_.has_embedding(i)) continue;
    if (!matcher_->is_found(text, i)) continue;
    result.score(i) = 0.f;
    result.holds[i] = false;
  }
}

const TextMatcher& PhraseSearch::needed_matcher(const std::string& what) const {
  if (matcher_) return *matcher_;
  throw Error(concat("'", what, "' needs an encoder, none was given; name one with --encoder"));
}

bool PhraseSearch::apply_room(const QueryPhrase& phrase, PhraseMatch& result) const {
  const QueryPhrase& anchor = phrase.anchors[0];
  if (*phrase.relation != Relation::kInside || !anchor.free_text() || !scene_.rooms) return false;
  const auto wanted = wanted_room(anchor.things);
  if (!wanted) return false;
  const std::vector<int>& room_of = scene_.rooms->of_objects();
  const std::vector<RoomFit> rooms =
      fit_rooms(room_of, index_.objects(), matcher_ ? matcher_->evidence() : nullptr);
  bool known = false;
  for (std::size_t r = 0; r < rooms.size(); ++r)
    known = known || chance_of(*wanted, static_cast<int>(r + 1), rooms[r]) >= kRelationHolds;
  if (!known && !phrase.negated) result.missing.push_back(anchor.things);
  for (const std::size_t i : result.possible()) {
    const int room = room_of[i];
    const RoomFit* fit = room == 0 ? nullptr : &rooms[static_cast<std::size_t>(room - 1)];
    const float chance = fit ? chance_of(*wanted, room, *fit) : 0.f;
    result.score(i) *= phrase.negated ? 1.f - chance : chance;
    result.holds[i] = result.holds[i] && (chance >= kRelationHolds) != phrase.negated;
    add_evidence(result.evidence[i],
                 fit ? "in " + describe_room(room, *fit, index_.objects()) : "in no room");
  }
  return true;
}

}  // namespace ovimap
