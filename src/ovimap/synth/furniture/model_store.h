// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/procedural/made_model.h"
#include "ovimap/synth/shapes/height_map.h"
#include "ovimap/synth/shapes/random.h"
#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

/// A piece ready to be placed, in its own frame.
struct RoomModel {
  std::string name;    ///< "Coffee mug"
  std::string source;  ///< who made it and its licence; empty for our own
  TexturedMesh mesh;
  Eigen::Vector3f size_m = Eigen::Vector3f::Zero();
  HeightMap upper_side{TexturedMesh{}};
  bool soft = false;  ///< sinks into uneven ground
  bool made = false;  ///< by rule and complete: no view is set behind a window
  std::vector<Deck> decks = {};
  bool stackable = false;       ///< things may lie on it
  float glow = 0;               ///< see MadeModel
  std::string class_name = {};  ///< of a made one
};

/// Picks and loads the models of a room, each once.
class ModelStore {
 public:
  explicit ModelStore(std::filesystem::path furniture_folder, Split split = Split::kTuned)
      : folder_(std::move(furniture_folder)), split_(split) {}

  /// The model of that catalogue id, a new thing for made_id of a kind, or one of the class drawn
  /// by `random` when `id` is empty; pictures, rugs, pillows and blankets are made up, to fit a
  /// room of `room_size_m`. Throws Error when the furniture package is missing, or the class or the
  /// id is unknown.
  std::shared_ptr<const RoomModel> get(const std::string& class_name, const std::string& id,
                                       const Eigen::Vector3f& room_size_m, Random& random);

 private:
  std::shared_ptr<const RoomModel> load(const std::string& id);

  std::filesystem::path folder_;
  Split split_;
  std::optional<FurnitureCatalog> catalog_;  ///< opened when first needed
  std::map<std::string, std::shared_ptr<const RoomModel>> loaded_;
};

}  // namespace ovimap
