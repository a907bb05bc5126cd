// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/alignment/object_layout.h"

#include <random>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// A room of objects by chance: boxes of many sizes, each with a look of its own.
class ChanceRoom {
 public:
  explicit ChanceRoom(unsigned seed, int objects = 12, bool looks = false) : chance_(seed) {
    layout_.encoder.name = looks ? "by chance" : "";
    for (int i = 0; i < objects; ++i) {
      Landmark& landmark = layout_.landmarks.emplace_back();
      landmark.at = {between(-3, 3), between(-3, 3), between(0, 1.5)};
      const auto longest = static_cast<float>(between(0.2, 2)),
                 other = static_cast<float>(between(0.2, 1));
      landmark.sizes_m << longest, longest * other, static_cast<float>(between(0.1, 1.5));
      if (looks) landmark.look = look();
    }
  }

  /// What another map has of it: `kept` of its objects, in another order, in another world whose up
  /// is another as well, each middle off by up to `off_m` and each side by up to a fifth.
  ObjectLayout seen_again(const Pose& there_from_here, int kept, double off_m) {
    ObjectLayout seen = layout_;
    std::shuffle(seen.landmarks.begin(), seen.landmarks.end(), chance_);
    seen.landmarks.resize(static_cast<std::size_t>(kept));
    seen.ground_from_world = Pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()));
    for (Landmark& landmark : seen.landmarks) {
      landmark.at = seen.ground_from_world * (there_from_here * landmark.at);
      for (int axis = 0; axis < 3; ++axis) {
        landmark.at[axis] += between(-off_m, off_m);
        landmark.sizes_m[axis] *= static_cast<float>(between(0.8, 1.2));
      }
    }
    return seen;
  }

  /// From this room's world to another in which its floor is level.
  Pose elsewhere() {
    const Pose turn(Eigen::AngleAxisd(between(-3, 3), Eigen::Vector3d::UnitZ()));
    const Pose shift(Eigen::Translation3d(between(-5, 5), between(-5, 5), between(-1, 1)));
    return Pose(Eigen::AngleAxisd(-0.7, Eigen::Vector3d::UnitX())) * shift * turn;
  }

  const ObjectLayout& layout() const { return layout_; }

 private:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(chance_);
  }
  Eigen::VectorXf look() {
    Eigen::VectorXf result(16);
    for (float& value : result) value = static_cast<float>(between(-1, 1));
    return result.normalized();
  }

  std::mt19937 chance_;
  ObjectLayout layout_;
};

double turn_rad(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd((a.inverse() * b).linear()).angle();
}

/// Of 20 rooms, those whose first proposal is the pose by which half of the objects were moved.
int found_rooms(bool looks, double off_m) {
  int found = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    ChanceRoom room(seed, 12, looks);
    const Pose there_from_here = room.elsewhere();
    const ObjectLayout seen = room.seen_again(there_from_here, 6, off_m);
    const auto proposals = propose_poses(room.layout(), seen);
    if (proposals.empty()) continue;
    const Pose off = proposals.front().a_from_b * there_from_here;
    found += off.translation().norm() < 0.3 && turn_rad(off, Pose::Identity()) < 0.15;
  }
  return found;
}

TEST(ObjectLayout, SizesAndDistancesTellHowMapsLie) {
  EXPECT_EQ(found_rooms(false, 0.0), 20);
  EXPECT_GE(found_rooms(false, 0.05), 18);
}

TEST(ObjectLayout, LooksTellMore) {
  EXPECT_EQ(found_rooms(true, 0.05), 20);
}

TEST(ObjectLayout, ProposalsDifferAndTheLikeliestComeFirst) {
  ChanceRoom room(3);
  const auto proposals = propose_poses(room.layout(), room.layout());
  ASSERT_GT(proposals.size(), 2u);
  EXPECT_EQ(proposals.front().objects, 12);
  EXPECT_LT((proposals.front().a_from_b.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-6);
  for (std::size_t i = 1; i < proposals.size(); ++i)
    EXPECT_LE(proposals[i].votes, proposals[i - 1].votes + 1);
}

TEST(ObjectLayout, PosesAreUpright) {
  ChanceRoom room(5), other(6);
  for (const LayoutProposal& proposal : propose_poses(room.layout(), other.layout())) {
    const Eigen::Vector3d up = proposal.a_from_b.linear() * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(up.z(), 1, 1e-9);
  }
}

/// Objects of which each looks the opposite of another have likenesses of 0.
TEST(ObjectLayout, WhatLooksNothingAlikeProposesNoPose) {
  ChanceRoom room(7, 12, true), other(8, 12, true);
  const auto proposals = propose_poses(room.layout(), other.layout());
  ASSERT_FALSE(proposals.empty());
  for (const LayoutProposal& proposal : proposals) {
    EXPECT_TRUE(proposal.a_from_b.matrix().allFinite());
    EXPECT_GT(proposal.votes, 0);
  }
}

TEST(ObjectLayout, NothingProposesNothing) {
  EXPECT_TRUE(propose_poses({}, ChanceRoom(1).layout()).empty());
  EXPECT_TRUE(propose_poses(ChanceRoom(1).layout(), {}).empty());
  EXPECT_TRUE(propose_poses(ChanceRoom(1, 1).layout(), ChanceRoom(1, 1).layout()).empty())
      << "one object tells no turn";
}

/// A shelf that lies across the world's axes measures the same as one that lies along them.
TEST(ObjectLayout, SizesDoNotDependOnTheWorld) {
  MapRecord map;
  for (const double turn : {0.0, 0.6}) {
    InstanceSummary& instance = map.instances.emplace_back();
    instance.id = static_cast<InstanceId>(map.instances.size());
    const Eigen::Matrix3f rotation =
        Eigen::AngleAxisf(static_cast<float>(turn), Eigen::Vector3f::UnitZ()).matrix();
    for (float x = 0; x < 1.5f; x += 0.05f)
      for (float y = 0; y < 0.4f; y += 0.05f)
        for (float z = 0; z < 0.8f; z += 0.05f) {
          const Eigen::Vector3f point = rotation * Eigen::Vector3f(x, y, z);
          map.surfaces[instance.id].push_back(point);
          instance.box.extend(point);
        }
  }
  const ObjectLayout layout = layout_of(map);
  ASSERT_EQ(layout.landmarks.size(), 2u);
  EXPECT_LT((layout.landmarks[0].sizes_m - layout.landmarks[1].sizes_m).norm(), 0.03f);
  EXPECT_NEAR(layout.landmarks[1].sizes_m.x(), 1.45f, 0.1f);
}

}  // namespace
}  // namespace ovimap
