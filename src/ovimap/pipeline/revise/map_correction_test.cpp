// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_correction.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iomanip>
#include <set>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/recording/sequence_fixture.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/mapping/frame_store.h"
#include "ovimap/pipeline/revise/pose_match.h"
#include "ovimap/pipeline/sequence/sequence_run.h"
#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// The desk with poses that drift away by so much a frame.
class DriftingDesk : public DeskScene {
 public:
  explicit DriftingDesk(double drift_m) : drift_m_(drift_m) {}
  FrameRead read(std::int64_t position) const override {
    FrameRead read = DeskScene::read(position);
    read.frame->timestamp_s = 100 + 0.1 * static_cast<double>(position);
    read.frame->world_from_camera.translation() +=
        Eigen::Vector3d(0.6, 0., 0.8) * drift_m_ * static_cast<double>(position);
    return read;
  }

 private:
  double drift_m_;
};

MapperConfig keeping_config() {
  MapperConfig config;
  config.view_interval = 1;
  config.semantics.views.min_mask_px = 20;
  config.semantics.views.min_first_depth_px = config.semantics.views.min_depth_px = 10;
  config.semantics.views.min_frames_seen = 1;
  config.frame_store.max_mb = 100;
  return config;
}

MapDocument map_desk(double drift_m, const MapperConfig& config = keeping_config()) {
  const DriftingDesk desk(drift_m);
  Mapper mapper(config, std::make_shared<DeskMasks>(), std::make_shared<ColorEncoder>());
  const SequenceResult sequence = run_sequence(desk, positions({}, desk.size()), mapper);
  return make_document(std::move(mapper), sequence, {"desk"});
}

std::vector<Pose> true_poses() {
  return poses_of(map_desk(0).frames);
}

using VoxelSet = std::set<std::array<int, 3>>;

/// The surface voxels of each instance.
std::map<InstanceId, VoxelSet> instance_voxels(const MapDocument& document) {
  const VoxelMap& map = document.map;
  const std::vector<InstanceId> instance_of = instances_by_label(map, document.instances);
  std::map<InstanceId, VoxelSet> voxels;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot)
    for (int v = 0; v < kBlockVoxels; ++v) {
      const VoxelBlock& block = map.block(slot);
      if (block.weight[static_cast<std::size_t>(v)] <= 0.f ||
          std::abs(map.distance_m(block, v)) >= map.config().voxel_size_m)
        continue;
      if (const InstanceId id = instance_of[map.label(VoxelRef::of(slot, v))])
        voxels[id].insert({block.index.x() * 8 + (v & 7), block.index.y() * 8 + (v >> 3 & 7),
                           block.index.z() * 8 + (v >> 6)});
    }
  return voxels;
}

double iou(const VoxelSet& a, const VoxelSet& b) {
  std::size_t both = 0;
  for (const auto& voxel : a) both += b.contains(voxel);
  return static_cast<double>(both) / static_cast<double>(a.size() + b.size() - both);
}

/// Of the objects of `truth`, the mean of their best overlaps with those of `map`.
double mean_iou(const MapDocument& truth, const MapDocument& map) {
  const auto expected = instance_voxels(truth), found = instance_voxels(map);
  double sum = 0;
  for (const auto& [id, voxels] : expected) {
    double best = 0;
    for (const auto& [other, candidate] : found) best = std::max(best, iou(voxels, candidate));
    sum += best;
  }
  return sum / static_cast<double>(expected.size());
}

/// Mean distance of the objects' points to the surface of `truth`, metres; what is beyond its band
/// counts as the whole band.
double surface_error_m(const MapDocument& truth, const MapDocument& map) {
  VoxelFinder finder(truth.map);
  double sum = 0;
  std::size_t count = 0;
  for (const auto& [id, points] : map.surfaces)
    for (const Eigen::Vector3f& point : points) {
      const bool known = finder.seek(point) && finder.observed();
      sum += known ? std::abs(finder.distance_m()) : truth.map.config().truncation_m();
      ++count;
    }
  return sum / static_cast<double>(count);
}

std::set<InstanceId> ids_of(const MapDocument& document) {
  std::set<InstanceId> ids;
  for (const InstanceSummary& instance : document.instances) ids.insert(instance.id);
  return ids;
}

TEST(MapCorrection, TruePosesMakeADriftedMapTrue) {
  constexpr double kDrift_m = 0.004;  // 44 mm at the end
  const MapDocument truth = map_desk(0), drifted = map_desk(kDrift_m);
  MapDocument corrected = map_desk(kDrift_m);
  corrected.names = {{1, "table"}};
  const PoseCorrection done = correct_poses(corrected, true_poses(), keeping_config());
  EXPECT_EQ(done.moved, 11u);
  EXPECT_EQ(done.refused, 12u);
  EXPECT_NEAR(done.furthest_m, 11 * kDrift_m, 1e-9);
  EXPECT_NEAR(done.widest_rad, 0, 1e-6);
  EXPECT_LT(mean_iou(truth, drifted), 0.5);
  EXPECT_GT(mean_iou(truth, corrected), 0.85);
  EXPECT_GT(surface_error_m(truth, drifted), 0.006);
  // Distances are those of the nearest voxel's centre, which even the truth is not on.
  EXPECT_NEAR(surface_error_m(truth, corrected), surface_error_m(truth, truth), 0.0005);
  EXPECT_EQ(ids_of(corrected), ids_of(drifted));
  EXPECT_EQ(corrected.names.at(1), "table");
  ASSERT_FALSE(corrected.semantics.looks.empty());
  for (const auto& [id, look] : drifted.semantics.looks)
    for (std::size_t i = 0; i < look.views.size(); ++i)
      EXPECT_EQ(corrected.semantics.looks.at(id).views[i].embedding, look.views[i].embedding);
  for (std::size_t i = 0; i < truth.frames.size(); ++i)
    EXPECT_EQ(corrected.frames[i].world_from_camera.matrix(),
              truth.frames[i].world_from_camera.matrix());
}

TEST(MapCorrection, TheSamePosesChangeLittle) {
  const MapDocument map = map_desk(0);
  MapDocument again = map_desk(0);
  EXPECT_EQ(correct_poses(again, true_poses(), keeping_config()).moved, 0u);
  EXPECT_EQ(again.map.block_count(), map.map.block_count());
  EXPECT_GT(mean_iou(map, again), 0.97) << "depth is kept to a quarter of a millimetre";
}

TEST(MapCorrection, FramesWithoutMasksAreFusedAgainWithoutLabels) {
  const DeskScene desk;
  auto masks = std::make_shared<DeskMasks>();
  masks->masked_every = 4;
  Mapper mapper(keeping_config(), masks);
  const SequenceResult sequence = run_sequence(desk, positions({}, desk.size()), mapper);
  MapDocument map = make_document(std::move(mapper), sequence, {"desk"});
  EXPECT_EQ(map.mask_frames, 3);
  for (const auto& [position, kept] : map.kept_frames)
    EXPECT_EQ(kept->labels.empty(), position % 4 != 0) << position;
  const std::set<InstanceId> ids = ids_of(map);
  correct_poses(map, poses_of(map.frames), keeping_config());
  EXPECT_EQ(ids_of(map), ids);
  EXPECT_EQ(map.mask_frames, 3);
}

TEST(MapCorrection, KeptFramesSurviveTheFile) {
  const fixture::TemporaryFolder folder;
  MapDocument map = map_desk(0.004);
  save_map(folder.path() / "a.ovimap", map);
  MapDocument loaded = load_map(folder.path() / "a.ovimap");
  ASSERT_EQ(loaded.kept_frames.size(), 12u);
  correct_poses(map, true_poses(), keeping_config());
  correct_poses(loaded, true_poses(), keeping_config());
  EXPECT_EQ(map.map.content_hash(), loaded.map.content_hash());
}

TEST(MapCorrection, KeptFramesThatDoNotFitAreRefused) {
  const MapDocument map = map_desk(0.004);
  const auto error_after = [&](auto&& change) {
    MapDocument changed = map_desk(0.004);
    auto frame = std::make_shared<KeptFrame>(*map.kept_frames.at(3));
    change(*frame, changed);
    changed.kept_frames[3] = std::move(frame);
    return error_of([&] { correct_poses(changed, true_poses(), keeping_config()); });
  };
  const Bytes small = encode_png(Image<std::uint16_t>(8, 6, 4000));
  EXPECT_NE(error_after([&](KeptFrame& frame, auto&) {
              frame.depth_png = small;
            }).find("frame 3 cannot be fused again (is 8x6, expected 160x120)"),
            std::string::npos);
  EXPECT_NE(error_after([&](KeptFrame& frame, auto&) {
              frame.segments_png = small;
            }).find("is 8x6, expected 160x120"),
            std::string::npos);
  EXPECT_NE(error_after([](KeptFrame& frame, auto&) {
              frame.color_jpeg = encode_jpeg(RgbImage(8, 6), 90);
            }).find("is 8x6, expected 160x120"),
            std::string::npos);
  EXPECT_NE(error_after([](KeptFrame& frame, auto&) {
              frame.labels.resize(1);
            }).find("but only 1 labels"),
            std::string::npos);
  EXPECT_NE(error_after([](KeptFrame&, MapDocument& changed) {
              changed.depth_camera.fx = 0;
            }).find("which camera"),
            std::string::npos);
}

TEST(MapCorrection, AMapWithoutKeptFramesIsRefused) {
  MapperConfig config = keeping_config();
  config.frame_store.max_mb = 0;
  MapDocument map = map_desk(0, config);
  const std::string fault = error_of([&] { correct_poses(map, true_poses(), config); });
  EXPECT_NE(fault.find("frame_store.max_mb"), std::string::npos);
}

TEST(FrameStore, ThinsWhatItKeepsEvenly) {
  DepthImage depth(320, 240);
  RgbImage color(320, 240);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    depth[i] = 1.f + 0.001f * static_cast<float>(i * i % 977);
    color[i] = {static_cast<std::uint8_t>(i * i % 251), static_cast<std::uint8_t>(i % 241), 9};
  }
  const PinholeCamera camera{320, 240, 300, 300, 160, 120};
  FrameStore store({1, 85});
  for (int i = 0; i < 40; ++i) store.add(2 * i, camera, depth, color, nullptr, {});
  ASSERT_GE(store.frames().size(), 2u);
  ASSERT_LT(store.frames().size(), 40u);
  const std::size_t stride = std::next(store.frames().begin())->first;
  std::size_t expected = 0, bytes = 0;
  for (const auto& [position, frame] : store.frames()) {
    EXPECT_EQ(position, expected);
    expected += stride;
    bytes += frame->depth_png.size() + frame->color_jpeg.size();
  }
  EXPECT_LE(bytes, 1000000u);
  FrameStore again({1, 85});
  again.restore(store.frames(), 40, camera);
  for (FrameStore* one : {&store, &again})
    for (int i = 40; i < 60; ++i) one->add(2 * i, camera, depth, color, nullptr, {});
  ASSERT_EQ(store.frames().size(), again.frames().size());
  EXPECT_EQ(store.frames().rbegin()->first, again.frames().rbegin()->first);
}

TEST(FrameStoreTest, KeepsOnFromWhereItWasTurnedOn) {
  const PinholeCamera camera{32, 24, 30, 30, 16, 12};
  const DepthImage depth(32, 24, 1.f);
  const RgbImage color(32, 24);
  FrameStore before({1, 85});
  before.restore({}, 20, camera);  // of a run that kept none
  for (int i = 20; i < 25; ++i) before.add(i, camera, depth, color, nullptr, {});
  FrameStore store({1, 85});
  store.restore(before.frames(), 25, camera);
  for (int i = 25; i < 45; ++i) store.add(i, camera, depth, color, nullptr, {});
  EXPECT_EQ(store.frames().size(), 25u);
}

TEST(FrameStoreTest, KeepsFramesOfOneCamera) {
  const PinholeCamera small{32, 24, 30, 30, 16, 12}, breathing{32, 24, 30.3f, 30.3f, 16, 12},
      large{64, 48, 60, 60, 32, 24};
  FrameStore store({1, 85});
  store.add(0, small, DepthImage(32, 24, 1.f), RgbImage(32, 24), nullptr, {});
  store.add(1, breathing, DepthImage(32, 24, 1.f), RgbImage(32, 24), nullptr, {});
  EXPECT_EQ(store.frames().size(), 2u);
  store.add(2, large, DepthImage(64, 48, 1.f), RgbImage(64, 48), nullptr, {});
  ASSERT_EQ(store.frames().size(), 1u);
  EXPECT_EQ(store.frames().begin()->first, 2u) << "by its place among all frames";
}

class PoseMatchTest : public ::testing::Test {
 protected:
  /// TUM lines of the true poses, `shift_s` too late, the frames in `left_out` missing.
  fs::path write_tum(double shift_s, std::size_t left_out = 99) const {
    std::ofstream file(folder_.path() / "poses.txt");
    file << std::setprecision(17);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const Eigen::Quaterniond q(poses_[i].linear());
      const Eigen::Vector3d t = poses_[i].translation();
      if (i != left_out)
        file << 100 + 0.1 * static_cast<double>(i) + shift_s << ' ' << t.transpose() << ' ' << q.x()
             << ' ' << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
    }
    return folder_.path() / "poses.txt";
  }

  fs::path write_kitti(std::size_t count) const {
    std::ofstream file(folder_.path() / "poses.txt");
    file << std::setprecision(17);
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < 12; ++k) file << poses_[i % 12].matrix()(k / 4, k % 4) << ' ';
      file << '\n';
    }
    return folder_.path() / "poses.txt";
  }

  void expect_true(const std::vector<Pose>& poses) const {
    ASSERT_EQ(poses.size(), frames_.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
      EXPECT_TRUE(poses[i].isApprox(poses_[i], 1e-9)) << i;
  }

  std::string fault(const fs::path& file) const {
    return fault_of([&] { match_poses(frames_, file, 0.02); });
  }

  const std::vector<FrameLogEntry> frames_ = map_desk(0.004).frames;
  const std::vector<Pose> poses_ = true_poses();
  const fixture::TemporaryFolder folder_;
};

TEST_F(PoseMatchTest, MatchesByTimeByLineAndByNumber) {
  expect_true(match_poses(frames_, write_tum(0.01), 0.02));
  expect_true(match_poses(frames_, write_kitti(12), 0.02));
  expect_true(match_poses(frames_, write_kitti(24), 0.02));
}

TEST_F(PoseMatchTest, NamesTheFrameThatHasNoPose) {
  EXPECT_NE(fault(write_tum(0.03)).find("frame0"), std::string::npos);
  EXPECT_NE(fault(write_tum(0, 7)).find("frame7"), std::string::npos);
  EXPECT_NE(fault(write_kitti(5)).find("frame5"), std::string::npos);
  const fs::path file = write_kitti(12);
  std::ofstream(file, std::ios::app) << "not a pose\n";
  EXPECT_EQ(fault(file), "") << "the frames' own lines are sound";
}

}  // namespace
}  // namespace ovimap
