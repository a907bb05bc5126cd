// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_semantics.h"

#include <limits>

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/io/map_file/searchable_map.h"
#include "ovimap/io/map_tables/row_words.h"
#include "ovimap/semantics/words/thing_sizes.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

class MapFileSemantics : public MapFolder {};

TEST_F(MapFileSemantics, ASearchNeedsNoVoxels) {
  const MapDocument saved = random_document(5, 1);
  save_map(root_ / "a.ovimap", saved);
  const SearchableMap map = read_searchable_map(root_ / "a.ovimap");
  EXPECT_EQ(map.info.encoder, saved.semantics.encoder);
  ASSERT_EQ(map.embeddings.rows(), 2);
  ASSERT_EQ(map.embeddings.cols(), 3);
  EXPECT_TRUE(map.embeddings.row(0).transpose().isApprox(Eigen::Vector3f(0, 0.6f, -0.8f)));
  EXPECT_EQ(map.embeddings.row(1).norm(), 0.f);  // never seen well enough
}

TEST_F(MapFileSemantics, FusesByTheMapsOwnRule) {
  MapDocument saved = random_document(5, 1);
  auto& views = saved.semantics.looks[1].views;
  views.resize(2);
  views[0].embedding = Eigen::Vector3f(1, 0, 0);
  views[0].visible_px = 300;
  views[1].embedding = Eigen::Vector3f(0, 1, 0);
  views[1].visible_px = 100;
  save_map(root_ / "a.ovimap", saved);
  EXPECT_NEAR(read_searchable_map(root_ / "a.ovimap").embeddings(0, 0), 0.94868f, 1e-5f);
  saved.semantics.views.fusion = FeatureFusion::kMean;
  save_map(root_ / "a.ovimap", saved);
  EXPECT_NEAR(read_searchable_map(root_ / "a.ovimap").embeddings(0, 0), 0.70711f, 1e-5f);
}

TEST_F(MapFileSemantics, TellsWhatIsWrittenWithoutTheViews) {
  MapDocument saved = random_document(5, 1);
  save_map(root_ / "a.ovimap", saved);
  const MapInfo info = read_map_info(root_ / "a.ovimap");
  EXPECT_EQ(info.writing_reader, "reader");
  ASSERT_EQ(info.writing.size(), 1u);
  const auto& lines = info.writing.begin()->second;
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].text, "2");  // the surer first
  EXPECT_EQ(lines[1].text, "EXIT \xC3\xA9");
  EXPECT_EQ(lines[1].box_px.max(), Eigen::Vector2i(2, 2));
  saved.semantics.looks[1].views[0].writing[0].confidence = 2.f;
  save_map(root_ / "b.ovimap", saved);
  EXPECT_THROW(read_map_info(root_ / "b.ovimap"), Error);
}

TEST_F(MapFileSemantics, TellsWhatWasRecognizedWithoutTheViews) {
  MapDocument saved = random_document(5, 1);
  save_map(root_ / "a.ovimap", saved);
  const MapInfo info = read_map_info(root_ / "a.ovimap");
  EXPECT_EQ(info.recognizer, saved.semantics.recognizer);
  ASSERT_EQ(info.things.size(), 1u);
  const Eigen::VectorXf& things = info.things.at(1);
  ASSERT_EQ(things.size(), 3);
  EXPECT_GT(things[0], 2.f);
  EXPECT_LT(things[1], -0.5f);
  EXPECT_NEAR(things[2], 0.f, 1e-6f);
  saved.semantics.looks[1].views[0].things = Eigen::Vector2f(1, 2);
  save_map(root_ / "b.ovimap", saved);
  EXPECT_THROW(read_map_info(root_ / "b.ovimap"), Error);
}

TEST_F(MapFileSemantics, MapsWithoutRecognizerHaveNoTablesForIt) {
  MapDocument saved = random_document(5, 1);
  saved.semantics.recognizer = {};
  for (auto& [label, look] : saved.semantics.looks)
    for (ObjectView& view : look.views) view.things.resize(0);
  save_map(root_ / "a.ovimap", saved);
  EXPECT_EQ(difference(saved, load_map(root_ / "a.ovimap")), "");
  EXPECT_TRUE(read_map_info(root_ / "a.ovimap").things.empty());
}

/// Outlines say the same as the shapes with their surfaces, of which they have none.
void expect_agreeing(const ObjectShapes& shapes) {
  const std::vector<ObjectShape>& whole = shapes.whole();
  const std::vector<ObjectMeasures> measured = measure_objects(whole);
  ASSERT_EQ(whole.size(), shapes.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const ObjectShape& outline = shapes.outline(i);
    EXPECT_EQ(outline.footprint, whole[i].footprint);
    EXPECT_EQ(outline.centroid, whole[i].centroid);
    EXPECT_EQ(outline.bottom_m, whole[i].bottom_m);
    EXPECT_EQ(outline.top_m, whole[i].top_m);
    EXPECT_EQ(standard_measures(shapes.measures()[i]).matrix(),
              standard_measures(measured[i]).matrix());
  }
}

TEST_F(MapFileSemantics, KeepsWhatSurfacesMeasure) {
  const MapDocument saved = random_document(5, 1);
  const fs::path path = root_ / "a.ovimap";
  save_map(path, saved);
  const SearchableMap map = read_searchable_map(path);
  ASSERT_EQ(map.shapes.size(), 2u);
  EXPECT_TRUE(map.shapes.outline(0).surface.empty());
  EXPECT_EQ(map.shapes.whole()[0].surface.size(), saved.surfaces.at(1).size());
  EXPECT_GT(map.shapes.measures()[0].top_share, 0.f);
  EXPECT_LT(map.shapes.measures()[1].top_share, 0.f);  // known by its box alone
  expect_agreeing(map.shapes);
}

TEST_F(MapFileSemantics, FindsTheShapesOfOlderProgramsMaps) {
  const fs::path path = root_ / "a.ovimap";
  save_map(path, random_document(5, 1));
  const SearchableMap kept = read_searchable_map(path);
  {
    SQLite::Database database(path.string(), SQLite::OPEN_READWRITE);
    drop_table(database, map_tables::kObjectShapes);
  }
  const SearchableMap found = read_searchable_map(path);
  ASSERT_EQ(found.shapes.size(), 2u);
  expect_agreeing(found.shapes);
  EXPECT_EQ(found.shapes.outline(0).footprint, kept.shapes.outline(0).footprint);
}

TEST_F(MapFileSemantics, RefusesShapesThatCannotBe) {
  const fs::path path = root_ / "a.ovimap";
  save_map(path, random_document(5, 1));
  const std::vector<InstanceSummary> instances = read_map_info(path).instances;
  const auto fault_of_shapes = [&](InstanceId second, float top_m, float length_m,
                                   const Bytes& footprint) {
    {
      SQLite::Database database(path.string(), SQLite::OPEN_READWRITE);
      drop_table(database, map_tables::kObjectShapes);
      RowWriter rows(database, map_tables::kObjectShapes);
      for (const InstanceId id : {instances[0].id, second})
        rows.insert(id, 0.f, top_m, 0.f, 0.f, 0.f, std::span<const std::uint8_t>(footprint), 1.f,
                    length_m, 1.f, 0.f, 0.5f, 0.5f);
      rows.finish();
    }
    return fault_of([&] { read_searchable_map(path); });
  };
  Bytes triangle, line;
  for (const float coordinate : {0.f, 0.f, 1.f, 0.f, 0.f, 1.f}) append_float(triangle, coordinate);
  for (const float coordinate : {0.f, 0.f, 1.f, 0.f, 2.f, 0.f}) append_float(line, coordinate);
  Bytes endless = triangle;
  append_float(endless, std::numeric_limits<float>::infinity());
  append_float(endless, 0.f);
  const float inf = std::numeric_limits<float>::infinity();
  const InstanceId last = instances[1].id;
  EXPECT_EQ(fault_of_shapes(last, 1.f, 1.f, triangle), "");
  EXPECT_NE(fault_of_shapes(last + 1, 1.f, 1.f, triangle).find("is damaged"), std::string::npos);
  EXPECT_NE(fault_of_shapes(last, inf, 1.f, triangle), "");
  EXPECT_NE(fault_of_shapes(last, 1.f, inf, triangle), "");
  EXPECT_NE(fault_of_shapes(last, 1.f, 1.f, line), "");
  EXPECT_NE(fault_of_shapes(last, 1.f, 1.f, endless), "");
  EXPECT_NE(fault_of_shapes(last, 1.f, 1.f, {}), "");
  EXPECT_NE(fault_of_shapes(last, 1.f, 1.f, Bytes(7)), "");
}

TEST_F(MapFileSemantics, RefusesEmbeddingsThatCannotBe) {
  MapDocument saved = random_document(5, 1);
  saved.semantics.looks[1].views[0].embedding = Eigen::Vector2f(1, 0);
  save_map(root_ / "a.ovimap", saved);
  EXPECT_THROW(load_map(root_ / "a.ovimap"), Error);
  EXPECT_THROW(read_searchable_map(root_ / "a.ovimap"), Error);
}

TEST_F(MapFileSemantics, ReadsMapsOfTheFifthSchemaWhichAreOfOneVisit) {
  const fs::path path = fs::path(OVIMAP_SOURCE_DIR) / "tests/maps/schema5.ovimap";
  const MapDocument map = load_map(path);
  EXPECT_EQ(read_map_info(path).schema, 5);
  EXPECT_EQ(map.instances.size(), 6u);
  EXPECT_EQ(map.frames.size(), 5u);
  EXPECT_TRUE(map.history.visits.empty());
  EXPECT_TRUE(map.history.events.empty());
  save_map(root_ / "new.ovimap", map);
  EXPECT_EQ(read_map_info(root_ / "new.ovimap").schema, kMapSchema);
  EXPECT_EQ(difference(map, load_map(root_ / "new.ovimap")), "");
}

TEST_F(MapFileSemantics, ReadsMapsOfTheFourthSchemaWhoseLooksAreByInstance) {
  const fs::path path = fs::path(OVIMAP_SOURCE_DIR) / "tests/maps/schema4.ovimap";
  const MapDocument map = load_map(path);
  EXPECT_EQ(read_map_info(path).schema, 4);
  // What a search found before it finds now: the stored embeddings are those of the views.
  const SearchableMap stored = read_searchable_map(path);
  EXPECT_GT(stored.embeddings.norm(), 0);
  EXPECT_TRUE(fused_embeddings(map.semantics.looks, map.instances, map.semantics.views.fusion,
                               map.semantics.encoder.dimension)
                  .isApprox(stored.embeddings, 1e-6f));
  InstanceRegistry registry(map.instance_config);
  registry.restore(InstanceRegistry::State(map.registry));
  int with_bins = 0;
  for (const InstanceSummary& instance : map.instances) {
    EXPECT_EQ(registry.record(instance.id).views, instance.views);
    for (const ObjectView* view : appearance_of(map, instance.id).views)
      with_bins += !view->directions.bins.empty();
  }
  EXPECT_GT(with_bins, 0);
  save_map(root_ / "new.ovimap", map);
  EXPECT_EQ(difference(map, load_map(root_ / "new.ovimap")), "");
}

TEST_F(MapFileSemantics, ObjectsOfOldMapsWithoutSuperPointsGetOne) {
  const fs::path path = fs::path(OVIMAP_SOURCE_DIR) / "tests/maps/schema4_embed.ovimap";
  const MapDocument map = load_map(path);
  const SearchableMap stored = read_searchable_map(path);
  ASSERT_FALSE(map.instances.empty());
  for (const InstanceSummary& instance : map.instances) ASSERT_EQ(instance.super_points.size(), 1u);
  EXPECT_GT(stored.embeddings.norm(), 0);
  EXPECT_TRUE(fused_embeddings(map.semantics.looks, map.instances, map.semantics.views.fusion,
                               map.semantics.encoder.dimension)
                  .isApprox(stored.embeddings, 1e-6f));
  save_map(root_ / "new.ovimap", map);
  EXPECT_EQ(difference(map, load_map(root_ / "new.ovimap")), "");
}

TEST_F(MapFileSemantics, ReadsMapsOfTheThirdSchema) {
  const fs::path path = fs::path(OVIMAP_SOURCE_DIR) / "tests/maps/schema3.ovimap";
  const MapDocument map = load_map(path);
  EXPECT_EQ(read_map_info(path).schema, 3);
  EXPECT_FALSE(map.instances.empty());
  EXPECT_FALSE(map.registry.entity_sightings.empty());
  EXPECT_TRUE(map.kept_frames.empty());
  save_map(root_ / "new.ovimap", map);
  EXPECT_EQ(difference(map, load_map(root_ / "new.ovimap")), "");
}

TEST_F(MapFileSemantics, ReadsMapsOfTheSecondSchema) {
  const fs::path path = fs::path(OVIMAP_SOURCE_DIR) / "tests/maps/schema2.ovimap";
  const MapDocument map = load_map(path);
  EXPECT_EQ(read_map_info(path).schema, 2);
  EXPECT_FALSE(map.instances.empty());
  EXPECT_FALSE(map.semantics.looks.empty());
  EXPECT_TRUE(map.registry.entity_sightings.empty());
  EXPECT_EQ(map.instance_config.instances, InstanceReading::kEntityVotes)
      << "a map goes on as it was begun";
  EXPECT_GT(read_searchable_map(path).embeddings.norm(), 0);
  save_map(root_ / "new.ovimap", map);
  EXPECT_EQ(difference(map, load_map(root_ / "new.ovimap")), "");
}

TEST_F(MapFileSemantics, ReadsMapsOfTheFirstSchema) {
  const fs::path path = fs::path(OVIMAP_SOURCE_DIR) / "tests/maps/schema1.ovimap";
  const MapDocument map = load_map(path);
  EXPECT_EQ(map.instances.size(), 3u);
  EXPECT_TRUE(map.semantics.looks.empty());
  EXPECT_EQ(map.semantics.encoder.name, "");
  EXPECT_EQ(read_map_info(path).schema, 1);
  EXPECT_EQ(read_searchable_map(path).embeddings.rows(), 3);
  save_map(root_ / "new.ovimap", map);
  EXPECT_EQ(read_map_info(root_ / "new.ovimap").schema, kMapSchema);
  EXPECT_EQ(difference(map, load_map(root_ / "new.ovimap")), "");
}

}  // namespace
}  // namespace ovimap
