// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/truth/replica_pack.h"

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/recording/sequence_fixture.h"
#include "ovimap/io/truth/truth.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// A ramp of depth under a moving camera; counts how often it is asked.
class RampSource final : public FrameSource {
 public:
  explicit RampSource(std::int64_t size, bool registered = true)
      : size_(size), registered_(registered) {}
  std::string kind() const override { return "ramp"; }
  std::int64_t size() const override { return size_; }
  FrameRead read(std::int64_t position) const override {
    ++reads;
    Frame frame;
    frame.index = position;
    frame.timestamp_s = 0.1 * static_cast<double>(position);
    frame.depth_camera = frame.color_camera = {32, 24, 30, 30, 15.5f, 11.5f};
    if (!registered_) frame.color_camera.fx = 31;
    frame.color = RgbImage(32, 24, {90, 120, static_cast<std::uint8_t>(10 * position)});
    frame.depth = DepthImage(32, 24);
    for (int x = 1; x < 32; ++x) frame.depth.at(x, 5) = 0.3f * static_cast<float>(x);
    frame.world_from_camera.translation() =
        Eigen::Vector3d(0.1 * static_cast<double>(position), 1.0 / 3, 2);
    return {frame, {}};
  }
  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    return IdImage(32, 24, static_cast<std::uint16_t>(300 + position));
  }
  mutable int reads = 0;

 private:
  std::int64_t size_;
  bool registered_;
};

class ReplicaPackTest : public testing::Test {
 protected:
  ReplicaPack pack(const FrameSource& source) const {
    ReplicaPack made;
    made.scene = "den";
    made.frames = &source;
    made.truth.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    made.truth.triangles = {{0, 1, 2}};
    made.truth.labels = {12, 12, 7};
    made.instances = {{12, 9, "sofa"}, {7, 1, "wall"}};
    made.notice = "# Notice\n";
    made.settings = "seed: 1\n";
    return made;
  }
  std::string fault(const ReplicaPack& made) const {
    return fault_of([&] { write_replica_pack(folder_.path(), made); });
  }
  fixture::TemporaryFolder folder_;
};

TEST_F(ReplicaPackTest, ReadersGiveBackWhatWasWritten) {
  const RampSource source(3);
  std::vector<std::int64_t> done;
  write_replica_pack(folder_.path(), pack(source), {}, [&](std::int64_t i, std::int64_t total) {
    done.push_back(i);
    EXPECT_EQ(total, 3);
  });
  EXPECT_EQ(done, (std::vector<std::int64_t>{1, 2, 3}));

  const auto read = open_frame_source(folder_.path() / "den");
  EXPECT_EQ(read->kind(), "replica");
  ASSERT_EQ(read->size(), 3);
  const Frame written = *source.read(2).frame, back = *read->read(2).frame;
  EXPECT_EQ(back.depth_camera, written.depth_camera);
  EXPECT_TRUE(back.world_from_camera.isApprox(written.world_from_camera, 1e-15));
  EXPECT_NEAR(back.color.at(3, 3).g, 120, 3);
  for (std::size_t i = 0; i < written.depth.size(); ++i)
    EXPECT_NEAR(back.depth[i], written.depth[i], 0.5001 / 6553.5);
  EXPECT_EQ(read->truth_ids(2), source.truth_ids(2));
}

TEST_F(ReplicaPackTest, TruthComesBackWithItsNames) {
  const RampSource source(1);
  write_replica_pack(folder_.path(), pack(source));
  const Truth truth = load_truth(folder_.path() / "den");
  EXPECT_EQ(truth.instances, (std::vector<std::int32_t>{12, 12, 7}));
  EXPECT_EQ(truth.classes, (std::vector<std::int32_t>{9, 9, 1}));
  EXPECT_EQ(truth.instance_names.at(12), "sofa");
  EXPECT_EQ(truth.class_names.at(1), "wall");
  EXPECT_TRUE(fs::exists(folder_.path() / "den" / "NOTICE.md"));
}

TEST_F(ReplicaPackTest, ABrokenOffRunGoesOnWhereItStopped) {
  const RampSource first(2), all(4);
  write_replica_pack(folder_.path(), pack(first));
  write_replica_pack(folder_.path(), pack(all));
  EXPECT_EQ(all.reads, 2);
  fs::remove(folder_.path() / "den" / "results" / "depth000001.png");
  fs::remove(folder_.path() / "den" / "results" / "instance000003.png");
  write_replica_pack(folder_.path(), pack(all));
  EXPECT_EQ(all.reads, 4);
  const auto read = open_frame_source(folder_.path() / "den");
  for (std::int64_t i = 0; i < 4; ++i)
    EXPECT_TRUE(
        read->read(i).frame->world_from_camera.isApprox(all.read(i).frame->world_from_camera))
        << i;
}

TEST_F(ReplicaPackTest, RoomsAreNamedWhereThereAreSeveral) {
  const RampSource source(1);
  ReplicaPack made = pack(source);
  const auto labels = [&] {
    const Bytes bytes = read_file(folder_.path() / "den" / "labels.json");
    return std::string(bytes.begin(), bytes.end());
  };
  write_replica_pack(folder_.path(), made);
  EXPECT_EQ(labels().find("rooms"), std::string::npos);
  made.instances[0].room = "attic";
  write_replica_pack(folder_.path(), made);
  EXPECT_NE(labels().find("\"rooms\": {\n  \"12\": \"attic\""), std::string::npos) << labels();
  EXPECT_EQ(load_truth(folder_.path() / "den").instance_names.at(12), "sofa");
}

TEST_F(ReplicaPackTest, TimesAreWrittenWhereTheyAreTrue) {
  const RampSource source(3);
  ReplicaPack made = pack(source);
  write_replica_pack(folder_.path(), made);
  EXPECT_FALSE(fs::exists(folder_.path() / "den" / "timestamps.txt"));
  made.timed = true;
  made.scene = "film";
  write_replica_pack(folder_.path(), made);
  const auto read = open_frame_source(folder_.path() / "film");
  EXPECT_EQ(read->read(2).frame->timestamp_s, 0.2);
  fs::remove(folder_.path() / "film" / "timestamps.txt");
  write_replica_pack(folder_.path(), made);  // goes on
  EXPECT_EQ(open_frame_source(folder_.path() / "film")->read(1).frame->timestamp_s, 0.1);
}

TEST_F(ReplicaPackTest, MixingRecordingsIsRefused) {
  const RampSource source(1), skewed(2, false);
  ReplicaPack other = pack(source);
  EXPECT_EQ(fault(other), "");
  other.settings = "seed: 2\n";
  EXPECT_NE(fault(other).find("settings.yaml: describes other settings"), std::string::npos);
  other.scene = "attic";
  write_text(folder_.path() / "cam_params.json", "{}");
  EXPECT_NE(fault(other).find("cam_params.json: describes another camera"), std::string::npos);
  EXPECT_NE(fault(pack(skewed)).find("frame 1 of ramp: colour and depth have different cameras"),
            std::string::npos);
}

}  // namespace
}  // namespace ovimap
