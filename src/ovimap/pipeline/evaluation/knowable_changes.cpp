// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/evaluation/knowable_changes.h"

#include <algorithm>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/pipeline/evaluation/looked_through.h"

namespace ovimap {

namespace {

/// By object, how many frames of a recording show it by at least so many pixels.
std::map<std::int32_t, int> frames_showing(const FrameSource& source, int least_px) {
  std::map<std::int32_t, int> frames;
  for (std::int64_t position = 0; position < source.size(); ++position) {
    const auto ids = source.truth_ids(position);
    if (!ids) continue;
    std::map<std::int32_t, int> pixels;
    for (const std::uint16_t id : *ids) ++pixels[id];
    for (const auto& [id, count] : pixels) frames[id] += count >= least_px;
  }
  return frames;
}

}  // namespace

Points points_of(const Truth& truth, const std::set<std::int32_t>& objects, bool others) {
  Points points;
  for (std::size_t i = 0; i < truth.mesh.vertices.size(); ++i)
    if (objects.contains(truth.instances[i]) != others) points.push_back(truth.mesh.vertices[i]);
  return points;
}

KnowableChanges::KnowableChanges(const TrueChanges& truth, const std::vector<Truth>& visits,
                                 const ChangeScoresConfig& config)
    : truth_(truth), visits_(visits), config_(config) {
  for (std::size_t visit = 0; visit < visits.size(); ++visit) {
    const auto source = open_frame_source(truth.visits[visit], {});
    frames_.push_back(frames_showing(*source, config.seen_px));
    look(*source, static_cast<int>(visit) + 1);
  }
}

/// Whether the visit has in sight where things will come to, and where they left.
void KnowableChanges::look(const FrameSource& source, int looks) {
  std::map<Place, Points> places;
  for (const TrueChange& change : truth_.changes) {
    const int stands = change.visit <= looks ? change.visit - 1 : change.visit;
    places[{change.object, stands, looks}] =
        points_of(visits_[static_cast<std::size_t>(stands - 1)], {change.object});
  }
  Points all;
  for (const auto& [place, points] : places) all.insert(all.end(), points.begin(), points.end());
  LookedThrough looked(all, -config_.through_m);
  looked.add(source);
  std::size_t first = 0;
  for (const auto& [place, points] : places) {
    const auto count = static_cast<float>(looked.count(config_.seen_frames, first, points.size()));
    if (!points.empty() && count >= config_.seen_share * static_cast<float>(points.size()))
      in_sight_.insert(place);
    first += points.size();
  }
}

bool KnowableChanges::shows(int visit, std::int32_t object) const {
  const auto& frames = frames_[static_cast<std::size_t>(visit - 1)];
  const auto seen = frames.find(object);
  return seen != frames.end() && seen->second >= config_.seen_frames;
}

int KnowableChanges::until(const TrueChange& change) const {
  int last = static_cast<int>(visits_.size());
  for (const TrueChange& next : truth_.changes)
    if (next.object == change.object && next.visit > change.visit)
      last = std::min(last, next.visit - 1);
  return last;
}

/// The visit since which the thing stood where the change found it.
int KnowableChanges::begin_of(const TrueChange& change) const {
  int first = 1;
  for (const TrueChange& other : truth_.changes)
    if (other.object == change.object && other.visit < change.visit)
      first = std::max(first, other.visit);
  return first;
}

/// The first visit that can know that the thing left; 0 for none.
int KnowableChanges::left_known(const TrueChange& change) const {
  bool known = false;
  for (int visit = begin_of(change); visit < change.visit; ++visit)
    known = known || shows(visit, change.object);
  for (int visit = change.visit; known && visit <= until(change); ++visit)
    if (in_sight_.contains({change.object, change.visit - 1, visit})) return visit;
  return 0;
}

/// The first visit that can know that the thing came; 0 for none.
int KnowableChanges::came_known(const TrueChange& change) const {
  bool looked = false;
  for (int visit = 1; visit < change.visit; ++visit)
    looked = looked || in_sight_.contains({change.object, change.visit, visit});
  for (int visit = change.visit; looked && visit <= until(change); ++visit)
    if (shows(visit, change.object)) return visit;
  return 0;
}

std::vector<KnowableChanges::Known> KnowableChanges::as_known(const TrueChange& change) const {
  const int left = change.from.isEmpty() ? 0 : left_known(change),
            came = change.to.isEmpty() ? 0 : came_known(change);
  if (change.kind != "moved") return {{change, left + came > 0}};
  if (left == came && left > 0) return {{change, true}};
  TrueChange removed = change, added = change;
  removed.kind = "removed", added.kind = "added";
  removed.to.setEmpty(), added.from.setEmpty();
  return {{removed, left > 0}, {added, came > 0}};
}

}  // namespace ovimap
