// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapper_config.h"

#include <unistd.h>

#include <fstream>

#include <gtest/gtest.h>

#include "ovimap/io/config_file.h"

namespace ovimap {
namespace {

class LoadConfigTest : public ::testing::Test {
 protected:
  LoadConfigTest()
      : path_(std::filesystem::temp_directory_path() /
              ("ovimap-config-" + std::to_string(getpid()) + ".yaml")) {
    list_fields(config_, fields_);
  }
  ~LoadConfigTest() override { std::filesystem::remove(path_); }

  std::string load(const std::string& text) {
    std::ofstream(path_) << text;
    try {
      load_config(path_, fields_);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  std::filesystem::path path_;
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
  EXPECT_THROW(load_config(std::filesystem::temp_directory_path(), fields_), Error) << "a folder";
  EXPECT_NE(load("a: {").find("not valid YAML"), std::string::npos);
  EXPECT_THROW(load_config("/nowhere/x.yaml", fields_), Error);
}

TEST(MapperPreset, KnowsItsNames) {
  EXPECT_EQ(mapper_preset("reference").segment.min_region_px, 500);
  EXPECT_THROW(mapper_preset("fastest"), Error);
}

}  // namespace
}  // namespace ovimap
