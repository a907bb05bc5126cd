// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

class ConfigFields;

struct ChangeScoresConfig {
  float near_m = 0.02f;     ///< surface of the map this near to a point is there
  float apart_m = 0.05f;    ///< points of things that left count where nothing stands this near now
  int frames = 5;           ///< and where so many frames looked through
  float through_m = 0.05f;  ///< by this much
  float mover_cell_m = 0.02f;  ///< of what moves one point in each such cube counts, in every frame
  int seen_frames = 5;         ///< things count as changed that so many frames show, in each visit
  int seen_px = 100;           ///< in which they are, by at least so many pixels
  float seen_share = 0.5f;     ///< and where so much of the place that they left, or came to, is in
                               ///< sight of so many frames of the other visit
  float same_place = 0.25f;    ///< intersection over union of boxes that are of one thing
};
void list_fields(ChangeScoresConfig& config, ConfigFields& fields);

/// Changes of one kind. What is told in doubt (ObjectEvent::may_be, and what is gone of which
/// another may be it) counts as told only where it is right.
struct ChangeCounts {
  std::size_t real = 0, told = 0, right = 0;
  double precision() const { return told == 0 ? 1. : double(right) / double(told); }
  double recall() const { return real == 0 ? 1. : double(right) / double(real); }
};

/// What a map says of a place that changed.
struct ChangeScores {
  std::size_t left_points = 0;      ///< of things where they were, that frames looked through since
  std::size_t ghost_points = 0;     ///< of those, where the map still has surface
  std::size_t static_points = 0;    ///< of what never changed and was seen in the last visit
  std::size_t kept_points = 0;      ///< of those, where the map has surface
  std::size_t mover_points = 0;     ///< of what moved while it was seen, where nothing else is
  std::size_t mover_left = 0;       ///< of those, where the map has surface
  std::size_t knowable_points = 0;  ///< of mover_points, those that `frames` others looked through
  ChangeCounts moved, removed, added;
  std::size_t ids_kept = 0;  ///< of moved.real: things whose move is told under the id they had
  std::size_t in_doubt = 0;  ///< of the others: told as gone and as new, which may be what is gone

  double ghost() const {
    return left_points == 0 ? 0. : double(ghost_points) / double(left_points);
  }
  double mover_share() const {
    return mover_points == 0 ? 0. : double(mover_left) / double(mover_points);
  }
  double kept() const {
    return static_points == 0 ? 1. : double(kept_points) / double(static_points);
  }
};

/// Scores a map that was continued through all visits of `folder` (load_true_changes). Things that
/// the visits saw too little of (seen_frames, seen_px), and those whose places nobody looked at
/// (seen_share), are no changes that a map could tell; they count where it told them all the same.
/// What moved out of sight was removed, as far as can be known, and what moved into sight was
/// added. A change may be told in any visit while the thing stays as it left it: where nobody
/// looked in the first of them it is news in a later one. Throws Error where the map was not made
/// from that many visits, and what the parts throw.
ChangeScores score_changes(const MapDocument& map, const std::filesystem::path& folder,
                           const ChangeScoresConfig& config = {});

}  // namespace ovimap
