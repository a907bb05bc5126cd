// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ovimap/geometry/mesh.h"
#include "ovimap/image/image.h"

namespace ovimap {

class ConfigFields;

enum class MeshColoring {
  kInstances,  ///< the palette's colour of Mesh::labels (grey where there are none)
  kColors,     ///< Mesh::colors (grey where there are none)
};

struct PictureConfig {
  MeshColoring coloring = MeshColoring::kInstances;
  int longest_side_px = 1400;  ///< of a view from above
  int supersampling = 2;       ///< rays per pixel along each side
  float ambient = 0.45f;       ///< light that reaches every surface; the rest comes from a lamp
  float drop_top = 0.15f;      ///< share of the height cut away from a view from above: the ceiling
  float trim = 0.002f;         ///< share of stray vertices, at each end, that do not widen the view
  bool cull_back_faces = true;  ///< looks through walls and ceilings from outside
  bool scale_bar = true;        ///< draws a bar of a round length, labelled in metres
};
void list_fields(PictureConfig& config, ConfigFields& fields);

/// The mesh from straight above, without perspective, walls along the picture's sides, on a light
/// ground. `up` is the world's (guess_up finds it). What is higher than `max_height_m` along `up`
/// is cut away; without it the top `drop_top` of the height. A mesh without triangles gives an
/// empty ground of longest_side_px squared.
RgbImage top_down(const Mesh& mesh, const Eigen::Vector3f& up, const PictureConfig& config = {},
                  std::optional<float> max_height_m = std::nullopt);

/// The same of a mesh in parts, coloured in several ways. config.coloring counts for nothing.
std::vector<RgbImage> top_down(const MeshParts& parts, const Eigen::Vector3f& up,
                               std::span<const MeshColoring> colorings,
                               const PictureConfig& config = {},
                               std::optional<float> max_height_m = std::nullopt);

/// A frame and the ids seen in it, of the same size.
struct SheetFrame {
  RgbImage color;
  IdImage ids;
};

struct SheetConfig {
  int columns = 4;
  int tile_width_px = 320;  ///< of one image; a frame shows two, plain and with its instances
  int gap_px = 6;
  float opacity = 0.55f;  ///< of the instance colours
};
void list_fields(SheetConfig& config, ConfigFields& fields);

/// The colour image with its instances laid over it and their boundaries drawn in their full
/// colour. Pixels with id 0 stay as they are.
RgbImage overlay(const RgbImage& color, const IdImage& ids, float opacity);

/// All frames in rows of `columns`, each as its plain image beside the overlay.
RgbImage contact_sheet(std::span<const SheetFrame> frames, const SheetConfig& config = {});

}  // namespace ovimap
