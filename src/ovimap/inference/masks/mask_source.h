// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/frames/frame/frame.h"

namespace ovimap {

/// Where a promptable network should look for an entity, in pixels of the colour image.
struct MaskPrompt {
  Eigen::Vector2f interior_px;    ///< a point well inside the region
  Eigen::AlignedBox2f extent_px;  ///< the region's box
  int area_px = 0;                ///< the region's size
  bool known = false;             ///< seen by a finder: asked by its box, and first
};

/// 2D entities of one frame: class-agnostic masks that do not overlap.
struct Entities {
  IdImage ids;                ///< in the colour image, its size; 0 = no entity
  std::vector<float> scores;  ///< scores[id - 1] in [0, 1]; ids are 1..scores.size()
};

/// Finds the 2D entities of a frame: a network, a folder of PNGs, the truth or nothing (method
/// section 2).
class MaskSource {
 public:
  virtual ~MaskSource() = default;
  virtual std::string kind() const = 0;  ///< "sam", "entity", "dir", "gt"

  /// Takes seconds a frame (a network): worth asking on some frames only.
  virtual bool is_slow() const { return false; }

  /// The entities of `frame`. Two answers name none: Entities with empty `scores` say that nothing
  /// is to be seen, which counts against what the map holds there; nullopt says that the source has
  /// no masks of this frame (a folder without its file), which says nothing. `prompts` are hints
  /// that a source may ignore. Throws Error when the source cannot deliver for a reason the user
  /// can mend (mask file of another size, model failure).
  virtual std::optional<Entities> entities(const Frame& frame,
                                           std::span<const MaskPrompt> prompts) = 0;
};

}  // namespace ovimap
