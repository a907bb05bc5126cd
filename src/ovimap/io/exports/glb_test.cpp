// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/exports/glb.h"

#include <cstring>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/image/codec.h"

namespace ovimap {
namespace {

// tests/export_test.py has the files read by other programs; here are the layout and odd cases.

std::uint32_t word(const std::string& file, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, file.data() + at, 4);
  return value;
}

nlohmann::json document_of(const std::string& file) {
  EXPECT_EQ(word(file, 0), 0x46546C67u);
  EXPECT_EQ(word(file, 8), file.size());
  EXPECT_EQ(word(file, 12) % 4, 0u);
  return nlohmann::json::parse(file.begin() + 20, file.begin() + 20 + word(file, 12));
}

InstanceSummary instance(InstanceId id) {
  InstanceSummary result;
  result.id = id;
  result.box = {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1, 1, 0)};
  return result;
}

Mesh two_triangles() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
  mesh.normals.assign(6, Eigen::Vector3f::Zero());  // degenerate, which the format forbids
  mesh.colors.assign(6, {255, 0, 188});
  mesh.labels = {4, 4, 4, 0, 0, 0};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  return mesh;
}

MeshParts whole(Mesh mesh) {
  return [mesh = std::move(mesh)](const auto& visit) { visit(mesh); };
}

TEST(Glb, HasANodePerObject) {
  const ObjectTitles titles{{{4, "mug"}}, {{4, "cup"}, {9, "chair"}}};
  std::vector objects{instance(4), instance(9)};
  objects[0].super_points = {2, 7};
  std::vector parts{instance(7)};
  parts[0].super_points = {7};
  parts[0].points = 30;
  const std::string file = encode_glb(whole(two_triangles()), {objects, parts, titles});
  const auto document = document_of(file);
  const auto& nodes = document["nodes"];
  ASSERT_EQ(nodes.size(), 4u);
  EXPECT_EQ(nodes[0]["name"], "mug 4");
  EXPECT_EQ(nodes[0]["extras"]["id"], 4);
  EXPECT_EQ(nodes[0]["extras"]["box"]["max"][0], 1);
  EXPECT_EQ(nodes[0]["extras"]["label"], "cup");
  ASSERT_EQ(nodes[0]["extras"]["parts"].size(), 1u);
  EXPECT_EQ(nodes[0]["extras"]["parts"][0]["name"], "part 1");
  EXPECT_EQ(nodes[0]["extras"]["parts"][0]["points"], 30);
  EXPECT_FALSE(nodes[1]["extras"].contains("parts"));
  EXPECT_EQ(nodes[1]["name"], "chair 9");
  EXPECT_FALSE(nodes[1].contains("mesh"));  // it has no surface
  EXPECT_EQ(nodes[2]["name"], "background");
  EXPECT_EQ(nodes[3]["name"], "map");
  EXPECT_EQ(document["accessors"][0]["max"], nlohmann::json({1, 1, 0}));
  EXPECT_EQ(document["buffers"][0]["byteLength"], word(file, 20 + word(file, 12)));
}

TEST(Glb, AFileOfPartsIsThatOfTheWhole) {
  Mesh first = two_triangles(), second = first;
  first.triangles.pop_back();
  second.triangles.erase(second.triangles.begin());
  const std::vector objects{instance(4), instance(9)};
  const ObjectTitles titles{{{4, "mug"}}, {}};
  const fixture::TemporaryFolder folder;
  const auto path = folder.path() / "parts.glb";
  write_glb(path,
            [&](const auto& visit) {
              visit(first);
              visit(second);
            },
            {objects, {}, titles});
  const Bytes written = read_file(path);
  EXPECT_EQ(std::string(written.begin(), written.end()),
            encode_glb(whole(two_triangles()), {objects, {}, titles}));
}

TEST(Glb, AnEmptyMapIsADocument) {
  const auto document = document_of(encode_glb(whole({}), {{}, {}, ObjectTitles(), {0, -1, 0}}));
  EXPECT_EQ(document["nodes"].size(), 2u);
  EXPECT_FALSE(document.contains("buffers"));
}

}  // namespace
}  // namespace ovimap
