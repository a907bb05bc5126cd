// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ovimap/frames/frame/frame.h"
#include "ovimap/image/blur.h"
#include "ovimap/semantics/views/appearance.h"
#include "ovimap/semantics/views/object_crop.h"

namespace ovimap {

class ConfigFields;

/// What counts of views whose picture is smeared or clipped.
struct TellingConfig {
  float sharp_edge_px = 2.f;  ///< as wide as edges are in a sharp picture, in pixels of the depth
                              ///< image; 0: every pixel counts, as published
  float least_share = 0.5f;   ///< of a view's pixels that must tell something; one that tells
                              ///< less is taken of objects alone that have none
};
void list_fields(TellingConfig& config, ConfigFields& fields);

/// Says of how many of a view's pixels an encoder learns something: where a picture is smeared over
/// three pixels, three of them say what one would, and what is burnt out or black says nothing.
/// Refers to the frame.
class TellingPixels {
 public:
  TellingPixels(const Frame& frame, const TellingConfig& config) : frame_(frame), config_(config) {}

  /// Of a view of `visible_px` pixels of the depth image whose crop, cut out of the frame, this is;
  /// at least 1. Crops with few edges are taken to be as smeared as the whole frame.
  int count(int visible_px, const ObjectCrop& crop);

  /// Lets a chosen view count by what it tells. False: so little that the object, unless this is
  /// its `first` view, should wait for a better one. A first view that tells so little covers no
  /// directions, so that a better one may follow from the same side.
  bool weigh(ObjectView& view, const ObjectCrop& crop, bool first);

 private:
  float samples_for_one(const EdgeWidth& crop, EdgeWidth Blur::*direction, float depth_per_color);

  const Frame& frame_;
  TellingConfig config_;
  std::optional<Blur> whole_;  ///< of the frame, measured for the first crop that needs it
};

/// Share of the object's pixels whose colour is at an end of what a picture can show, in all
/// channels.
float clipped_share(const ObjectCrop& crop);

}  // namespace ovimap
