// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/synth/furniture/archive_fixture.h"
#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/furniture/furniture_model.h"
#include "ovimap/synth/furniture/furniture_palette.h"
#include "ovimap/synth/furniture/zip_archive.h"
#include "ovimap/synth/shapes/mesh_parts.h"

namespace ovimap {
namespace {

class Furniture : public testing::Test {
 protected:
  Furniture() { fixture::write_wedge_library(folder_.path()); }
  fixture::TemporaryFolder folder_;
};

TEST_F(Furniture, CatalogueListsModelsWithTheirSizesAndMakers) {
  const FurnitureCatalog catalog(folder_.path());
  ASSERT_EQ(catalog.entries().size(), 1u);  // the other entry has no model
  const FurnitureEntry& entry = catalog.find("Test/wedge");
  EXPECT_EQ(entry.name,
            "W\xc3\xa9"
            "dge");
  EXPECT_EQ(entry.creator, "Caf\xc3\xa9");
  EXPECT_EQ(entry.category, "Shapes");
  EXPECT_EQ(entry.license, "CC0");
  EXPECT_TRUE(entry.size_m.isApprox(Eigen::Vector3f(1, 0.6f, 0.8f)));
}

TEST(FurnitureProperties, OddLinesAreHarmless) {
  const auto entries = parse_furniture_properties(
      "name#1=20 \\u20ac \\uZZ00 \\u2\nmodel#1=/a/b.obj\nwidth#1=10\ndepth#1=x\nheight#1=5\n"
      "name#2=bill 5\\u20ac\nmodel#2=/a/c.obj\nwidth#2=10\ndepth#2=20\nheight#2=5\n=\nnonsense\n",
      "/lib/Odd.sh3f");
  ASSERT_EQ(entries.size(), 1u);  // the first has no depth
  EXPECT_EQ(entries[0].name, "bill 5\xe2\x82\xac");
  EXPECT_EQ(entries[0].id, "Odd/c");
}

TEST_F(Furniture, MissingPackageAndWrongNamesAreSaid) {
  const auto nowhere = error_of([&] { FurnitureCatalog(folder_.path() / "nowhere"); });
  EXPECT_NE(nowhere.find("install the Debian package sweethome3d-furniture"), std::string::npos);
  const FurnitureCatalog catalog(folder_.path());
  EXPECT_NE(error_of([&] { catalog.find("Test/wedgie"); }).find("did you mean 'Test/wedge'"),
            std::string::npos);
  EXPECT_NE(error_of([&] { room_class_id("sofaa"); }).find("did you mean 'sofa'"),
            std::string::npos);
  write_text(folder_.path() / "Broken.sh3f", "no zip");
  EXPECT_NE(error_of([&] { FurnitureCatalog(folder_.path()); }).find("Broken.sh3f"),
            std::string::npos);
}

TEST_F(Furniture, ModelStandsUprightAtItsSizeWithItsTexture) {
  const FurnitureCatalog catalog(folder_.path());
  const TexturedMesh mesh = load_furniture_model(catalog.find("Test/wedge"));
  // The glass tip takes the upper half of the catalogue's height, and is left out itself.
  const Eigen::AlignedBox3f box = bounds(mesh);
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3f(-0.5f, -0.3f, 0), 1e-5f)) << box.min().transpose();
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3f(0.5f, 0.3f, 0.4f), 1e-5f))
      << box.max().transpose();
  EXPECT_EQ(mesh.triangles.size(), 6u);  // three quads; the face of two corners is dropped
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    if (vertex.z() > 0.3f) {
      EXPECT_NEAR(vertex.y(), 0.3f, 1e-5f);  // the back is high: the front is -y
    }
  bool textured = false, fallback = false;
  for (const std::uint32_t index : mesh.triangle_materials) {
    const SurfaceMaterial& material = mesh.materials[index];
    textured |= material.texture && material.texture->sample({0.5f, 0.5f}, 1).x() > 0.5f;
    fallback |= !material.texture && material.albedo.isApprox(Eigen::Vector3f::Ones());
  }
  EXPECT_TRUE(textured);
  EXPECT_TRUE(fallback);
}

TEST_F(Furniture, DamagedEntriesAreErrors) {
  const std::filesystem::path file = folder_.path() / "Test.sh3f";
  Bytes bytes = read_file(file);
  const std::string text(bytes.begin(), bytes.end());
  bytes[text.find("mtllib")] ^= 1;
  write_file(file, bytes);
  const ZipArchive archive(file);
  EXPECT_NE(error_of([&] { (void)archive.read("models/wedge/wedge.obj"); }).find("is damaged"),
            std::string::npos);
  EXPECT_FALSE(archive.read("models/none.obj").has_value());
}

TEST(FurniturePalette, EveryModelIsInTheInstalledCatalogue) {
  if (!std::filesystem::is_directory(default_furniture_folder()))
    GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
  const FurnitureCatalog catalog;
  EXPECT_GE(catalog.entries().size(), 800u);
  for (const std::string& name : room_classes())
    for (const std::string& model : models_of_class(name)) {
      const FurnitureEntry& entry = catalog.find(model);
      EXPECT_GT(entry.size_m.minCoeff(), 0) << model;
      EXPECT_LT(entry.size_m.maxCoeff(), 3) << model;
      EXPECT_FALSE(entry.creator.empty()) << model;
    }
}

}  // namespace
}  // namespace ovimap
