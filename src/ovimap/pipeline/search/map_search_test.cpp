// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/map_search.h"

#include <gtest/gtest.h>

#include "ovimap/inference/models/model_folder.h"
#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/io/pictures/palette.h"

namespace ovimap {
namespace {

class MapSearchTest : public MapFolder {
 protected:
  MapSearchTest() {
    document_ = random_document(6, 1);
    document_.up = Eigen::Vector3f::UnitZ();
    save_map(root_ / "a.ovimap", document_);
  }

  MapDocument document_;
};

TEST_F(MapSearchTest, KeepsTheOrderOfTheInstances) {
  const MapSearch search = open_map_search(root_ / "a.ovimap");
  ASSERT_EQ(search.index.size(), document_.instances.size());
  for (std::size_t i = 0; i < search.index.size(); ++i) {
    EXPECT_EQ(search.index.object(i).id, document_.instances[i].id);
    EXPECT_EQ(search.index.object(i).points, document_.instances[i].points);
  }
  EXPECT_EQ(search.index.object(0).name, document_.names.at(1));
  EXPECT_TRUE(search.index.has_embedding(0));
  EXPECT_FALSE(search.index.has_embedding(1));
  EXPECT_EQ(search.info.encoder.name, "colours");
}

TEST_F(MapSearchTest, TakesSurfacesWhereTheMapHasThem) {
  const MapSearch search = open_map_search(root_ / "a.ovimap");
  ASSERT_EQ(search.scene.shapes.size(), 2u);
  EXPECT_FALSE(search.scene.shapes.whole()[0].surface.empty());
  EXPECT_TRUE(search.scene.shapes.whole()[1].surface.empty());
  EXPECT_NEAR(search.scene.shapes.whole()[0].top_m, 0.1f, 0.02f);
}

TEST_F(MapSearchTest, RefusesMissingMaps) {
  EXPECT_NE(fault_of([&] { open_map_search(root_ / "none.ovimap"); }), "");
}

TEST_F(MapSearchTest, WithoutEncoderThereIsNothingToCompare) {
  const MapSearch search = open_map_search(root_ / "a.ovimap");
  EXPECT_EQ(encoder_of_map(search.info.encoder, "none", {}), nullptr);
}

TEST_F(MapSearchTest, RefusesAnotherEncoder) {
  const auto models = list_models(model_search_path({OVIMAP_SOURCE_DIR "/.models"}));
  const auto model = std::find_if(models.begin(), models.end(),
                                  [](const auto& m) { return m.kind == "dual_encoder"; });
  if (model == models.end()) GTEST_SKIP() << "no encoder; run tools/setup.sh";
  const MapSearch search = open_map_search(root_ / "a.ovimap");
  const std::string fault =
      fault_of([&] { encoder_of_map(search.info.encoder, model->folder.string(), {}); });
  EXPECT_NE(fault.find("colours"), std::string::npos) << fault;
  EXPECT_NE(fault.find("reembed"), std::string::npos) << fault;
}

TEST_F(MapSearchTest, ColoursObjectsByRelevance) {
  const MapSearch search = open_map_search(root_ / "a.ovimap");
  Mesh mesh;
  mesh.vertices.assign(3, Eigen::Vector3f::Zero());
  mesh.labels = {1, 3, 0};
  color_by_relevance(mesh, search.index, Eigen::Vector2f(0.9f, 0.2f));
  const auto expected = [](float share) {
    const Rgb8 color = heat_color(share);
    return std::array<std::uint8_t, 3>{color.r, color.g, color.b};
  };
  ASSERT_EQ(mesh.colors.size(), 3u);
  EXPECT_EQ(mesh.colors[0], expected(0.9f));
  EXPECT_EQ(mesh.colors[1], expected(0.2f));
  EXPECT_EQ(mesh.colors[2], expected(0.f));
}

}  // namespace
}  // namespace ovimap
