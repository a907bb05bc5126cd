// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/place_picture.h"

#include <algorithm>
#include <array>
#include <limits>

#include "ovimap/base/error.h"
#include "ovimap/io/pictures/pictures.h"

namespace ovimap {

namespace {

using Rgb = std::array<std::uint8_t, 3>;

constexpr Rgb kObject = {220, 30, 30};
constexpr int kPale = 225;  // half way to this grey
constexpr int kLongestSidePx = 720;
constexpr float kAboveM = 0.01f;  // half a voxel and noise

Rgb pale(const Rgb& color) {
  Rgb result;
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = static_cast<std::uint8_t>((color[i] + kPale) / 2);
  return result;
}

}  // namespace

RgbImage place_picture(Mesh mesh, std::uint32_t id, const Eigen::Vector3f& up) {
  const Eigen::Vector3f upward = up.normalized();
  mesh.colors.resize(mesh.vertices.size(), Rgb{160, 160, 160});
  float top_m = std::numeric_limits<float>::lowest();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const bool mine = i < mesh.labels.size() && mesh.labels[i] == id;
    mesh.colors[i] = mine ? kObject : pale(mesh.colors[i]);
    if (mine) top_m = std::max(top_m, upward.dot(mesh.vertices[i]));
  }
  if (top_m == std::numeric_limits<float>::lowest())
    throw Error(concat("object ", id, " has no surface yet, so its place cannot be drawn"));
  PictureConfig config;
  config.coloring = MeshColoring::kColors;
  config.longest_side_px = kLongestSidePx;
  config.supersampling = 1;  // asked for while somebody waits
  return top_down(mesh, upward, config, top_m + kAboveM);
}

}  // namespace ovimap
