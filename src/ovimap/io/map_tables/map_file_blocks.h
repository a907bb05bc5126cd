// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "ovimap/image/codec.h"
#include "ovimap/map/voxels/block_tiles.h"

namespace SQLite {
class Database;
}

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace ovimap {

/// From this schema on weights and colours are in steps (kWeightSteps, PackedColor) and weights
/// stored as numbers of steps. What older maps say is rounded.
inline constexpr int kSchemaWithSteps = 7;

/// A tile as the table `blocks` has it.
struct StoredTile {
  std::uint64_t present = 0;
  Bytes data;  ///< as TileEncoder made it
};

/// Nothing where there is no such tile, or its data are not what was written.
std::optional<StoredTile> read_tile(SQLite::Database& database, std::uint64_t tile);

/// Turns the blocks of a tile, in the order of their bits, into bytes (docs/map-format.md,
/// "Tiles"). Keeps its buffers between calls; one per thread.
class TileEncoder {
 public:
  TileEncoder();
  ~TileEncoder();
  Bytes encode(std::span<const VoxelBlock* const> blocks);

 private:
  std::unique_ptr<ZSTD_CCtx_s, void (*)(ZSTD_CCtx_s*)> context_;
  Bytes body_;
};

/// The way back. Trusts no byte of its input.
class TileDecoder {
 public:
  TileDecoder();
  ~TileDecoder();

  /// Fills `blocks`, which must be fresh, in the order of their bits, and returns what is wrong
  /// with `data`; empty when nothing is. `forest`: the labels that there are; `schema`: the map's.
  [[nodiscard]] std::string decode(std::span<const std::uint8_t> data, int schema,
                                   std::span<VoxelBlock* const> blocks, const LabelForest& forest);
  /// The same for the blocks of a map's tile. Different tiles of one map may be filled at the same
  /// time.
  [[nodiscard]] std::string decode(std::span<const std::uint8_t> data, int schema, const Tile& tile,
                                   VoxelMap& map);

 private:
  std::unique_ptr<ZSTD_DCtx_s, void (*)(ZSTD_DCtx_s*)> context_;
  Bytes body_;
};

/// Makes a tile of a map of that schema one as this program writes them; returns what is wrong with
/// it.
[[nodiscard]] std::string renew_tile(StoredTile& tile, int schema, const LabelForest& forest);

}  // namespace ovimap
