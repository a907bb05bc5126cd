// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/exports/instance_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace ovimap {
namespace {

InstanceSummary cup() {
  InstanceSummary instance;
  instance.id = 7;
  instance.box =
      Eigen::AlignedBox3f(Eigen::Vector3f(-0.1f, 0.2f, 0.f), Eigen::Vector3f(0.3f, 0.4f, 0.5f));
  instance.centroid = {0.1f, 0.3f, 0.25f};
  instance.points = 1234;
  instance.views = 9;
  instance.super_points = {2, 5};
  return instance;
}

/// The one instance in a map's JSON, as it is written.
nlohmann::ordered_json written(const InstanceSummary& instance, const ObjectTitles& titles = {}) {
  MapInfo info;
  info.instances = {instance};
  info.names = titles.names;
  return nlohmann::ordered_json::parse(info_json("a.ovimap", info, titles.labels))
      .at("instances")
      .at(0);
}

TEST(InstanceJson, WritesAnInstance) {
  EXPECT_EQ(
      written(cup(), {{{7, "cup"}}, {{7, "mug"}}}).dump(),
      R"({"id":7,"name":"cup","label":"mug","box":{"min":[-0.1,0.2,0.0],"max":[0.3,0.4,0.5]},)"
      R"("centroid":[0.1,0.3,0.25],"points":1234,"views":9,"superpoints":[2,5]})");
}

TEST(InstanceJson, WritesWhatIsMissing) {
  InstanceSummary empty;
  empty.id = 1;
  const auto entry = written(empty, {{{2, "other"}}, {{2, "chair"}}});
  EXPECT_EQ(entry.at("name"), "");
  EXPECT_EQ(entry.at("label"), "");
  EXPECT_TRUE(entry.at("superpoints").is_array() && entry.at("superpoints").empty());
  const auto nothing = nlohmann::json::parse(info_json("a.ovimap", MapInfo()));
  EXPECT_EQ(nothing.at("instances").dump(), "[]");
}

TEST(InstanceJson, AnyNameMakesValidJson) {
  EXPECT_EQ(written(cup(), {{{7, "a\"\n\x01\xff\\"}}, {}}).at("name"), "a\"\n\x01\xef\xbf\xbd\\");
}

TEST(InstanceJson, NumbersThatAreNoneAreNull) {
  InstanceSummary instance = cup();
  instance.box.setEmpty();
  instance.centroid.x() = std::numeric_limits<float>::infinity();
  const auto entry = written(instance);
  EXPECT_TRUE(entry.at("centroid").at(0).is_null());
  EXPECT_EQ(entry.at("centroid").at(1), 0.3);
}

TEST(InstanceJson, DescribesAMap) {
  MapInfo info;
  info.frames = 200;
  info.mask_frames = 20;
  info.instances = {cup()};
  info.voxel_size_m = 0.01f;
  info.blocks = 12000;
  info.size_bytes = 5000000000;
  info.content_hash = 0x00c0ffee;
  info.source = "kitchen";
  const auto document = nlohmann::json::parse(info_json("a b.ovimap", info));
  EXPECT_EQ(document.at("map"), "a b.ovimap");
  EXPECT_EQ(document.at("schema"), kMapSchema);
  EXPECT_EQ(document.at("frames"), 200);
  EXPECT_EQ(document.at("mask_frames"), 20);
  EXPECT_EQ(document.at("instances").at(0).at("id"), 7);
  EXPECT_EQ(document.at("voxel_size_m"), 0.01);
  EXPECT_EQ(document.at("blocks"), 12000);
  EXPECT_EQ(document.at("size_bytes"), 5000000000);
  EXPECT_EQ(document.at("content_hash"), "0000000000c0ffee");
  EXPECT_EQ(document.at("source"), "kitchen");
}

}  // namespace
}  // namespace ovimap
