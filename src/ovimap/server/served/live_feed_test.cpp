// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served/live_feed.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap {
namespace {

/// A desk that is mapped frame by frame, and shown meanwhile.
class LiveFeedTest : public MapFolder {
 protected:
  LiveFeedTest() {
    MapperConfig config;
    config.mask_interval = 1;
    mapper_ = std::make_unique<Mapper>(config, std::make_shared<DeskMasks>());
    FoundMap begun;
    begun.info.voxel_size_m = config.map.voxel_size_m;
    begun.record.names = {{77, "of an earlier run"}};
    ServedMapConfig served;
    served.encoder = "none";
    map_ = std::make_unique<ServedMap>(path_, begun, served);
    LiveFeedConfig quick;
    quick.surface_share = quick.objects_share = quick.spare_share = 1e6;
    quick.vertices_per_s = 1e9;
    quick.mesh_interval = quick.objects_interval = quick.pose_interval = {};
    feed_ = std::make_unique<LiveFeed>(*map_, quick);
  }

  void map_frames(std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) {
      const Frame frame = *scene_.read(i).frame;
      mapper_->process(frame);
      sequence_.depth_camera = frame.depth_camera;
      sequence_.frames.push_back({i, 0, frame.name, frame.world_from_camera, true});
      after_frame();
    }
  }
  void after_frame() { feed_->after_frame(*mapper_, sequence_.frames, sequence_.depth_camera); }
  /// As long as it takes: what is seen is decided by other threads.
  template <class Condition>
  void wait_until(Condition&& holds) {
    while (!holds()) {
      after_frame();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  std::size_t objects() const { return map_->snapshot()->record->instances.size(); }
  MapDocument end() {
    feed_.reset();
    MapDocument document =
        make_document(std::move(*mapper_), sequence_, MapHeader{"desk", "", {}, {}});
    document.edits = map_->close_log();
    save_map(path_, document);
    return document;
  }
  MapEdit rename(InstanceId id, const std::string& name) {
    MapEdit edit;
    edit.instances = {id};
    edit.name = name;
    return map_->correct(edit);
  }

  const DeskScene scene_;
  const std::filesystem::path path_ = root_ / "desk.ovimap";
  SequenceResult sequence_;
  std::unique_ptr<Mapper> mapper_;
  std::unique_ptr<ServedMap> map_;
  std::unique_ptr<LiveFeed> feed_;
};

TEST_F(LiveFeedTest, SaysWhenTheCameraIsLostAndWhereItCanBeFound) {
  const std::uint64_t before = map_->events().last();
  TrackedFrame frame;
  frame.tracked = true;
  frame.world_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
  feed_->after_tracking(frame);
  feed_->after_tracking(frame);
  EXPECT_EQ(map_->tracking().state, CameraState::kTracked);
  frame.tracked = false;
  frame.world_from_camera.translation().setZero();  // which means nothing
  for (int i = 0; i < 3; ++i) feed_->after_tracking(frame);
  EXPECT_EQ(map_->tracking().state, CameraState::kLost);
  EXPECT_EQ(map_->tracking().world_from_camera.translation(), Eigen::Vector3d(1, 2, 3));
  frame.tracked = true;
  feed_->after_tracking(frame);
  EXPECT_EQ(map_->tracking().state, CameraState::kTracked);
  std::vector<std::string> said;
  std::uint64_t last = before;
  while (const auto event = map_->events().next(last)) {
    last = event->number;
    if (event->type == "tracking")
      said.push_back(event->data.substr(10, event->data.find('"', 10) - 10));
  }
  EXPECT_EQ(said, (std::vector<std::string>{"tracked", "lost", "tracked"})) << "each once";
}

TEST_F(LiveFeedTest, ShowsSurfaceObjectsAndCamera) {
  EXPECT_EQ(objects(), 0u);
  map_frames(0, scene_.size());
  const Mesh whole = extract_mesh(mapper_->map());
  wait_until(
      [&] { return joined_surface(*map_->surface()).triangles.size() == whole.triangles.size(); });
  wait_until([&] { return map_->snapshot()->record->frames.size() == 12 && objects() == 3; });
  const auto now = map_->snapshot();
  EXPECT_TRUE(now->live);
  EXPECT_GT(now->record->up.z(), 0.9f);
  for (const InstanceSummary& found :
       summarize_instances(mapper_->map(), mapper_->registry(), InstanceSummaryConfig{})) {
    const auto position = now->index().find(found.id);
    ASSERT_TRUE(position);
    const InstanceSummary& shown = now->record->instances[*position];
    const float slack = 4 * mapper_->config().map.voxel_size_m;
    EXPECT_LT((shown.box.min() - found.box.min()).norm(), slack);
    EXPECT_LT((shown.box.max() - found.box.max()).norm(), slack);
    EXPECT_EQ(shown.views, found.views);
    for (const Label root : found.super_points) EXPECT_EQ(now->instance_of_label[root], found.id);
  }
  EXPECT_FALSE(now->record->seen_free.regions().empty()) << "for where to look next";
  EXPECT_FALSE(map_->surface()->errors().empty());
  std::set<std::string> heard;
  for (std::uint64_t i = 0; i < map_->events().last(); ++i)
    if (const auto event = map_->events().next(i)) heard.insert(event->type);
  EXPECT_TRUE(heard.contains("frame") && heard.contains("mesh") && heard.contains("map"));
}

TEST_F(LiveFeedTest, CorrectionsSurviveMoreMappingAndTheEnd) {
  map_frames(0, 6);
  wait_until([&] { return objects() == 3; });
  const InstanceId table = map_->snapshot()->record->instances[0].id;
  const InstanceId ball = map_->snapshot()->record->instances[1].id;
  const InstanceId other = map_->snapshot()->record->instances[2].id;
  rename(table, "desk");
  MapEdit merge;
  merge.action = EditAction::kMerge;
  merge.instances = {ball, other};
  EXPECT_EQ(map_->correct(merge).id, 2);
  EXPECT_EQ(objects(), 2u);
  EXPECT_THROW(map_->correct(merge), Error);

  const std::uint64_t before = map_->snapshot()->version;
  map_frames(6, scene_.size());
  wait_until([&] { return map_->snapshot()->record->frames.size() == 12 && objects() == 2; });
  EXPECT_GT(map_->snapshot()->version, before);
  EXPECT_EQ(objects(), 2u);
  EXPECT_EQ(map_->snapshot()->name_of(table), "desk");
  EXPECT_EQ(map_->snapshot()->name_of(77), "of an earlier run");

  end();
  EXPECT_THROW(rename(table, "too late"), Error);
  EXPECT_EQ(load_corrected_map(path_).instances.size(), 2u);
  map_->saved();
  EXPECT_FALSE(map_->snapshot()->live);
  EXPECT_EQ(objects(), 2u);
  EXPECT_EQ(map_->snapshot()->name_of(table), "desk");
  rename(table, "in the file");
  EXPECT_EQ(load_corrected_map(path_).names.at(table), "in the file");
}

TEST_F(LiveFeedTest, SavedSurfaceReplacesTheOneBefore) {
  map_frames(0, 4);
  wait_until([&] { return objects() == 3; });
  const std::uint64_t seen = map_->surface()->version();
  const std::size_t triangles = extract_mesh(mapper_->map()).triangles.size();
  end();
  map_->saved();
  EXPECT_EQ(joined_surface(*map_->surface()).triangles.size(), triangles);
  EXPECT_GT(map_->surface()->version(), seen);
  for (const int level : {0, 1}) EXPECT_FALSE(map_->surface()->list(level, seen).empty());
}

/// A camera that pauses: no frame comes any more.
TEST_F(LiveFeedTest, ShowsWhatIsThereInAPause) {
  feed_.reset();
  LiveFeedConfig slow;
  slow.surface_share = slow.objects_share = slow.spare_share = 1e6;
  slow.vertices_per_s = 1e5;
  slow.objects_interval = slow.mesh_interval = std::chrono::milliseconds(1);
  feed_ = std::make_unique<LiveFeed>(*map_, slow);
  map_frames(0, scene_.size());
  const std::size_t triangles = extract_mesh(mapper_->map()).triangles.size();
  const auto shown = [&] {
    return joined_surface(*map_->surface()).triangles.size() == triangles &&
           map_->snapshot()->record->frames.size() == 12 && objects() == 3;
  };
  const auto wait = [&] {
    feed_->while_waiting(*mapper_, sequence_.frames, sequence_.depth_camera);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  };
  while (!shown()) wait();
  for (std::uint64_t before = 0; before != map_->snapshot()->version;) {
    before = map_->snapshot()->version;
    for (int i = 0; i < 20; ++i) wait();
  }
  EXPECT_TRUE(shown()) << "and then there is nothing new to tell";
}

TEST_F(LiveFeedTest, SendsNoMoreThanItsAllowance) {
  feed_.reset();
  LiveFeedConfig slow;
  slow.mesh_interval = {};
  slow.surface_share = 1e6;
  slow.vertices_per_s = 100;
  feed_ = std::make_unique<LiveFeed>(*map_, slow);
  map_frames(0, scene_.size());
  EXPECT_LT(joined_surface(*map_->surface()).vertices.size(), 5000u);  // of 11,000
}

}  // namespace
}  // namespace ovimap
