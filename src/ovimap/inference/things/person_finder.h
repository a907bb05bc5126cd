// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "ovimap/inference/things/thing_detector.h"

namespace ovimap {

/// Somebody in a picture.
struct PersonBox {
  Eigen::AlignedBox2f in_image_px;  ///< within the picture; pixel centres at integers
  float score = 0;                  ///< in [0, 1]
};

/// Finds people by a detector that knows things called "person". Thread-safe.
class PersonFinder {
 public:
  /// Throws as ThingDetector, and Error when the model knows no person.
  PersonFinder(const ModelFolder& model, const RuntimeConfig& runtime);

  const std::string& name() const { return detector_.name(); }
  /// Boxes of at least that score, the surest first, each with all that overlap with it by more
  /// than half. Looks at the whole picture, and at the squares at both ends of one that is no
  /// square, where people are larger and as slim as they are. Throws Error when the network fails.
  std::vector<PersonBox> find(const RgbImage& picture, float min_score) const;

 private:
  /// Adds those of a part of the picture that begins at `corner`.
  void look(const RgbImage& part, const Eigen::Vector2i& corner, float min_score,
            std::vector<PersonBox>& people) const;

  ThingDetector detector_;
  Eigen::Index person_ = -1;  ///< its column of scores
};

/// By the detector of that name on the search path, or in that folder. Throws Error with the remedy
/// when it is not there.
std::unique_ptr<PersonFinder> make_person_finder(
    const std::string& detector, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs = {});

}  // namespace ovimap
