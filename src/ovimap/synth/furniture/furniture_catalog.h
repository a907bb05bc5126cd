// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

/// One model of the Sweet Home 3D furniture libraries.
struct FurnitureEntry {
  std::string id;        ///< "LIBRARY/MODEL": the archive's stem and the model's stem, "Scopia/cup"
  std::string name;      ///< "Coffee cup"
  std::string category;  ///< "Kitchen"
  std::string creator;
  std::string license;  ///< of its library
  std::filesystem::path archive;
  std::string model;                                             ///< the OBJ file in the archive
  Eigen::Vector3f size_m = Eigen::Vector3f::Zero();              ///< width, depth, height
  float elevation_m = 0;                                         ///< of its base above the floor
  bool door_or_window = false;                                   ///< stands in a wall
  Eigen::Matrix3f model_rotation = Eigen::Matrix3f::Identity();  ///< in the model's own axes, y up
};

/// Where Debian's package sweethome3d-furniture puts its libraries; where it is not installed, the
/// few models of the room "tiny" that a package of ovimap brings (tools/packages/furniture.py).
std::filesystem::path default_furniture_folder();

/// The models of all furniture libraries (*.sh3f) of a folder.
class FurnitureCatalog {
 public:
  /// Throws Error naming the Debian package to install when the folder is missing or holds no
  /// library, or naming the library whose catalogue cannot be read.
  explicit FurnitureCatalog(const std::filesystem::path& folder = default_furniture_folder());

  /// In the order of their ids.
  const std::vector<FurnitureEntry>& entries() const { return entries_; }

  /// Throws Error with the nearest known id when there is none of that id.
  const FurnitureEntry& find(const std::string& id) const;

 private:
  std::vector<FurnitureEntry> entries_;
};

/// The entries described by a PluginFurnitureCatalog.properties text (ISO 8859-1, other letters
/// escaped as Java does); entries without a model or a size are left out. Strings come back as
/// UTF-8.
std::vector<FurnitureEntry> parse_furniture_properties(const std::string& text,
                                                       const std::filesystem::path& archive);

}  // namespace ovimap
