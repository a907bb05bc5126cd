// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/mapper_config.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/io/settings/config_file.h"

namespace ovimap {
namespace {

class LoadConfigTest : public ::testing::Test {
 protected:
  LoadConfigTest() { list_fields(config_, fields_); }

  std::string load(const std::string& text) {
    folder_.write("config.yaml", text);
    return fault_of([&] { load_config(folder_.path() / "config.yaml", fields_); });
  }

  const fixture::TemporaryFolder folder_;
  MapperConfig config_;
  ConfigFields fields_;
};

TEST_F(LoadConfigTest, TakesNestedAndDottedKeys) {
  EXPECT_EQ(load("map:\n  voxel_size_m: 0.02\nassociation.association: argmax\n"), "");
  EXPECT_EQ(config_.map.voxel_size_m, 0.02f);
  EXPECT_EQ(config_.association.association, AssociationRule::kArgmax);
}

TEST_F(LoadConfigTest, ItsOwnDumpReadsBack) {
  config_.mask_interval = 7;
  const std::string dump = fields_.dump();
  config_.mask_interval = 1;
  EXPECT_EQ(load(dump), "");
  EXPECT_EQ(config_.mask_interval, 7);
}

TEST_F(LoadConfigTest, NamesWhatIsWrong) {
  EXPECT_NE(load("map:\n  voxelsize: 1\n").find("did you mean 'map.voxel_size_m'"),
            std::string::npos);
  EXPECT_NE(load("mask_interval: [1, 2]\n").find("must be one value"), std::string::npos);
  EXPECT_NE(load("hello").find("name: value"), std::string::npos);
  EXPECT_THROW(load_config(folder_.path(), fields_), Error) << "a folder";
  EXPECT_NE(load("a: {").find("is not YAML"), std::string::npos);
  EXPECT_NE(load("a: &a {b: *a}").find("aliases"), std::string::npos) << "it contains itself";
  EXPECT_THROW(load_config("/nowhere/x.yaml", fields_), Error);
}

/// Every value of the preset that docs/reference-preset.md names, as the settings have them.
TEST(MapperPreset, ReferenceIsWhatTheReleasedCodeDoes) {
  MapperConfig config = mapper_preset("reference");
  ConfigFields fields;
  list_fields(config, fields);
  const std::map<std::string, std::string> released = {
      {"segment.min_region_px", "500"},
      {"segment.regrow_px", "4"},
      {"mask_fusion.min_region_px", "100"},
      {"mask_fusion.min_entity_px", "100000000"},
      {"mask_fusion.split_core_px", "100000000"},
      {"association.association", "one_to_one"},
      {"association.assoc_min_votes", "20"},
      {"association.assoc_min_share", "0"},
      {"association.merge_min_points", "1000"},
      {"instance.instances", "entity_votes"},
      {"instance.merge_min_count", "10"},
      {"free_space.enabled", "false"},
      {"motion.mode", "off"},
      {"depth.enabled", "false"},
      {"map.truncation_voxels", "5"},
      {"map.max_weight", "10000"},
      {"map.label_band_voxels", "5"},
      {"map.pixel_votes", "false"},
      {"summary.min_instance_voxels", "1"},
      {"summary.min_instance_views", "1"},
      {"summary.min_confidence", "0"},
      {"mask_interval", "0"},
      {"mask_motion", "0"},
      {"view_interval", "1"},
      {"views.strategy", "combine"},
      {"views.grid_px_per_bin", "8"},
      {"views.min_mask_px", "1000"},
      {"views.min_first_depth_px", "500"},
      {"views.min_depth_px", "100"},
      {"views.top_views", "10"},
      {"views.better_ratio", "0"},
      {"views.recentre_share", "0"},
      {"views.min_frames_seen", "0"},
      {"views.fusion", "pixel_weighted"},
      {"views.fused_views", "8"},
      {"telling.sharp_edge_px", "0"},
      {"crops.scales", "3"},
      {"crops.masked", "true"},
      {"crops.background_level", "0"},
  };
  std::size_t found = 0;
  for (const ConfigField& field : fields.fields()) {
    const auto value = released.find(field.name);
    if (value == released.end()) continue;
    EXPECT_EQ(field.get(), value->second) << field.name;
    ++found;
  }
  EXPECT_EQ(found, released.size()) << "a setting has another name";
  EXPECT_FLOAT_EQ(config.map.voxel_size_m, 0.01f);
  EXPECT_FLOAT_EQ(config.map.min_mesh_weight, 1e-4f);
  EXPECT_FLOAT_EQ(config.segment.surface.discontinuity_ratio, 0.01f);
  EXPECT_NEAR(config.segment.concave_angle_rad, std::acos(0.97f), 1e-3f);
  EXPECT_FLOAT_EQ(config.segment.regrow_m, 0.05f);
  EXPECT_FLOAT_EQ(config.semantics.views.theta_novel, 0.1f);
  EXPECT_FLOAT_EQ(config.semantics.crops.padding_step, 0.1f);
  EXPECT_FLOAT_EQ(config.association.merge_min_share, 0.15f);
  EXPECT_FLOAT_EQ(config.instance.min_vote_share, 0.1f);
  EXPECT_FLOAT_EQ(config.mask_fusion.split_entity_share, 0.9f);
  EXPECT_FLOAT_EQ(config.mask_fusion.split_region_share, 0.5f);
  EXPECT_FLOAT_EQ(config.mask_fusion.adopt_region_share, 0.2f);
}

TEST(MapperPreset, KnowsItsNames) {
  EXPECT_EQ(mapper_preset("default").mask_motion, 0.1f);
  EXPECT_THROW(mapper_preset("fastest"), Error);
}

}  // namespace
}  // namespace ovimap
