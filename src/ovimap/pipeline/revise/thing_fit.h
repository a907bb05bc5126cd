// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/map/rays/observed_space.h"
#include "ovimap/pipeline/revise/thing_look.h"

namespace ovimap {

/// When points of two things laid over each other are of one thing.
struct ThingFitConfig {
  float near_voxels = 1.5f;  ///< nearer points lie on each other,
  float near_share = 0.08f;  ///< or such a share of the larger reach
  float same_color = 60.f;   ///< and are alike up to such a mean difference of their channels, of 255
  int views = 2;             ///< cameras that must have looked through a point that is not there
};

/// How well a thing that left one place and one that was found at another lie over each other.
struct ThingFit {
  float agreed = 0;        ///< share of either's points that lie on the other, the smaller of the two
  float contradicted = 1;  ///< of the points that both could see: those that do not
  /// In [0, 1]: 1 where nothing speaks against their being one thing.
  float fit() const { return agreed > 0.f ? agreed / (agreed + contradicted) : 0.f; }
};

/// Lays the one over the other, turned about the vertical and shifted until they fit best, and asks
/// of each point of either that lies on nothing of the other whether the other's map looked through
/// there: what neither saw, as a side that was turned away, speaks neither for nor against.
/// `before`, `after`: what the maps with the gone and the found thing saw.
ThingFit fit_things(const ThingLook& gone, const ObservedSpace& before, const ThingLook& found,
                    const ObservedSpace& after, float voxel_m, const ThingFitConfig& config = {});

}  // namespace ovimap
