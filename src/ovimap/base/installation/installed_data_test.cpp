// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/installation/installed_data.h"

#include <gtest/gtest.h>

#include "ovimap/base/temporary_folder_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

TEST(InstalledData, LiesBesideAProgramsFolderOrBesideAModule) {
  const fixture::TemporaryFolder folder;
  const fs::path& prefix = folder.path();
  fs::create_directories(prefix / "share/ovimap/models");
  EXPECT_EQ(data_installed_with(prefix / "bin/ovimap", "models"), prefix / "share/ovimap/models");
  EXPECT_EQ(data_installed_with(prefix / "_ovimap.so", "models"), prefix / "share/ovimap/models");
  EXPECT_EQ(data_installed_with(prefix / "lib/python/ovimap/_ovimap.so", "models"), std::nullopt);
  EXPECT_EQ(data_installed_with(prefix / "bin/ovimap", "furniture"), std::nullopt);
}

TEST(InstalledData, OfAProgramThatIsNotInstalledIsNone) {
  EXPECT_EQ(installed_data("nothing-of-this-name"), std::nullopt);
}

}  // namespace
}  // namespace ovimap
