// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/checkpointer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/sequence/sequence_run.h"
#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

MapperConfig checkpointed_config() {
  MapperConfig config;
  config.view_interval = 1;
  config.mask_interval = 2;
  config.semantics.views.min_mask_px = 20;
  config.semantics.views.min_first_depth_px = config.semantics.views.min_depth_px = 10;
  config.semantics.views.min_frames_seen = 1;
  config.semantics.queue.capacity = 3;
  return config;
}

class CheckpointerTest : public ::testing::Test {
 protected:
  Mapper mapper() const {
    const std::shared_ptr<DeskMasks> masks(slow_ ? new SlowDeskMasks : new DeskMasks);
    masks->masked_every = masked_every_;
    MapperConfig config = checkpointed_config();
    if (slow_) config.mask_interval = 0;
    config.mask_motion = 0.4f;  // the desk's frames are far apart
    return Mapper(config, masks, std::make_shared<ColorEncoder>());
  }

  Checkpointer checkpointer(int frames, CheckpointFile::Start start, std::size_t done = 0) const {
    return Checkpointer(std::make_shared<TileKeeper>(partial_, start, MemoryConfig{}),
                        {0.f, frames}, {"desk", "a: 1\n"}, done);
  }

  /// The bytes of the finished map. `checkpoints` may be null.
  Bytes finish(Mapper&& mapper, const SequenceResult& sequence,
               Checkpointer* checkpoints = nullptr) const {
    MapDocument document = make_document(std::move(mapper), sequence, {"desk", "a: 1\n"});
    document.timings.clear();
    save_map(folder_.path() / "map.ovimap", document);
    if (checkpoints) checkpoints->remove();
    return read_file(folder_.path() / "map.ovimap");
  }

  /// What a run does until it is killed after `frames` frames. A checkpoint waits for the encoder,
  /// so for the test to be the same each time every frame does too.
  void begin(int frames) const {
    Mapper begun = mapper();
    Checkpointer checkpoints = checkpointer(2, CheckpointFile::Start::kAnew);
    run_sequence(
        scene_, positions({}, scene_.size()), begun,
        [&](std::size_t done, std::size_t, const FrameReport*) {
          begun.finish();
          return static_cast<int>(done) < frames;
        },
        {}, &checkpoints);
  }

  /// ... and what the run does that resumes it.
  Bytes resume() const {
    MapDocument document = load_map(partial_);
    SequenceResult sequence;
    sequence.frames = document.frames;
    sequence.depth_camera = document.depth_camera;
    Mapper resumed = mapper();
    resumed.restore(std::move(document));
    Checkpointer checkpoints =
        checkpointer(3, CheckpointFile::Start::kGoOn, sequence.frames.size());
    std::vector<std::int64_t> left;
    for (std::int64_t i = sequence.frames.back().index + 1; i < scene_.size(); ++i)
      left.push_back(i);
    sequence = run_sequence(scene_, left, resumed, nullptr, std::move(sequence), &checkpoints);
    return finish(std::move(resumed), sequence, &checkpoints);
  }

  /// Kills a run after each of some numbers of frames and compares with one that was not.
  void expect_resumed_runs_to_end_alike() const {
    Mapper whole = mapper();
    const SequenceResult sequence = run_sequence(scene_, positions({}, scene_.size()), whole);
    const Bytes expected = finish(std::move(whole), sequence);
    for (const int frames : {3, 6, 9, DeskScene::kFrames}) {
      begin(frames);
      ASSERT_TRUE(holds_checkpoint(partial_)) << frames;
      EXPECT_EQ(resume(), expected) << "killed after " << frames << " frames";
      EXPECT_FALSE(fs::exists(partial_));
    }
  }

  std::int64_t masked_every_ = 1;
  bool slow_ = false;
  DeskScene scene_;
  fixture::TemporaryFolder folder_;
  fs::path partial_ = checkpoint_path(folder_.path() / "map.ovimap");
};

TEST_F(CheckpointerTest, AResumedRunEndsAsIfNeverInterrupted) {
  expect_resumed_runs_to_end_alike();
}

TEST_F(CheckpointerTest, SoDoesOneThatAsksForMasksByMotion) {
  slow_ = true;
  Mapper whole = mapper();
  const SequenceResult sequence = run_sequence(scene_, positions({}, scene_.size()), whole);
  const auto masked = std::count_if(sequence.frames.begin(), sequence.frames.end(),
                                    [](const FrameLogEntry& frame) { return frame.labelled; });
  ASSERT_GT(masked, 2);
  ASSERT_LT(masked, DeskScene::kFrames);
  expect_resumed_runs_to_end_alike();
}

TEST_F(CheckpointerTest, SoDoesOneWhoseMasksAreMissingOnSomeFrames) {
  masked_every_ = 4;
  expect_resumed_runs_to_end_alike();
}

/// What comes after the last frame may take long, and whoever kills it loses no frame.
TEST_F(CheckpointerTest, ARunKilledAfterItsLastFrameEndsAsIfItWasNot) {
  Mapper whole = mapper();
  const SequenceResult sequence = run_sequence(scene_, positions({}, scene_.size()), whole);
  const Bytes expected = finish(std::move(whole), sequence);
  {
    Mapper begun = mapper();
    Checkpointer checkpoints = checkpointer(1000, CheckpointFile::Start::kAnew);
    run_sequence(scene_, positions({}, scene_.size()), begun, nullptr, {}, &checkpoints);
    ASSERT_FALSE(holds_checkpoint(partial_));
    checkpoints.store(begun, sequence.frames, sequence.depth_camera);
  }
  ASSERT_TRUE(holds_checkpoint(partial_));
  EXPECT_EQ(load_map(partial_).frames.size(), sequence.frames.size());
  EXPECT_EQ(resume(), expected);
}

TEST_F(CheckpointerTest, APauseStoresWhatCameBeforeItOnce) {
  Mapper begun = mapper();
  SequenceResult sequence;
  {
    Checkpointer checkpoints(
        std::make_shared<TileKeeper>(partial_, CheckpointFile::Start::kAnew, MemoryConfig{}),
        {1e-6f, 0}, {}, 0);
    sequence = run_sequence(scene_, positions({}, scene_.size()), begun, nullptr, {}, &checkpoints);
    const auto times = [&](const char* stage) { return begun.timers().summary()[stage].count; };
    const auto wait = [&] {
      checkpoints.while_waiting(begun, sequence.frames, sequence.depth_camera);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    // One is due at any time, so where none is under way the next call begins what is left to
    // store.
    const auto settle = [&] {
      for (;;) {
        do wait();
        while (times("checkpoint_end") != times("checkpoint"));
        const auto before = times("checkpoint");
        wait();
        if (times("checkpoint") == before) return before;
      }
    };
    const auto before = settle();
    MapEdit rename;
    rename.id = 1;
    rename.instances = {1};
    rename.name = "desk";
    checkpoints.set_edits({rename});
    EXPECT_EQ(settle(), before + 1) << "the correction, and nothing else";
  }
  const MapDocument stored = load_map(partial_);
  EXPECT_EQ(stored.frames.size(), sequence.frames.size());
  EXPECT_EQ(stored.edits.size(), 1u);
}

TEST_F(CheckpointerTest, CheckpointsDoNotChangeTheMap) {
  Mapper plain = mapper(), watched = mapper();
  const SequenceResult sequence = run_sequence(scene_, positions({}, scene_.size()), plain);
  Checkpointer checkpoints = checkpointer(1, CheckpointFile::Start::kAnew);
  run_sequence(scene_, positions({}, scene_.size()), watched, nullptr, {}, &checkpoints);
  EXPECT_EQ(finish(std::move(plain), sequence), finish(std::move(watched), sequence, &checkpoints));
}

TEST_F(CheckpointerTest, ACheckpointThatCannotBeWrittenEndsTheRun) {
  Mapper begun = mapper();
  Checkpointer checkpoints(
      std::make_shared<TileKeeper>(folder_.path() / "nowhere" / "map.partial",
                                   CheckpointFile::Start::kAnew, MemoryConfig{}),
      {0.f, 1}, {}, 0);
  const std::string fault = error_of([&] {
    run_sequence(scene_, positions({}, scene_.size()), begun, nullptr, {}, &checkpoints);
  });
  EXPECT_NE(fault.find("map.partial"), std::string::npos) << fault;
}

}  // namespace
}  // namespace ovimap
