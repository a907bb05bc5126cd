// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/image/image.h"
#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/shapes/surface_patterns.h"
#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

class ConfigFields;

/// How models are shown one by one: each in the surroundings it is met in, from where people see
/// it, as sharp or blurred as a depth camera's colour image of a whole room would show it.
struct PortraitConfig {
  int views = 12;          ///< pictures of a model
  int views_per_room = 3;  ///< pictures before walls, floor and light change
  int patterns = 24;       ///< different floors, and as many different walls
  int least_side_px = 96;  ///< of the drawn image, which the object fills to a share
  int largest_side_px = 320;
  float field_of_view_rad = 0.9f;
  float least_share = 0.5f;  ///< of the field of view that the object takes, by its diagonal
  float largest_share = 1.f;
  float margin = 0.2f;         ///< kept around the object's box, of each of its sides
  float small_m = 0.5f;        ///< up to this size a thing stands on a table
  float largest_m = 4.5f;      ///< larger models belong to no room and are left out
  int least_visible_px = 400;  ///< fewer pixels are no view of the object
  int tries = 8;               ///< camera places tried for a view
};
void list_fields(PortraitConfig& config, ConfigFields& fields);

struct Portrait {
  RgbImage color;                ///< the object's box and a margin, with a camera's noise
  Image<std::uint16_t> visible;  ///< 255 where the object is seen, else 0
};

/// Draws furniture by itself. Thread-safe.
class PortraitStudio {
 public:
  explicit PortraitStudio(std::uint64_t seed, const PortraitConfig& config = {});

  /// Pictures of `model` (in its own frame, as load_furniture_model gives it), which is `entry`.
  /// The same studio and `number` give the same pictures; there are fewer than config.views where
  /// no camera place shows the object, none when it is too large for a room.
  std::vector<Portrait> draw(const FurnitureEntry& entry, const TexturedMesh& model,
                             std::uint64_t number) const;

 private:
  std::uint64_t seed_;
  PortraitConfig config_;
  std::vector<SurfacePattern> floors_, walls_;
};

}  // namespace ovimap
