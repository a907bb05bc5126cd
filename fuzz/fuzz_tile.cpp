// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The voxels of a tile as the map file has them. The first 9 bytes choose which blocks exist; what
// follows is the body, compressed here when the ninth byte is odd, so that changes reach the layout
// behind the compression; its next bit chooses the schema.
#include <zstd.h>

#include "ovimap/io/map_tables/map_file_blocks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kHead = 9;
  if (size < kHead) return 0;
  std::uint64_t present = 0;
  for (std::size_t i = 0; i < 8; ++i) present |= std::uint64_t{data[i]} << 8 * i;
  std::span<const std::uint8_t> body(data + kHead, size - kHead);
  ovimap::Bytes compressed;
  if (data[8] % 2 == 1) {
    compressed.resize(ZSTD_compressBound(body.size()));
    compressed.resize(
        ZSTD_compress(compressed.data(), compressed.size(), body.data(), body.size(), 1));
    body = compressed;
  }
  ovimap::VoxelMap map;
  for (int i = 0; i < 20; ++i) map.labels().create();
  map.labels().merge(3, 7);
  const std::uint64_t key = ovimap::pack_index({0, -1, 2});
  const ovimap::Tile tile = ovimap::create_tile(map, key, present);
  const int schema = ovimap::kSchemaWithSteps - data[8] / 2 % 2;  // weights as now, and before
  ovimap::TileDecoder decoder;
  if (decoder.decode(body, schema, tile, map).empty()) (void)map.content_hash();
  return 0;
}
