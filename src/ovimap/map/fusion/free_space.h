// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ovimap/map/fusion/integrate.h"

namespace ovimap {

class ConfigFields;

/// When a surface is taken back because frames see through it.
struct FreeSpaceConfig {
  bool enabled = true;
  int frames = 3;              ///< so many frames on end must see through a voxel, none its surface
  float margin_voxels = 3.f;   ///< nothing goes that is nearer to the plane that is seen
  float sigmas = 5.f;          ///< the same in standard deviations of the depth, along the ray
  float least_slope = 0.2f;    ///< what is seen at more of a slant says nothing
  float unknown_slope = 0.5f;  ///< how a plane that is not known is taken to lie
  int guard_px = 2;            ///< the rays so far around, and up to twice as far, must be as free
  float holes = 0.05f;         ///< where more of those have no answer, nothing is known
  float least_step_m = 0.01f;  ///< frames count as several where the camera has moved this far
  float least_turn_rad = 0.01f;  ///< or turned this far in between
};
void list_fields(FreeSpaceConfig& config, ConfigFields& fields);

/// What `clear_free_space` did.
struct ClearedSpace {
  std::vector<std::uint32_t> slots;  ///< of the blocks that it changed, in block-index order
  std::size_t doubted = 0;           ///< voxels whose surface the frame sees through
  std::size_t cleared = 0;           ///< of those, voxels that are as never observed now
  bool refused = false;  ///< the frame contradicts more of the map than it confirms, so nothing was
                         ///< changed: it is the frame that is wrong, or its pose
};

/// Up to which depth each pixel's ray, and those around it, run through empty space: 0 where
/// nothing is known. The least of a square of 3 x 3 cells of guard_px pixels, so that neither a
/// pose that is a pixel off nor the mixed pixels of an edge open a hole in what stands there; what
/// is thinner than a pixel shows in holes. Each pixel's own part ends before the plane that it sees
/// by margin and sigmas. The observation must have sigma_m.
Image<float> free_depth(const VoxelMapConfig& map, const Observation& observation,
                        const FreeSpaceConfig& config);
/// The observation's own, or else made and kept in `made`.
const Image<float>& free_depth(const VoxelMapConfig& map, const Observation& observation,
                               const FreeSpaceConfig& config, Image<float>& made);

/// Takes back surface that the frame, and others before it, see through. A voxel that claims to be
/// within a voxel of a surface, or behind one, and lies in front of the free depth, is doubted; one
/// that was doubted by config.frames frames on end becomes as never observed. `integrate` ends
/// doubts where a frame shows the surface after all. Call before it.
///
/// Visits the blocks that lie between the camera and what it sees, by projection; no ray is
/// marched. Does nothing where the deviation of the depth is unknown.
ClearedSpace clear_free_space(VoxelMap& map, const Observation& observation,
                              const FreeSpaceConfig& config);

/// Takes back at once what lies in front of `free_m` in these blocks, as clear_free_space does
/// after several frames. `slots`: in block-index order; returns those of blocks that changed
/// likewise. The observation must have sigma_m.
std::vector<std::uint32_t> clear_blocks(VoxelMap& map, const Observation& observation,
                                        const Image<float>& free_m,
                                        std::span<const std::uint32_t> slots);

/// Which frames are looks of their own: sensors err alike from one place.
class SeparateLooks {
 public:
  /// Whether the camera has moved enough since the last time that this was true.
  bool next(const Pose& world_from_camera, const FreeSpaceConfig& config);

 private:
  std::optional<Pose> last_;
};

}  // namespace ovimap
