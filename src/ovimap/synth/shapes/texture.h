// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"

namespace ovimap {

/// The index in a row of `size` that repeats in both directions.
inline int wrapped_index(int index, int size) {
  const int rest = index % size;
  return rest < 0 ? rest + size : rest;
}

/// Linear light of an 8-bit sRGB value (IEC 61966-2-1), 0..1, and back.
float linear_from_srgb(std::uint8_t value);
std::uint8_t srgb_from_linear(float value);
Eigen::Vector3f linear_from_srgb(Rgb8 color);
Rgb8 srgb_from_linear(const Eigen::Vector3f& color);

/// A repeating image with its halved copies, so that far surfaces are averaged and not aliased.
class Texture {
 public:
  explicit Texture(RgbImage image);

  int width() const { return levels_.front().width(); }
  int height() const { return levels_.front().height(); }

  /// Linear colour at `uv` (0..1 over the image, repeating, v = 0 at the bottom row), averaged over
  /// about `footprint_px` pixels of the image: bilinear in the nearest level.
  Eigen::Vector3f sample(const Eigen::Vector2f& uv, float footprint_px) const;

 private:
  std::vector<RgbImage> levels_;
};

/// How a surface answers light: a diffuse colour or texture, and light of its own.
struct SurfaceMaterial {
  Eigen::Vector3f albedo = Eigen::Vector3f::Constant(0.5f);  ///< linear, where there is no texture
  std::shared_ptr<const Texture> texture;                    ///< may be null
  Eigen::Vector3f emission = Eigen::Vector3f::Zero();        ///< times the albedo, linear
  const char* substance = "";  ///< in words: "wood", "striped cloth"; empty: not said
};

/// Triangles with textures, metres. `normals` and `uvs` are as long as `vertices`.
struct TexturedMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;  ///< unit length; may point to either side
  std::vector<Eigen::Vector2f> uvs;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_materials;  ///< index into materials, as long as triangles
  std::vector<SurfaceMaterial> materials;
};

}  // namespace ovimap
