// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/geometry_embedding.h"

#include <gtest/gtest.h>

#include "ovimap/instance/instance_mesh.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

/// The desk's surface, with the instance ids of a map of it.
Mesh desk_mesh() {
  const DeskScene scene;
  Mapper mapper({}, std::make_shared<DeskMasks>());
  const SequenceResult result = run_sequence(scene, positions({}, scene.size()), mapper);
  const MapDocument document = make_document(std::move(mapper), result, {"desk"});
  return extract_instance_mesh(document.map, document.instances);
}

GeometryEmbeddingConfig geometry_config() {
  GeometryEmbeddingConfig config;
  config.semantics.views.min_mask_px = 60;
  config.semantics.views.min_first_depth_px = 40;
  config.semantics.crops.background_level = 0;
  return config;
}

TEST(EmbedGeometry, FindsTheObjectsOfAGivenMesh) {
  const Mesh mesh = desk_mesh();
  const DeskScene scene;
  SequenceResult sequence;
  const MapDocument document =
      embed_geometry(mesh, scene, positions({}, scene.size()), geometry_config(),
                     std::make_shared<ColorEncoder>(), sequence);
  ASSERT_EQ(document.instances.size(), 3u);
  EXPECT_EQ(document.semantics.encoder.name, "colours");
  EXPECT_EQ(document.frames.size(), static_cast<std::size_t>(DeskScene::kFrames));
  EXPECT_GT(document.up.z(), 0.99f);
  const Embeddings rows = fused_embeddings(document.semantics.looks, document.instances,
                                           FeatureFusion::kPixelWeighted, 3);
  Eigen::Index red = 0, blue = 0;
  rows.col(0).maxCoeff(&red);
  rows.col(2).maxCoeff(&blue);
  const auto near = [&](Eigen::Index row, const Eigen::Vector3f& place) {
    return (document.instances[static_cast<std::size_t>(row)].box.center() - place).norm() < 0.05f;
  };
  EXPECT_TRUE(near(red, {0.15f, 0.f, 0.1f}));
  EXPECT_TRUE(near(blue, {-0.2f, 0.1f, 0.12f}));
}

TEST(EmbedGeometry, DoesNotSeeThroughWhatIsMeasuredInFront) {
  Mesh mesh = desk_mesh();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.z() -= 1.f;  // all below the real table
  const DeskScene scene;
  SequenceResult sequence;
  const MapDocument document = embed_geometry(mesh, scene, positions({}, scene.size()),
                                              geometry_config(), nullptr, sequence);
  EXPECT_TRUE(document.semantics.looks.empty());
}

TEST(EmbedGeometry, SaysWhatTheGeometryLacks) {
  const DeskScene scene;
  SequenceResult sequence;
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THROW(embed_geometry(mesh, scene, {0}, {}, nullptr, sequence), Error);
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW(embed_geometry(mesh, scene, {0}, {}, nullptr, sequence), Error);
  mesh.labels = {0, 0, 0};
  EXPECT_THROW(embed_geometry(mesh, scene, {0}, {}, nullptr, sequence), Error);
  mesh.labels = {1, 1, 1};
  EXPECT_THROW(embed_geometry(mesh, scene, {}, {}, nullptr, sequence), Error);
  EXPECT_NO_THROW(embed_geometry(mesh, scene, {0}, {}, nullptr, sequence));
}

}  // namespace
}  // namespace ovimap
