// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "ovimap/synth/shapes/height_map.h"
#include "ovimap/synth/shapes/oriented_box.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {

class ConfigFields;

struct LayoutConfig {
  int tries = 400;                     ///< random places tried for each piece
  float gap_m = 0.04f;                 ///< least distance between pieces on the floor
  float wall_gap_m = 0.02f;            ///< between a piece and the wall behind it
  float front_clearance_m = 0.3f;      ///< kept free in front of pieces along the walls
  float door_clearance_m = 0.8f;       ///< kept free in front of doors
  float chair_gap_m = 0.05f;           ///< between a chair and its table
  float surface_gap_m = 0.02f;         ///< between things on one surface
  float surface_tolerance_m = 0.008f;  ///< unevenness under a thing
  float soft_tolerance_m = 0.12f;      ///< the same under pillows and blankets, which sink in
  float yaw_jitter_rad = 0.2f;         ///< how carelessly chairs and small things are turned
};
void list_fields(LayoutConfig& config, ConfigFields& fields);

/// One wall of a rectangular room, seen on the floor plan.
struct WallLine {
  std::string name;
  Eigen::Vector2f start_m, along, inward;  ///< along and inward have length one
  float length_m = 0;
};
std::array<WallLine, 4> wall_lines(const Eigen::Vector2f& room_size_m);

/// The turn that makes a piece (whose front is -y) face `direction`.
float yaw_facing(const Eigen::Vector2f& direction);

/// Finds places for pieces so that no two occupy the same space. A piece is found a place for, then
/// added. Sizes are width, depth, height in metres. Every finder returns nothing when all tries
/// failed.
class RoomLayout {
 public:
  RoomLayout(const Eigen::Vector3f& room_size_m, std::uint64_t seed,
             const LayoutConfig& config = {});

  [[nodiscard]] std::optional<OrientedBox> against_wall(const Eigen::Vector3f& size_m);
  [[nodiscard]] std::optional<OrientedBox> in_corner(const Eigen::Vector3f& size_m);
  [[nodiscard]] std::optional<OrientedBox> in_middle(const Eigen::Vector3f& size_m);
  [[nodiscard]] std::optional<OrientedBox> on_floor(const Eigen::Vector3f& size_m);
  /// Flat on one of the `allowed` walls, its lower edge at `bottom_m`.
  [[nodiscard]] std::optional<OrientedBox> on_wall(const Eigen::Vector3f& size_m, float bottom_m,
                                                   const std::array<bool, 4>& allowed = {
                                                       true, true, true, true});
  /// At a side of `table`, facing it.
  [[nodiscard]] std::optional<OrientedBox> around(const OrientedBox& table,
                                                  const Eigen::Vector3f& size_m);
  /// On the upper side of the added piece number `support`. `aligned`: facing as that piece does;
  /// `soft`: sinks into uneven ground.
  [[nodiscard]] std::optional<OrientedBox> on_top(std::size_t support, const HeightMap& upper_side,
                                                  const Eigen::Vector3f& size_m, bool aligned,
                                                  bool soft = false);

  /// Returns the number of the piece.
  std::size_t add(const OrientedBox& box);
  /// Keeps a space free of later pieces; small things on furniture may be there.
  void keep_clear(const OrientedBox& box) { clear_.push_back(box); }
  /// The space in front of a piece, as wide as it is, `reach_m` deep.
  static OrientedBox space_in_front(const OrientedBox& box, float reach_m);

  const std::vector<OrientedBox>& pieces() const { return pieces_; }
  Random& random() { return random_; }

 private:
  bool free_of_pieces(const OrientedBox& box) const;
  bool fits(const OrientedBox& box) const;  ///< and free of the spaces kept clear
  OrientedBox at_wall(const WallLine& wall, float position_m, float gap_m,
                      const Eigen::Vector3f& size_m) const;

  Eigen::Vector3f room_size_m_;
  LayoutConfig config_;
  Random random_;
  std::vector<OrientedBox> pieces_, clear_;
};

}  // namespace ovimap
