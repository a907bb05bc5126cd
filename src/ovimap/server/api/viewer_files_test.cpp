// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/viewer_files.h"

#include <gtest/gtest.h>

#include "ovimap/io/map_file/map_file_fixture.h"

namespace ovimap {
namespace {

class ViewerFilesTest : public MapFolder {
 protected:
  void write(const std::string& name, const std::string& text) const { scratch_.write(name, text); }
};

TEST_F(ViewerFilesTest, ServesWhatIsInTheFolder) {
  write("viewer/index.html", "<html>");
  write("viewer/assets/a-123.js", "run()");
  write("secret.txt", "no");
  const ViewerFiles files(root_ / "viewer");
  EXPECT_EQ(*files.find("/")->body, "<html>");
  EXPECT_EQ(files.find("/")->headers.at("Cache-Control"), "no-cache");
  EXPECT_NE(files.find("/assets/a-123.js")->headers.at("Cache-Control").find("immutable"),
            std::string::npos);
  EXPECT_EQ(files.find("/assets/a-123.js")->type, "text/javascript; charset=utf-8");
  for (const char* path : {"/../secret.txt", "/assets/../../secret.txt", "//index.html", "",
                           "/assets", "index.html", "/assets/", "/assets/a-123.js/"})
    EXPECT_FALSE(files.find(path)) << path;
}

TEST_F(ViewerFilesTest, SaysHowToGetAViewer) {
  const ViewerFiles none{std::filesystem::path()};
  EXPECT_TRUE(none.empty());
  EXPECT_NE(none.find("/")->body->find("make build"), std::string::npos);
  EXPECT_FALSE(none.find("/index.html"));
  EXPECT_NE(fault_of([&] { ViewerFiles files(root_ / "missing"); }).find("make build"),
            std::string::npos);
}

TEST_F(ViewerFilesTest, IsFoundBesideTheProgram) {
  write("install/bin/ovimap", "");
  EXPECT_EQ(find_viewer(root_ / "install/bin/ovimap"), "");
  write("install/viewer/index.html", "");
  EXPECT_EQ(find_viewer(root_ / "install/bin/ovimap"), root_ / "install/viewer");
  write("install/share/ovimap/viewer/index.html", "");
  EXPECT_EQ(find_viewer(root_ / "install/bin/ovimap"), root_ / "install/share/ovimap/viewer");
}

}  // namespace
}  // namespace ovimap
