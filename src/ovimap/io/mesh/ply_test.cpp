// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/mesh/ply.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/io/mesh/mesh_pieces.h"

namespace ovimap {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Bytes bytes_of(const std::string& text) {
  return Bytes(text.begin(), text.end());
}

std::string ply_fault(const Bytes& bytes) {
  return fault_of([&] { decode_ply(bytes, "x.ply"); });
}

std::string ply_fault(const std::string& text) {
  return ply_fault(bytes_of(text));
}

/// Appends a number in the wanted byte order.
template <class Number>
void put(std::string& out, Number value, std::endian order) {
  char bytes[sizeof(Number)];
  std::memcpy(bytes, &value, sizeof(Number));
  if (order != std::endian::native) std::reverse(bytes, bytes + sizeof(Number));
  out.append(bytes, sizeof(Number));
}

Mesh random_mesh(std::size_t vertices, std::size_t triangles) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> real(-5, 5);
  Mesh mesh;
  for (std::size_t i = 0; i < vertices; ++i) {
    mesh.vertices.emplace_back(real(random), real(random), real(random));
    mesh.normals.push_back(Eigen::Vector3f(real(random), real(random), 6).normalized());
    const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
    mesh.colors.push_back({byte(), byte(), byte()});
    mesh.labels.push_back(static_cast<std::uint32_t>(random()));
  }
  const auto index = [&] { return static_cast<std::uint32_t>(random() % vertices); };
  for (std::size_t i = 0; i < triangles; ++i) mesh.triangles.push_back({index(), index(), index()});
  return mesh;
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.labels, b.labels);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(Ply, ComesBackAsItWasWritten) {
  const fixture::TemporaryFolder folder;
  const Mesh mesh = random_mesh(500, 900);
  write_ply(folder.path() / "full.ply", mesh);
  expect_same(read_ply(folder.path() / "full.ply"), mesh);
  const Mesh other = random_mesh(70, 20);
  write_ply(folder.path() / "parts.ply", [&](const auto& visit) {
    visit(mesh);
    visit(other);
  });
  Mesh both = mesh;
  append(other, both);
  expect_same(read_ply(folder.path() / "parts.ply"), both);
}

TEST(Ply, LeavesOutWhatTheMeshLacks) {
  Mesh mesh = random_mesh(20, 5);
  mesh.normals.clear();
  mesh.colors.clear();
  expect_same(decode_ply(encode_ply(mesh), "x.ply"), mesh);
  expect_same(decode_ply(encode_ply(Mesh{}), "x.ply"), Mesh{});
}

constexpr const char* kSquare =
    "ply\nformat ascii 1.0\ncomment made by hand\n"
    "element camera 1\nproperty list uchar float path\n"
    "element vertex 4\nproperty short label\nproperty double z\nproperty float y\n"
    "property int x\nproperty float red\nproperty float green\nproperty float blue\n"
    "property list uchar int tags\n"
    "element face 3\nproperty uchar flag\nproperty list uchar uint vertex_index\nend_header\n"
    "3 0.5 0.5 0.5\n"
    "7 0.5 0 0 1 0.5 0 0\n-1 0.5 0 1 0 0 0 1 9\n8 0.5 1e0 +1 0 0 0 2 9 9\n9 0.5 1 0 0 0 0 0\n"
    "1 4 0 1 2 3\n0 3 3 1 0\n0 2 0 1\n";

TEST(Ply, ReadsAsciiWithAnyOrderAndExtraElements) {
  std::string square(kSquare);
  for (std::size_t at = 0; (at = square.find('\n', at)) != std::string::npos; at += 2)
    square.replace(at, 1, "\r\n");
  const Mesh mesh = decode_ply(bytes_of(square), "x.ply");
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(1, 1, 0.5f));
  EXPECT_EQ(mesh.labels, (std::vector<std::uint32_t>{7, 0, 8, 9}));
  EXPECT_EQ(mesh.colors[0], (std::array<std::uint8_t, 3>{255, 128, 0}));
  EXPECT_TRUE(mesh.normals.empty());
  // The quad is a fan of two, the triangle stays, the edge of two corners goes.
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {3, 1, 0}}));
}

class PlyByteOrder : public ::testing::TestWithParam<std::endian> {};

TEST_P(PlyByteOrder, ReadsEveryNumberType) {
  const std::endian order = GetParam();
  std::string file =
      concat("ply\nformat binary_", order == std::endian::big ? "big" : "little",
             "_endian 1.0\nelement face 1\nproperty list ushort int vertex_indices\n"
             "element vertex 5\nproperty double x\nproperty float y\nproperty int8 z\n"
             "property uint16 label\nelement extra 2\n"
             "property list uint8 double list\nend_header\n");
  put<std::uint16_t>(file, 5, order);
  for (const std::int32_t corner : {4, 3, 2, 1, 0}) put(file, corner, order);
  for (int i = 0; i < 5; ++i) {
    put<double>(file, 0.25 * i, order);
    put<float>(file, -1.5f * static_cast<float>(i), order);
    put<std::int8_t>(file, static_cast<std::int8_t>(-i), order);
    put<std::uint16_t>(file, static_cast<std::uint16_t>(1000 * i), order);
  }
  for (const std::uint8_t count : {0, 2}) {
    put(file, count, order);
    for (int i = 0; i < count; ++i) put<double>(file, 1, order);
  }
  const Mesh mesh = decode_ply(bytes_of(file), "x.ply");
  ASSERT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.vertices[3], Eigen::Vector3f(0.75f, -4.5f, -3.f));
  EXPECT_EQ(mesh.labels, (std::vector<std::uint32_t>{0, 1000, 2000, 3000, 4000}));
  EXPECT_EQ(mesh.triangles, (Triangles{{4, 3, 2}, {4, 2, 1}, {4, 1, 0}}));
}

INSTANTIATE_TEST_SUITE_P(BothOrders, PlyByteOrder,
                         ::testing::Values(std::endian::little, std::endian::big));

TEST(Ply, NamesWhatIsWrongWithTheHeader) {
  EXPECT_NE(ply_fault("solid cube\n").find("'x.ply'"), std::string::npos);
  EXPECT_NE(ply_fault("solid cube\n").find("does not start with 'ply'"), std::string::npos);
  EXPECT_NE(ply_fault("ply\nformat ascii 1.0\nelement vertex 1").find("without an end_header"),
            std::string::npos);
  EXPECT_NE(ply_fault("ply\nend_header\n").find("no format line"), std::string::npos);
  const auto with = [](const std::string& line) {
    return ply_fault("ply\nformat ascii 1.0\n" + line + "\nend_header\n");
  };
  EXPECT_NE(with("format pdf 1.0").find("'format pdf 1.0' at byte 21"), std::string::npos);
  EXPECT_NE(with("element vertex many").find("whole number"), std::string::npos);
  EXPECT_NE(with("element vertex -1").find("whole number"), std::string::npos);
  EXPECT_NE(with("property float x").find("before any element"), std::string::npos);
  EXPECT_NE(with("element v 0\nproperty quad x").find("unknown number type"), std::string::npos);
  EXPECT_NE(with("element v 0\nproperty list float int x").find("no integer"), std::string::npos);
  EXPECT_NE(with("element v 0\nelement v 0").find("second time"), std::string::npos);
  std::string many = "element e 0";
  for (int i = 0; i < 100; ++i) many += "\nelement e" + std::to_string(i) + " 0";
  EXPECT_NE(with(many).find("one element too many"), std::string::npos);
  EXPECT_NE(with("vertices 3").find("not understood"), std::string::npos);
  EXPECT_NE(with("element vertex 1\nproperty float x\nproperty float y").find("only 0 bytes"),
            std::string::npos);
}

TEST(Ply, NamesWhatIsWrongWithTheBody) {
  const std::string vertex =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty float label\n";
  const std::string face = "element face 1\nproperty list int int vertex_indices\n";
  EXPECT_NE(ply_fault(vertex + "end_header\n0 zero 0 1\n")
                .find("element 'vertex', item 0 of 1 at byte 121"),
            std::string::npos);
  EXPECT_NE(ply_fault(vertex + "end_header\n0 nan 0 1\n").find("not finite"), std::string::npos);
  EXPECT_NE(ply_fault(vertex + "end_header\n0 0 0 1.5\n").find("label 1.5"), std::string::npos);
  EXPECT_NE(ply_fault(vertex + "end_header\n0 0 0        ").find("ends too early"),
            std::string::npos);
  EXPECT_NE(ply_fault(vertex + face + "end_header\n0 0 0 1\n3 0 1 0\n").find("uses vertex 1"),
            std::string::npos);
  EXPECT_NE(ply_fault(vertex + face + "end_header\n0 0 0 1\n3 0 -1 0\n").find("vertex index -1"),
            std::string::npos);
  EXPECT_NE(ply_fault(vertex + face + "end_header\n0 0 0 1\n-3 0 1 0\n").find("cannot have -3"),
            std::string::npos);
  EXPECT_NE(ply_fault("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n")
                .find("lacks x, y or z"),
            std::string::npos);
}

TEST(Ply, RefusesACountNoFileCouldHoldWithoutTakingTheMemory) {
  EXPECT_NE(
      ply_fault("ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\n"
                "property float x\nproperty float y\nproperty float z\nend_header\n0123456789ab")
          .find("18446744073709551615 items but only 12 bytes"),
      std::string::npos);
}

TEST(Ply, NoPrefixOfAFilePassesForTheWhole) {
  Bytes whole = encode_ply(random_mesh(3, 2));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string fault =
        ply_fault(Bytes(whole.begin(), whole.begin() + static_cast<long>(size)));
    EXPECT_NE(fault, "") << "cut to " << size;
    EXPECT_EQ(fault.find('\n'), std::string::npos);
  }
}

TEST(Ply, SurvivesChangedBytes) {
  const Bytes whole = encode_ply(random_mesh(4, 4));
  std::mt19937 random(11);
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    Bytes broken = whole;
    for (int i = 0; i < 3; ++i)
      broken[random() % broken.size()] = static_cast<std::uint8_t>(random());
    refused += !ply_fault(broken).empty();
  }
  EXPECT_GT(refused, 500);  // most hits lie in the header or in an index
}

TEST(Ply, NamesAMissingFile) {
  EXPECT_THROW(read_ply("/nonexistent/folder/x.ply"), Error);
  EXPECT_THROW(write_ply("/nonexistent/folder/x.ply", Mesh{}), Error);
}

}  // namespace
}  // namespace ovimap
