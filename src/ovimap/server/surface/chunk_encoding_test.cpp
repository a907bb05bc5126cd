// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/chunk_encoding.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "ovimap/image/codec.h"

namespace ovimap {
namespace {

const ChunkGrid kGrid{0.01f};
/// The viewer's tests decode the same file.
const std::filesystem::path kShared = OVIMAP_SOURCE_DIR "/tests/chunks/two_patches.bin";

/// Two triangles in the block (0, 0, 0) and one in (-1, 2, 3), on round numbers.
MeshChunk two_patches() {
  MeshChunk chunk;
  chunk.index = {0, 0, 0};
  chunk.version = 5;
  Mesh first, second;
  first.vertices = {{0.005f, 0.005f, 0.005f},
                    {0.645f, 0.005f, 0.005f},
                    {0.645f, 0.645f, 0.005f},
                    {0.005f, 0.645f, 1.285f}};
  first.normals = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  first.colors = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {10, 20, 30}};
  first.labels = {1, 1, 70000, 0};
  first.triangles = {{0, 1, 2}, {0, 2, 3}};
  second.vertices = {{0.325f, 0.325f, 0.325f}, {0.4f, 0.5f, 0.6f}, {0.7f, 0.8f, 0.9f}};
  second.normals = {{0.6f, 0.f, 0.8f}, {-0.6f, 0.f, -0.8f}, {0.f, 0.6f, -0.8f}};
  second.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  second.labels = {2, 2, 2};
  second.triangles = {{2, 1, 0}};
  chunk.patches = {{{0, 0, 0}, 5, std::make_shared<Mesh>(first)},
                   {{1, 2, 3}, 3, std::make_shared<Mesh>(second)}};
  return chunk;
}

template <class Value>
Value at(const std::string& bytes, std::size_t offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST(ChunkEncodingTest, IsWhatTheViewerReads) {
  const std::string bytes = encode_chunk(two_patches(), kGrid, 0);
  if (std::getenv("OVIMAP_WRITE_FIXTURES") != nullptr)
    write_file(kShared, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  const Bytes shared = read_file(kShared);
  EXPECT_EQ(bytes, std::string(shared.begin(), shared.end()))
      << "the format changed: raise its version, and write the file anew with "
         "OVIMAP_WRITE_FIXTURES=1";
}

TEST(ChunkEncodingTest, TellsHowWellPlacesAreKnown) {
  MeshChunk fine = two_patches();
  fine.patches[0].error = 12;
  const std::size_t known = 56 + 2 * 28 + 7 * 8 + 3;  // of the first vertex
  const std::string bytes = encode_chunk(fine, kGrid, 0);
  for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(at<std::uint8_t>(bytes, known + 4 * v), 12);
  EXPECT_EQ(at<std::uint8_t>(bytes, known + 4 * 4), 0) << "of a block of which nothing is told";
  const std::string coarse =
      encode_chunk(two_patches(), kGrid, 1, 0, {{pack_index(fine.patches[0].block), 12}});
  EXPECT_EQ(at<std::uint8_t>(coarse, known), 12);
  EXPECT_EQ(at<std::uint8_t>(coarse, known + 4), 0) << "a vertex in another block";
}

TEST(ChunkEncodingTest, LiesAsDocumented) {
  const std::string bytes = encode_chunk(two_patches(), kGrid, 1);
  EXPECT_EQ(bytes.substr(0, 4), "OVMC");
  EXPECT_EQ(at<std::uint16_t>(bytes, 4), 2);
  EXPECT_EQ(at<std::uint16_t>(bytes, 6), 1);
  EXPECT_FLOAT_EQ(at<float>(bytes, 20), 0.005f);
  EXPECT_FLOAT_EQ(at<float>(bytes, 32), 1.28f);
  EXPECT_EQ(at<std::uint32_t>(bytes, 36), 2u);
  EXPECT_EQ(at<std::uint32_t>(bytes, 40), 7u);
  EXPECT_EQ(at<std::uint32_t>(bytes, 44), 3u);
  EXPECT_EQ(at<std::uint64_t>(bytes, 48), 5u);
  const std::size_t positions = 56 + 2 * 28, colors = positions + 7 * 8, labels = colors + 7 * 4,
                    indices = labels + 7 * 4;
  ASSERT_EQ(bytes.size(), indices + 9 * 4);
  EXPECT_EQ(at<std::uint16_t>(bytes, positions + 8), 32768);  // half of the edge
  EXPECT_EQ(at<std::uint16_t>(bytes, positions + 3 * 8 + 4), 65535);
  EXPECT_EQ(at<std::uint32_t>(bytes, labels + 8), 70000u);
  EXPECT_EQ(at<std::uint32_t>(bytes, indices + 24), 6u);  // of the whole chunk, not of the patch
}

TEST(ChunkEncodingTest, LeavesOutWhatIsOld) {
  const std::string bytes = encode_chunk(two_patches(), kGrid, 0, 3);
  EXPECT_EQ(at<std::uint32_t>(bytes, 36), 1u);
  EXPECT_EQ(at<std::uint32_t>(bytes, 40), 4u);
  EXPECT_EQ(encode_chunk(two_patches(), kGrid, 0, 5).size(), 56u);
}

TEST(ChunkEncodingTest, SurvivesSurfaceWithoutAttributes) {
  MeshChunk chunk = two_patches();
  for (SurfacePatch& patch : chunk.patches) {
    auto bare = std::make_shared<Mesh>();
    bare->vertices = patch.mesh->vertices;
    bare->triangles = patch.mesh->triangles;
    patch.mesh = bare;
  }
  EXPECT_EQ(encode_chunk(chunk, kGrid, 0).size(), encode_chunk(two_patches(), kGrid, 0).size());
}

}  // namespace
}  // namespace ovimap
