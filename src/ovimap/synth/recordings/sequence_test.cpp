// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/recordings/sequence.h"

#include <algorithm>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/base/error_fixture.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/camera/small_camera_fixture.h"
#include "ovimap/synth/furniture/furniture_palette.h"

namespace ovimap {
namespace {

using fixture::kSmallCamera;

bool furniture_installed() {
  return std::filesystem::is_directory(default_furniture_folder());
}

std::string fault_without_furniture(const RoomSpec& spec) {
  return fault_of([&] { build_room(spec, "/nowhere"); });
}

TEST(RoomSpecTest, UnknownRoomsAndMissingFurnitureAreSaid) {
  EXPECT_THROW(room_spec("tinny"), Error);
  EXPECT_NE(fault_without_furniture(room_spec("tiny")).find("sweethome3d-furniture"),
            std::string::npos);
  EXPECT_EQ(fault_without_furniture(room_spec("bare")), "");
  RoomSpec spec = room_spec("bare");
  spec.furniture = {{"wall", Placement::kAgainstWall, 1, {}, ""}};
  EXPECT_NE(fault_without_furniture(spec).find("part of every room"), std::string::npos);
}

TEST(SynthSequenceTest, BareRoomIsWalkedSmoothly) {
  const SynthSequence sequence(build_room(room_spec("bare")), kSmallCamera, 40);
  ASSERT_EQ(sequence.size(), 40);
  const auto& poses = sequence.true_poses();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_TRUE(pose_fault(poses[i].matrix()).empty());
    const Eigen::Vector3d eye = poses[i].translation();
    EXPECT_GE(eye.head<2>().minCoeff(), 0.2);
    EXPECT_LE(eye.x(), 3.4);
    EXPECT_LE(eye.y(), 2.9);
    EXPECT_GE(eye.z(), 1.2);
    EXPECT_LE(eye.z(), 1.7);
    if (i == 0) continue;
    EXPECT_LT((eye - poses[i - 1].translation()).norm(), 0.6);
    const Eigen::AngleAxisd turn(poses[i - 1].linear().transpose() * poses[i].linear());
    EXPECT_LT(turn.angle(), 0.6);
  }
}

TEST(SynthSequenceTest, FramesAreTheSameInAnyOrderAndRun) {
  SynthSequenceConfig config;
  config.noise = true;
  const SynthSequence first(build_room(room_spec("bare")), kSmallCamera, 6, config);
  const SynthSequence second(build_room(room_spec("bare")), kSmallCamera, 6, config);
  const Frame late = *first.read(5).frame, early = *first.read(2).frame;
  const Frame again = *second.read(2).frame;
  EXPECT_EQ(early.color, again.color);
  EXPECT_EQ(early.depth, again.depth);
  EXPECT_EQ(first.truth_ids(2), second.truth_ids(2));
  EXPECT_NE(early.color, late.color);
  EXPECT_EQ(late.name, "frame000005");
  EXPECT_TRUE(late.registered());
  EXPECT_FALSE(first.read(6).frame.has_value());
  EXPECT_FALSE(first.truth_ids(-1).has_value());
}

TEST(SynthSequenceTest, NoiseMovesDepthButNotItsMean) {
  SynthSequenceConfig noisy;
  noisy.noise = true;
  const SynthSequence exact(build_room(room_spec("bare")), kSmallCamera, 2);
  const SynthSequence sensed(build_room(room_spec("bare")), kSmallCamera, 2, noisy);
  const DepthImage truth = exact.read(1).frame->depth, depth = sensed.read(1).frame->depth;
  double sum = 0, valid = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (depth[i] > 0) sum += depth[i] - truth[i], ++valid;
  EXPECT_NE(truth, depth);
  EXPECT_GT(valid, 0.7 * static_cast<double>(truth.size()));
  EXPECT_NEAR(sum / valid, 0, 0.01);
}

TEST(SynthSequenceTest, SettingsTellSequencesApart) {
  SynthSequenceConfig noisy;
  noisy.noise = true;
  const auto settings = [](std::uint64_t seed, int frames, const SynthSequenceConfig& config) {
    return SynthSequence(build_room(room_spec("bare", seed)), kSmallCamera, frames, config)
        .settings();
  };
  const std::string plain = settings(1, 2, {});
  EXPECT_NE(plain.find("room: bare\nseed: 1\nframes: 2\n"), std::string::npos);
  EXPECT_EQ(settings(1, 2, {}), plain);
  EXPECT_NE(settings(2, 2, {}), plain);
  EXPECT_NE(settings(1, 3, {}), plain);
  EXPECT_NE(settings(1, 2, noisy), plain);
}

class TinyRoom : public testing::Test {
 protected:
  void SetUp() override {
    if (!furniture_installed())
      GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
    static const SynthSequence* shared =
        new SynthSequence(build_room(room_spec("tiny")), kSmallCamera, 40);
    sequence_ = shared;
  }
  const SynthSequence* sequence_ = nullptr;
};

TEST_F(TinyRoom, HoldsAllItsPiecesAndNoneInAnother) {
  const auto& objects = sequence_->room().objects;
  std::size_t wanted = 6;
  for (const FurnitureRequest& request : room_spec("tiny").furniture)
    wanted += static_cast<std::size_t>(request.count);
  EXPECT_EQ(objects.size(), wanted);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const RoomObject& object = objects[i];
    EXPECT_EQ(object.id, i + 1);
    if (!object.footprint) continue;
    EXPECT_TRUE(object.footprint->inside({3.6f, 3.1f}, -1e-4f)) << object.name;
    EXPECT_LE(object.box.max().z(), 2.5f + 1e-4f) << object.name;
    EXPECT_GE(object.box.min().z(), -1e-4f) << object.name;
    if (object.class_name == "rug") continue;  // furniture stands on it
    for (std::size_t k = 0; k < i; ++k)
      if (objects[k].footprint && objects[k].class_name != "rug") {
        EXPECT_LE(overlap(*object.footprint, *objects[k].footprint), 1e-3f)
            << object.name << " in " << objects[k].name;
      }
  }
}

TEST_F(TinyRoom, EveryInstanceIsSeenFromSeveralSides) {
  std::map<std::uint16_t, std::vector<double>> directions;
  for (std::int64_t i = 0; i < sequence_->size(); ++i) {
    std::map<std::uint16_t, int> pixels;
    const IdImage ids = *sequence_->truth_ids(i);
    for (const std::uint16_t id : ids) ++pixels[id];
    EXPECT_EQ(pixels.count(0), 0u);  // no holes in the room
    for (const auto& [id, count] : pixels) {
      if (count < 3) continue;
      const Eigen::Vector3d middle =
          sequence_->room().objects.at(id - 1u).box.center().cast<double>();
      const Eigen::Vector3d way =
          middle - sequence_->true_poses()[static_cast<std::size_t>(i)].translation();
      directions[id].push_back(std::atan2(way.y(), way.x()) * 180 / std::numbers::pi);
    }
  }
  for (const RoomObject& object : sequence_->room().objects) {
    auto& seen = directions[object.id];
    ASSERT_GE(seen.size(), 1u) << object.name;
    if (object.class_name == "ceiling lamp") continue;  // above the usual gaze
    std::sort(seen.begin(), seen.end());
    double gap = seen.front() + 360 - seen.back();
    for (std::size_t i = 1; i < seen.size(); ++i) gap = std::max(gap, seen[i] - seen[i - 1]);
    if (object.footprint) {
      EXPECT_GE(seen.size(), 4u) << object.name;
      EXPECT_GT(360 - gap, 30) << object.name;
    }
    const bool on_table = object.class_name == "mug" || object.class_name == "book" ||
                          object.class_name == "laptop" || object.class_name == "table" ||
                          object.class_name == "chair";
    if (on_table) {
      EXPECT_GT(360 - gap, 90) << object.name;
    }
  }
}

TEST_F(TinyRoom, TheCameraKeepsClearOfTallFurniture) {
  for (const Pose& pose : sequence_->true_poses())
    for (const RoomObject& object : sequence_->room().objects) {
      if (!object.footprint || object.footprint->top_m < pose.translation().z()) continue;
      if (object.footprint->bottom_m > pose.translation().z()) continue;
      const Eigen::Vector2f eye = pose.translation().head<2>().cast<float>();
      EXPECT_LT(footprint_overlap(*object.footprint, {eye, {0.1f, 0.1f}, 0, 0, 2}), 0)
          << object.name;
    }
}

TEST_F(TinyRoom, IdsAgreeWithGeometry) {
  const Frame frame = *sequence_->read(7).frame;
  const IdImage ids = *sequence_->truth_ids(7);
  for (int y = 0; y < kSmallCamera.height; ++y)
    for (int x = 0; x < kSmallCamera.width; ++x) {
      const Eigen::Vector3d ray((x - kSmallCamera.cx) / kSmallCamera.fx,
                                (y - kSmallCamera.cy) / kSmallCamera.fy, 1);
      const Eigen::Vector3f p =
          (frame.world_from_camera * (static_cast<double>(frame.depth.at(x, y)) * ray))
              .cast<float>();
      const RoomObject& object = sequence_->room().objects.at(ids.at(x, y) - 1u);
      EXPECT_LT(object.box.exteriorDistance(p), 1e-4f) << object.name;
    }
}

TEST_F(TinyRoom, SameSeedSameRoomAndOtherSeedOtherRoom) {
  const SynthRoom again = build_room(room_spec("tiny")), other = build_room(room_spec("tiny", 2));
  const auto& objects = sequence_->room().objects;
  ASSERT_EQ(again.objects.size(), objects.size());
  bool differs = false;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    EXPECT_EQ(again.objects[i].mesh.vertices, objects[i].mesh.vertices);
    if (i < other.objects.size())
      differs |= other.objects[i].mesh.vertices != objects[i].mesh.vertices;
  }
  EXPECT_TRUE(differs);
}

TEST_F(TinyRoom, TruthNamesInstancesAndTheirMakers) {
  const auto instances = sequence_->instances();
  ASSERT_EQ(instances.size(), sequence_->room().objects.size());
  for (const TruthInstance& instance : instances)
    EXPECT_EQ(room_classes().at(instance.class_id - 1), instance.class_name);
  const std::string notice = sequence_->notice();
  for (const RoomObject& object : sequence_->room().objects)
    if (!object.source.empty()) {
      EXPECT_NE(notice.find(object.source), std::string::npos);
    }
  EXPECT_NE(notice.find("Creative Commons"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
