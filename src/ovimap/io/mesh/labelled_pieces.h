// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "ovimap/geometry/mesh.h"
#include "ovimap/image/scratch_file.h"

namespace ovimap {

/// The pieces of a mesh by label, as split_by_label cuts it, of a mesh that comes in parts: on disk
/// until they are asked for, so that no more than one part and one piece is in memory.
class LabelledPieces {
 public:
  /// `target`: the file or folder that they are written for; on its disk they wait. Throws what
  /// ScratchFile throws.
  LabelledPieces(const MeshParts& parts, const std::filesystem::path& target);

  /// Empty where nothing has that label. Vertices where parts meet occur twice.
  Mesh piece(std::uint32_t label) const;

 private:
  struct Place {
    std::uint64_t begin = 0, vertices = 0, normals = 0, colors = 0, labels = 0, triangles = 0;
  };
  Place keep(const Mesh& piece);
  Mesh read(Place place) const;

  ScratchFile file_;
  std::map<std::uint32_t, std::vector<Place>> places_;
};

}  // namespace ovimap
