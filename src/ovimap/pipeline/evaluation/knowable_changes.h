// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "ovimap/io/truth/truth.h"
#include "ovimap/io/truth/truth_changes.h"
#include "ovimap/pipeline/evaluation/change_evaluation.h"

namespace ovimap {

/// Vertices of some instances of a truth, or of all others.
std::vector<Eigen::Vector3f> points_of(const Truth& truth, const std::set<std::int32_t>& objects,
                                       bool others = false);

/// What the visits to a place that changes could know of its changes, and when. What nobody looks
/// at in the visit before which it changed is news in a later one, while it stays so.
class KnowableChanges {
 public:
  /// Reads each visit's frames once. `visits`: the truths of truth.visits. All must outlive it.
  KnowableChanges(const TrueChanges& truth, const std::vector<Truth>& visits,
                  const ChangeScoresConfig& config);

  /// Up to which visit, from 1, the thing stays as the change left it.
  int until(const TrueChange& change) const;

  struct Known {
    TrueChange change;
    bool knowable;  ///< enough of it was seen
  };
  /// The change as visits can know it: a move that no single visit can know ends and begins as if
  /// something was removed and something added.
  std::vector<Known> as_known(const TrueChange& change) const;

 private:
  /// A thing where it stands in one visit, and another one, that looks there.
  using Place = std::tuple<std::int32_t, int, int>;

  void look(const FrameSource& source, int looks);
  bool shows(int visit, std::int32_t object) const;
  int begin_of(const TrueChange& change) const;
  int left_known(const TrueChange& change) const;
  int came_known(const TrueChange& change) const;

  const TrueChanges& truth_;
  const std::vector<Truth>& visits_;
  const ChangeScoresConfig& config_;
  std::vector<std::map<std::int32_t, int>> frames_;  ///< by visit and object: those that show it
  std::set<Place> in_sight_;
};

}  // namespace ovimap
