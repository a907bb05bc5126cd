// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/alignment/map_alignment.h"

#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/pipeline/mapping/sessions_fixture.h"

namespace ovimap {
namespace {

class MapAlignmentTest : public MapFolder {};

TEST_F(MapAlignmentTest, TheTransformIsFound) {
  const MapDocument a = session(0, 0.6), b = session(0.4, 1, elsewhere());
  const MapAlignment found = align_maps(a, b);
  const Pose error = found.a_from_b * elsewhere();
  EXPECT_LT(error.translation().norm(), 0.02);
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.01);
  EXPECT_GT(found.fit, 0.95f);
  EXPECT_GT(found.overlap, 0.5f);
  EXPECT_LT(found.runner_up, found.score() * 0.9f);
}

TEST_F(MapAlignmentTest, TheTransformIsFoundWithoutEmbeddings) {
  MapDocument a = session(0, 0.6), b = session(0.4, 1, elsewhere());
  a.semantics = b.semantics = {};
  const Pose error = align_maps(a, b).a_from_b * elsewhere();
  EXPECT_LT(error.translation().norm(), 0.02);
}

TEST_F(MapAlignmentTest, AnotherPlaceIsRefused) {
  FurnishedRoom other;
  other.things = {furniture(1.2f, -0.2f, {0.9f, 0.5f, 0.7f}, {120, 120, 200}),
                  furniture(-0.6f, -1.2f, {0.2f, 0.7f, 0.9f}, {20, 120, 90}),
                  furniture(0.1f, 1.2f, {1.0f, 0.6f, 0.15f}, {80, 20, 120})};
  other.shell.resize(1);  // and other walls
  other.shell.push_back(
      {{Eigen::Vector3f(1.7f, -1.4f, 0.f), Eigen::Vector3f(1.8f, 0.4f, 0.9f)}, {99, 140, 140}});
  const std::string fault = fault_of([&] { align_maps(session(0, 0.6), map_of(other)); });
  EXPECT_NE(fault.find("cannot be aligned"), std::string::npos) << fault;
  EXPECT_NE(fault.find("--transform"), std::string::npos);
}

TEST_F(MapAlignmentTest, AMapAgreesWithItselfAndNotWithItsTwist) {
  const MapDocument a = session(0, 1);
  const MapAlignment itself = judge_alignment(a, a, Pose::Identity());
  EXPECT_GT(itself.fit, 0.99f);
  EXPECT_GT(itself.overlap, 0.99f);
  const Pose twist(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  EXPECT_LT(judge_alignment(a, a, twist).fit, 0.9f);
}

}  // namespace
}  // namespace ovimap
