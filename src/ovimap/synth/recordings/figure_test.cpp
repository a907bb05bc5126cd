// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/recordings/figure.h"

#include <gtest/gtest.h>

#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/recordings/sequence.h"

namespace ovimap {
namespace {

const PinholeCamera kFigureCamera{80, 60, 60, 60, 39.5f, 29.5f};

SynthSequenceConfig with_figure() {
  SynthSequenceConfig config;
  config.figure.enabled = true;
  return config;
}

TEST(FigureTest, WalksOnTheFloorAtItsPaceAndFacesWhereItGoes) {
  const SynthRoom room = build_room(room_spec("bare"));
  const FigureConfig config;
  const Figure figure(room, config, {}, 7);
  for (int i = 0; i < 100; ++i) {
    const Pose now = figure.at(0.1 * i).world_from_thing,
               next = figure.at(0.1 * i + 0.1).world_from_thing;
    EXPECT_EQ(now.translation().z(), 0);
    EXPECT_GT(now.translation().head<2>().minCoeff(), 0.2) << "clear of the walls";
    const Eigen::Vector3d step = next.translation() - now.translation();
    EXPECT_LT(step.norm(), 0.085);
    EXPECT_GT(now.linear().col(0).dot(step), 0) << "no step backwards at " << i;
  }
}

TEST(FigureTest, IsInDepthAndIdsAloneWhereItStands) {
  const SynthSequence still(build_room(room_spec("bare")), kFigureCamera, 12),
      lived(build_room(room_spec("bare")), kFigureCamera, 12, with_figure());
  const std::vector<std::uint32_t> moving = lived.moving();
  ASSERT_EQ(moving.size(), 2u);
  EXPECT_TRUE(still.moving().empty());
  int shown = 0;
  for (int position = 0; position < 12; ++position) {
    const Frame without = *still.read(position).frame, with = *lived.read(position).frame;
    const IdImage ids = *lived.truth_ids(position);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const bool moves = ids[i] == moving[0] || ids[i] == moving[1];
      shown += moves;
      if (moves)
        EXPECT_LT(with.depth[i], without.depth[i]);
      else
        EXPECT_EQ(with.depth[i], without.depth[i]);
    }
  }
  EXPECT_GT(shown, 300);
}

TEST(FigureTest, TruthKnowsItAndItsSurfaceIsNoneOfTheRoom) {
  const SynthSequence still(build_room(room_spec("bare")), kFigureCamera, 3),
      lived(build_room(room_spec("bare")), kFigureCamera, 3, with_figure());
  EXPECT_EQ(lived.instances().size(), still.instances().size() + 2);
  EXPECT_EQ(lived.instances()[lived.instances().size() - 2].class_name, "person");
  EXPECT_EQ(lived.truth_mesh().vertices, still.truth_mesh().vertices);
  EXPECT_EQ(still.settings().find("figure"), std::string::npos);
  EXPECT_NE(lived.settings().find("figure.speed_mps: 0.8"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
