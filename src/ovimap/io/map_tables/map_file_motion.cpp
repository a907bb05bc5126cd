// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_motion.h"

#include <algorithm>
#include <optional>

#include <SQLiteCpp/SQLiteCpp.h>
#include <zstd.h>

#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/row_words.h"

namespace ovimap {

namespace {

using map_tables::kMovers;
using map_tables::kSeenFree;
using map_tables::kSuspectSpace;

constexpr int kSpaceCompressionLevel = 1;
constexpr std::size_t kRegionBytes = 2 * std::tuple_size_v<SpaceRegion>;

/// The looks of all cells, then for how long each is taken.
Bytes region_bytes(const SpaceRegion& region) {
  Bytes bytes;
  for (const SpaceCell& cell : region) bytes.push_back(cell.looks);
  for (const SpaceCell& cell : region) bytes.push_back(cell.taken);
  Bytes packed(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(),
                                         kSpaceCompressionLevel);
  if (ZSTD_isError(size)) throw Error("the compressor ran out of memory; close other programs");
  packed.resize(size);
  return packed;
}

SpaceRegion take_region(RowReader& rows) {
  const std::span<const std::uint8_t> packed = rows.blob();
  Bytes bytes(kRegionBytes);
  const std::size_t size =
      ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  if (ZSTD_isError(size) || size != bytes.size()) rows.fail("has cells that do not decompress");
  SpaceRegion region;
  for (std::size_t i = 0; i < region.size(); ++i) region[i] = {bytes[i], bytes[region.size() + i]};
  return region;
}

/// A bit for each cell, the lowest of a byte first.
Bytes suspect_bits(const SpaceRegion& region) {
  Bytes bits(region.size() / 8, 0);
  for (std::size_t i = 0; i < region.size(); ++i)
    if (region[i].suspect) bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | 1u << i % 8);
  return bits;
}

void take_suspects(RowReader& rows, const BlockIndex& region, SeenFree& space) {
  const std::span<const std::uint8_t> bits = rows.blob();
  if (bits.size() != std::tuple_size_v<SpaceRegion> / 8) rows.fail("has another number of cells");
  for (std::size_t i = 0; i < 8 * bits.size(); ++i)
    if (bits[i / 8] >> i % 8 & 1) space.suspect(BlockRegion::block_at(region, i));
}

constexpr std::size_t kStepWords = 5;  // frame in two, place in three

Bytes path_bytes(const std::vector<MoverStep>& path) {
  Bytes bytes;
  for (const MoverStep& step : path) {
    append_word(bytes, static_cast<std::uint64_t>(step.frame));
    for (const float coordinate : step.place) append_float(bytes, coordinate);
  }
  return bytes;
}

std::vector<MoverStep> take_path(RowReader& rows) {
  const auto words = words_of<std::uint32_t>(rows.blob(), rows);
  if (words.empty() || words.size() % kStepWords != 0) rows.fail("has a path that is none");
  std::vector<MoverStep> path;
  for (std::size_t i = 0; i < words.size(); i += kStepWords) {
    MoverStep& step = path.emplace_back();
    step.frame = static_cast<std::int64_t>(std::uint64_t{words[i + 1]} << 32 | words[i]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      step.place[static_cast<Eigen::Index>(axis)] = std::bit_cast<float>(words[i + 2 + axis]);
    if (!step.place.allFinite()) rows.fail("has a place that is none");
  }
  return path;
}

}  // namespace

void write_motion(SQLite::Database& database, const MapRecord& record) {
  std::optional<RowWriter> regions, suspects, movers;  // tables are made for their first rows
  for (const auto& [key, region] : record.seen_free.regions()) {
    if (!regions) regions.emplace(database, kSeenFree);
    regions->insert(static_cast<std::int64_t>(key), region_bytes(region));
  }
  if (regions) regions->finish();
  for (const auto& [key, region] : record.seen_free.regions()) {
    const Bytes bits = suspect_bits(region);
    if (std::all_of(bits.begin(), bits.end(), [](std::uint8_t byte) { return byte == 0; }))
      continue;
    if (!suspects) suspects.emplace(database, kSuspectSpace);
    suspects->insert(static_cast<std::int64_t>(key), std::span<const std::uint8_t>(bits));
  }
  if (suspects) suspects->finish();
  for (const Mover& mover : record.movers) {
    if (!movers) movers.emplace(database, kMovers);
    const Bytes path = path_bytes(mover.path);
    movers->insert(mover.id, mover.size_m.x(), mover.size_m.y(), mover.size_m.z(),
                   std::span<const std::uint8_t>(path));
  }
  if (movers) movers->finish();
}

void read_motion(SQLite::Database& database, MapRecord& record) {
  if (holds_table(database, kSeenFree)) {
    SeenFree::Regions regions;
    RowReader rows(database, kSeenFree);
    while (rows.next()) {
      const auto key = rows.integer<std::uint64_t>();
      regions.emplace(key, take_region(rows));
    }
    record.seen_free.restore(std::move(regions));
  }
  if (holds_table(database, kSuspectSpace)) {
    RowReader rows(database, kSuspectSpace);
    while (rows.next()) {
      const auto key = rows.integer<std::uint64_t>();
      take_suspects(rows, unpack_index(key), record.seen_free);
    }
  }
  if (!holds_table(database, kMovers)) return;
  RowReader rows(database, kMovers);
  while (rows.next()) {
    Mover mover;
    mover.id = rows.integer<int>();
    if (mover.id != static_cast<int>(record.movers.size()) + 1) rows.fail("has a gap");
    for (float& size : mover.size_m) size = static_cast<float>(rows.real());
    if (!mover.size_m.allFinite()) rows.fail("has a size that is none");
    mover.path = take_path(rows);
    record.movers.push_back(std::move(mover));
  }
}

}  // namespace ovimap
