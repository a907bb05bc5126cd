// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "ovimap/geometry/mesh.h"
#include "ovimap/instance/object_parts.h"
#include "ovimap/io/exports/object_titles.h"

namespace ovimap {

/// What a file says of the objects of a map.
struct ExportedObjects {
  std::span<const InstanceSummary> instances;
  std::span<const ObjectPart> parts;  ///< of any of them
  const ObjectTitles& titles;
  Eigen::Vector3f up = Eigen::Vector3f::UnitZ();  ///< in the world
};

/// Writes a mesh with instance ids as labels as binary glTF 2.0: a root node "map" that turns the
/// world upright (glTF has y up), under it a node per instance, named "mug 12" or "object 12", with
/// `extras` {id, name, box, centroid, points, views, parts where some are known} in the world
/// frame, and a node "background" for what belongs to none. Vertices keep their world coordinates,
/// metres. A triangle goes to the object of most of its corners, else to that of its first. Colours
/// are those of the mesh, made linear as glTF wants them. Instances without surface have a node
/// without mesh. No more than one part and one object's mesh is in memory. The file appears only
/// when complete. Throws Error when it would pass the 4 GiB that the format allows, and where
/// write_file does.
void write_glb(const std::filesystem::path& path, const MeshParts& parts,
               const ExportedObjects& objects);

/// The same file in memory. Pieces of objects wait in the folder for temporary files.
std::string encode_glb(const MeshParts& parts, const ExportedObjects& objects);

}  // namespace ovimap
