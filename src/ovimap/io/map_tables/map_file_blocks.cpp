// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_blocks.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <SQLiteCpp/SQLiteCpp.h>
#include <zstd.h>

#include "ovimap/base/error.h"
#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/row_words.h"

namespace ovimap {

namespace {

// What is left after prediction is noise, which higher levels do not shrink any further.
constexpr int kCompressionLevel = 1;
constexpr std::size_t kMaskBytes = kBlockVoxels / 8;
constexpr std::size_t kPaletteLimit = 256;
constexpr std::size_t kVoxelBytes = 25;  // with doubts

/// The order in which voxels are stored: a path through the block whose every step goes to a
/// neighbour, so that the voxel before is a good prediction.
constexpr std::array<std::uint16_t, kBlockVoxels> kPath = [] {
  std::array<std::uint16_t, kBlockVoxels> path{};
  for (int i = 0; i < kBlockVoxels; ++i) {
    const int column = i % kBlockSide, row = i / kBlockSide % kBlockSide,
              z = i / (kBlockSide * kBlockSide);
    const int x = row % 2 == 0 ? column : kBlockSide - 1 - column;
    const int y = z % 2 == 0 ? row : kBlockSide - 1 - row;
    path[static_cast<std::size_t>(i)] =
        static_cast<std::uint16_t>(x + kBlockSide * (y + kBlockSide * z));
  }
  return path;
}();

/// A stored voxel. `Block` is const when saving.
template <class Block>
struct Place {
  Block* block;
  std::uint16_t voxel;
};

/// The parts of a tile's body after the blocks' heads. Bytes of like statistics lie together, and
/// the low bytes, which are mostly noise, come last.
struct BodyLayout {
  std::size_t labels, support, tsdf_high, weight_high, color_high, low, end;
  std::size_t voxels, supports;

  BodyLayout(std::size_t head_bytes, std::size_t voxel_count, std::size_t support_count)
      : voxels(voxel_count), supports(support_count) {
    labels = head_bytes;
    support = labels + kLabelSlots * voxels;
    tsdf_high = support + 2 * supports;
    weight_high = tsdf_high + voxels;
    color_high = weight_high + voxels;
    low = color_high + 3 * voxels;
    end = low + 7 * voxels;
  }
};

template <class Number>
Number zigzag(Number difference) {
  const bool negative = difference >> (8 * sizeof(Number) - 1);
  return static_cast<Number>(static_cast<Number>(difference << 1) ^
                             (negative ? static_cast<Number>(~Number{0}) : Number{0}));
}

template <class Number>
Number unzigzag(Number code) {
  return static_cast<Number>(static_cast<Number>(code >> 1) ^
                             static_cast<Number>(Number{0} - (code & 1)));
}

/// Byte planes of a sequence of numbers, lowest byte first; each number is stored as the difference
/// to the one before.
template <class Number>
class Planes {
 public:
  using Pointers = std::array<std::uint8_t*, sizeof(Number)>;
  explicit Planes(const Pointers& planes) : planes_(planes) {}

  void put(Number value) {
    Number code = zigzag(static_cast<Number>(value - previous_));
    previous_ = value;
    for (std::uint8_t*& plane : planes_) {
      *plane++ = static_cast<std::uint8_t>(code);
      code = static_cast<Number>(code >> 8);
    }
  }

  Number take() {
    Number code = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i)
      code = static_cast<Number>(code |
                                 static_cast<Number>(static_cast<Number>(*planes_[i]++) << 8 * i));
    previous_ = static_cast<Number>(previous_ + unzigzag(code));
    return previous_;
  }

 private:
  Pointers planes_;
  Number previous_ = 0;
};

Planes<std::uint16_t> tsdf_planes(std::uint8_t* body, const BodyLayout& at) {
  return Planes<std::uint16_t>({body + at.low, body + at.tsdf_high});
}
Planes<std::uint32_t> weight_planes(std::uint8_t* body, const BodyLayout& at) {
  std::uint8_t* low = body + at.low + at.voxels;
  return Planes<std::uint32_t>({low, low + at.voxels, low + 2 * at.voxels, body + at.weight_high});
}
Planes<std::uint16_t> color_planes(std::uint8_t* body, const BodyLayout& at, std::size_t channel) {
  return Planes<std::uint16_t>(
      {body + at.low + (4 + channel) * at.voxels, body + at.color_high + channel * at.voxels});
}
Planes<std::uint16_t> support_planes(std::uint8_t* body, const BodyLayout& at) {
  return Planes<std::uint16_t>({body + at.support, body + at.support + at.supports});
}

bool stored(const VoxelBlock& block, std::size_t v) {
  std::uint32_t any =
      static_cast<std::uint16_t>(block.tsdf[v]) | std::bit_cast<std::uint32_t>(block.weight[v]);
  any |= block.color[v];
  for (const LabelSlot& slot : block.slots) any |= slot.label[v];
  return any != 0;
}

using SavedPlace = Place<const VoxelBlock>;
using LoadedPlace = Place<VoxelBlock>;

/// Writes the blocks' heads (epochs, palettes, which voxels are stored) and lists the stored
/// voxels.
std::vector<SavedPlace> put_heads(std::span<const VoxelBlock* const> blocks, Bytes& body) {
  std::vector<SavedPlace> places;
  for (const VoxelBlock* block : blocks) append_word(body, block->forest_epoch);
  for (const VoxelBlock* block : blocks)
    append_word(body, static_cast<std::uint16_t>(block->palette.size()));
  for (const VoxelBlock* block : blocks)
    for (Label label : block->palette) append_word(body, label);
  for (const VoxelBlock* block : blocks) {
    const std::size_t mask = body.size();
    body.resize(mask + kMaskBytes);
    for (std::size_t i = 0; i < kBlockVoxels; ++i) {
      if (!stored(*block, kPath[i])) continue;
      body[mask + i / 8] = static_cast<std::uint8_t>(body[mask + i / 8] | 1u << i % 8);
      places.push_back({block, kPath[i]});
    }
  }
  return places;
}

void put_voxels(const std::vector<SavedPlace>& places, std::uint8_t* body, const BodyLayout& at) {
  Planes<std::uint16_t> tsdf = tsdf_planes(body, at);
  for (const auto [block, v] : places) tsdf.put(static_cast<std::uint16_t>(block->tsdf[v]));
  Planes<std::uint32_t> weight = weight_planes(body, at);
  for (const auto [block, v] : places)
    weight.put(static_cast<std::uint32_t>(block->weight[v] * kWeightSteps));  // exact
  // Green, then red and blue as differences to it: the three channels rise and fall together.
  Planes<std::uint16_t> green = color_planes(body, at, 0), red = color_planes(body, at, 1),
                        blue = color_planes(body, at, 2);
  for (const auto [block, v] : places) {
    const auto [r, g, b] = unpack_color(block->color[v]);
    green.put(g);
    red.put(static_cast<std::uint16_t>(r - g));
    blue.put(static_cast<std::uint16_t>(b - g));
  }
  Planes<std::uint16_t> support = support_planes(body, at);
  std::uint8_t* label = body + at.labels;
  for (std::size_t s = 0; s < kLabelSlots; ++s) {
    for (const auto [block, v] : places) {
      *label = s < block->slots.size() ? block->slots[s].label[v] : std::uint8_t{0};
      if (*label++ != 0) support.put(block->slots[s].support[v]);
    }
  }
}

/// Reads little-endian numbers, and says when there are none left.
class HeadCursor {
 public:
  explicit HeadCursor(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool has(std::size_t count) const { return bytes_.size() - at_ >= count; }
  std::size_t position() const { return at_; }
  std::uint32_t take(int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value |= static_cast<std::uint32_t>(bytes_[at_++]) << 8 * i;
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Reads the blocks' heads; returns what is wrong with them.
std::string take_heads(HeadCursor& head, std::span<VoxelBlock* const> blocks,
                       const LabelForest& forest, std::vector<LoadedPlace>& places) {
  if (!head.has(blocks.size() * 6)) return "its heads are cut off";
  for (VoxelBlock* block : blocks) {
    block->forest_epoch = head.take(4);
    if (block->forest_epoch > forest.epoch()) return "it is newer than the table of merged labels";
  }
  for (VoxelBlock* block : blocks) {
    const std::uint32_t size = head.take(2);
    if (size == 0 || size > kPaletteLimit) return concat("a palette cannot have ", size, " labels");
    block->palette.resize(size);
  }
  for (VoxelBlock* block : blocks) {
    if (!head.has(block->palette.size() * 4)) return "its palettes are cut off";
    for (Label& label : block->palette) {
      label = head.take(4);
      if (label > forest.last_label()) return concat("label ", label, " was never given");
    }
    if (block->palette[0] != kNoLabel) return "a palette does not begin with 'no label'";
  }
  for (VoxelBlock* block : blocks) {
    if (!head.has(kMaskBytes)) return "its voxel masks are cut off";
    for (std::size_t i = 0; i < kBlockVoxels; i += 8)
      for (std::uint32_t bits = head.take(1), k = 0; bits != 0; bits >>= 1, ++k)
        if (bits & 1) places.push_back({block, kPath[i + k]});
  }
  return {};
}

/// Reads the label slots; false when one points beyond its palette.
bool take_labels(const std::vector<LoadedPlace>& places, std::uint8_t* body, const BodyLayout& at) {
  Planes<std::uint16_t> support = support_planes(body, at);
  const std::uint8_t* label = body + at.labels;
  for (std::size_t s = 0; s < kLabelSlots; ++s) {
    for (const auto [block, v] : places) {
      if (*label >= block->palette.size()) return false;
      const std::uint8_t position = *label++;
      if (position == 0) continue;
      LabelSlot& slot = block->slot(s);
      slot.label[v] = position;
      slot.support[v] = support.take();
    }
  }
  return true;
}

/// A weight as it is stored; negative when it is none.
float read_weight(std::uint32_t stored, int schema) {
  constexpr float kMost = 1u << 21;  // twice what a map's settings allow
  if (schema >= kSchemaWithSteps) return std::min(static_cast<float>(stored) / kWeightSteps, kMost);
  const auto weight = std::bit_cast<float>(stored);
  if (!(weight >= 0.f && weight <= std::numeric_limits<float>::max())) return -1.f;
  return weight > 0.f ? round_weight(std::min(weight, kMost)) : 0.f;
}

/// Reads distances, weights and colours; false when a weight is none.
bool take_voxels(const std::vector<LoadedPlace>& places, int schema, std::uint8_t* body,
                 const BodyLayout& at) {
  Planes<std::uint16_t> tsdf = tsdf_planes(body, at);
  for (const auto [block, v] : places) block->tsdf[v] = static_cast<std::int16_t>(tsdf.take());
  Planes<std::uint32_t> weight = weight_planes(body, at);
  bool weights_valid = true;
  for (const auto [block, v] : places) {
    block->weight[v] = read_weight(weight.take(), schema);
    weights_valid = weights_valid && block->weight[v] >= 0.f;
    if (block->weight[v] > 0.f)  // older files have observed voxels with a distance of 0
      block->tsdf[v] = VoxelBlock::stored_distance(block->tsdf[v]);
    block->note_observed(v);
  }
  Planes<std::uint16_t> green = color_planes(body, at, 0), red = color_planes(body, at, 1),
                        blue = color_planes(body, at, 2);
  for (const auto [block, v] : places) {
    const std::uint16_t g = green.take();
    block->color[v] = pack_color({static_cast<std::uint16_t>(red.take() + g), g,
                                  static_cast<std::uint16_t>(blue.take() + g)});
  }
  return weights_valid;
}

bool doubted(std::span<const VoxelBlock* const> blocks) {
  return std::any_of(blocks.begin(), blocks.end(),
                     [](const VoxelBlock* block) { return block->doubted(); });
}

void put_doubts(const std::vector<SavedPlace>& places, std::uint8_t* doubts) {
  for (const auto [block, v] : places)
    *doubts++ = block->doubts.empty() ? std::uint8_t{0} : block->doubts[v];
}

void take_doubts(const std::vector<LoadedPlace>& places, const std::uint8_t* doubts) {
  for (const auto [block, v] : places) {
    const std::uint8_t count = *doubts++;
    if (count == 0) continue;
    block->doubts.resize(kBlockVoxels);
    block->doubts[v] = count;
  }
}

std::size_t count_supports(std::span<const std::uint8_t> labels) {
  return labels.size() - static_cast<std::size_t>(std::count(labels.begin(), labels.end(), 0));
}

}  // namespace

TileEncoder::TileEncoder()
    : context_(ZSTD_createCCtx(), [](ZSTD_CCtx* context) { ZSTD_freeCCtx(context); }) {}
TileEncoder::~TileEncoder() = default;

Bytes TileEncoder::encode(std::span<const VoxelBlock* const> blocks) {
  body_.clear();
  const std::vector<SavedPlace> places = put_heads(blocks, body_);
  std::size_t supports = 0;
  for (const auto [block, v] : places)
    for (const LabelSlot& slot : block->slots) supports += slot.label[v] != 0;
  const BodyLayout layout(body_.size(), places.size(), supports);
  const bool doubts = doubted(blocks);  // a plane of their own at the end, mostly left out
  body_.resize(layout.end + (doubts ? places.size() : 0));
  put_voxels(places, body_.data(), layout);
  if (doubts) put_doubts(places, body_.data() + layout.end);

  // A flush between the two parts gives each its own entropy tables; it is one frame all the same.
  ZSTD_CCtx_reset(context_.get(), ZSTD_reset_session_and_parameters);
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kCompressionLevel);
  ZSTD_CCtx_setPledgedSrcSize(context_.get(), body_.size());
  constexpr std::size_t kFlushBytes = 64;
  Bytes data(ZSTD_compressBound(body_.size()) + kFlushBytes);
  ZSTD_outBuffer out{data.data(), data.size(), 0};
  ZSTD_inBuffer in{body_.data(), layout.low, 0};
  const std::size_t flushed = ZSTD_compressStream2(context_.get(), &out, &in, ZSTD_e_flush);
  in.size = body_.size();
  const std::size_t left = ZSTD_compressStream2(context_.get(), &out, &in, ZSTD_e_end);
  if (flushed != 0 || left != 0)
    throw Error("the compressor ran out of memory; close other programs");
  data.resize(out.pos);
  return data;
}

TileDecoder::TileDecoder()
    : context_(ZSTD_createDCtx(), [](ZSTD_DCtx* context) { ZSTD_freeDCtx(context); }) {}
TileDecoder::~TileDecoder() = default;

std::string TileDecoder::decode(std::span<const std::uint8_t> data, int schema, const Tile& tile,
                                VoxelMap& map) {
  std::vector<VoxelBlock*> blocks;
  for (const std::uint32_t slot : tile.slots) blocks.push_back(&map.writable_block(slot));
  return decode(data, schema, blocks, map.labels());
}

std::string TileDecoder::decode(std::span<const std::uint8_t> data, int schema,
                                std::span<VoxelBlock* const> blocks, const LabelForest& forest) {
  constexpr std::size_t kMostBlockBytes =
      6 + 4 * kPaletteLimit + kMaskBytes + kVoxelBytes * kBlockVoxels;
  body_.resize(std::max(body_.size(), blocks.size() * kMostBlockBytes));
  const std::size_t size = ZSTD_decompressDCtx(
      context_.get(), body_.data(), blocks.size() * kMostBlockBytes, data.data(), data.size());
  if (ZSTD_isError(size)) return concat("it does not decompress (", ZSTD_getErrorName(size), ")");
  const std::span<const std::uint8_t> body(body_.data(), size);
  HeadCursor head(body);
  std::vector<LoadedPlace> places;
  if (std::string fault = take_heads(head, blocks, forest, places); !fault.empty()) return fault;
  const std::size_t label_bytes = kLabelSlots * places.size();
  if (!head.has(label_bytes)) return "its labels are cut off";
  const BodyLayout layout(head.position(), places.size(),
                          count_supports(body.subspan(head.position(), label_bytes)));
  const bool doubts = !places.empty() && size == layout.end + places.size();
  if (layout.end != size && !doubts)
    return concat("it has ", size, " bytes where ", layout.end, " are expected");
  if (!take_labels(places, body_.data(), layout)) return "a label slot points beyond its palette";
  if (!take_voxels(places, schema, body_.data(), layout))
    return "a weight is negative or not finite";
  if (doubts) take_doubts(places, body_.data() + layout.end);
  return {};
}

std::string renew_tile(StoredTile& tile, int schema, const LabelForest& forest) {
  if (schema >= kSchemaWithSteps) return {};
  std::vector<VoxelBlock> blocks(static_cast<std::size_t>(std::popcount(tile.present)),
                                 VoxelBlock({0, 0, 0}));
  std::vector<VoxelBlock*> places;
  for (VoxelBlock& block : blocks) places.push_back(&block);
  std::string fault = TileDecoder().decode(tile.data, schema, places, forest);
  if (fault.empty()) tile.data = TileEncoder().encode({places.begin(), places.end()});
  return fault;
}

std::optional<StoredTile> read_tile(SQLite::Database& database, std::uint64_t tile) {
  SQLite::Statement row(database, "SELECT present, hash, data FROM blocks WHERE tile = ?");
  row.bind(1, static_cast<std::int64_t>(tile));
  if (!row.executeStep()) return std::nullopt;
  const SQLite::Column data = row.getColumn(2);
  const auto* bytes = static_cast<const std::uint8_t*>(data.getBlob());
  StoredTile stored{static_cast<std::uint64_t>(row.getColumn(0).getInt64()),
                    Bytes(bytes, bytes + data.getBytes())};
  if (stored_hash(stored.data) != row.getColumn(1).getInt64()) return std::nullopt;
  return stored;
}

}  // namespace ovimap
