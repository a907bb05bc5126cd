// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/tile_keeper.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <limits>
#include <optional>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/mapping/checkpointer.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

// Twice what a frame shows: each also sees through what its neighbours put before it.
constexpr int kBound_mb = 22;

/// The desk seen by a camera that walks by a row of them, and comes back: tiles leave memory, and
/// later frames need them again.
class DeskRow : public FrameSource {
 public:
  static constexpr std::int64_t kDesks = 6;
  std::string kind() const override { return "desks"; }
  std::int64_t size() const override { return 2 * kDesks * kViews; }

  FrameRead read(std::int64_t position) const override {
    FrameRead read = desk_.read(view(position));
    read.frame->index = position;
    read.frame->world_from_camera.translation().x() += 1.5 * static_cast<double>(desk(position));
    return read;
  }
  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    return desk_.truth_ids(view(position));
  }

 private:
  static constexpr std::int64_t kViews = 4;
  static std::int64_t view(std::int64_t position) {
    return position * DeskScene::kFrames / kViews % DeskScene::kFrames + position / 24;
  }
  static std::int64_t desk(std::int64_t position) {
    const std::int64_t step = position / kViews;
    return step < kDesks ? step : 2 * kDesks - 1 - step;
  }

  DeskScene desk_;
};

class DeskRowMasks : public MaskSource {
 public:
  std::string kind() const override { return "desks"; }
  std::optional<Entities> entities(const Frame& frame, std::span<const MaskPrompt>) override {
    return Entities{*row_.truth_ids(frame.index), {1.f, 1.f, 1.f}};
  }

 private:
  DeskRow row_;
};

class TileKeeperTest : public ::testing::Test {
 protected:
  static MapperConfig config() {
    MapperConfig config;
    config.view_interval = 3;
    config.map.voxel_size_m = 0.01f;
    return config;
  }
  static Mapper mapper() { return Mapper(config(), std::make_shared<DeskRowMasks>()); }

  struct Run {
    Bytes bytes;  ///< of the map file
    std::size_t evicted = 0, loaded = 0, most_blocks = 0;
  };

  Run finish(Mapper&& mapper, const SequenceResult& sequence, Checkpointer* checkpoints) const {
    Run run;
    if (checkpoints) checkpoints->let_tiles_leave(mapper);
    StageTimers timers;
    if (checkpoints) checkpoints->report(timers);
    auto stages = timers.summary();
    run.evicted = stages["evict_tile"].count;
    run.loaded = stages["load_tile"].count;
    MapDocument document = make_document(std::move(mapper), sequence, {"desks"});
    document.timings.clear();
    save_map(folder_.path() / "map.ovimap", document);
    run.bytes = read_file(folder_.path() / "map.ovimap");
    run.most_blocks = document.map.blocks_in_memory();
    return run;
  }

  Run unbounded() const {
    Mapper mapped = mapper();
    const SequenceResult sequence = run_sequence(row_, positions({}, row_.size()), mapped);
    return finish(std::move(mapped), sequence, nullptr);
  }

  /// With checkpoints every `every` frames.
  Run bounded(int max_mb, int every) const {
    auto tiles =
        std::make_shared<TileKeeper>(partial_, TileKeeper::Start::kAnew, MemoryConfig{max_mb});
    Checkpointer checkpoints(tiles, {0.f, every}, {}, 0);
    Mapper mapped = mapper();
    std::size_t most_blocks = 0;
    const SequenceResult sequence = run_sequence(
        row_, positions({}, row_.size()), mapped,
        [&](std::size_t, std::size_t, const FrameReport*) {
          most_blocks = std::max(most_blocks, mapped.map().blocks_in_memory());
          return true;
        },
        {}, &checkpoints);
    Run run = finish(std::move(mapped), sequence, &checkpoints);
    run.most_blocks = std::max(run.most_blocks, most_blocks);
    checkpoints.remove();
    return run;
  }

  /// Goes on with the checkpoint that an unfinished run left.
  Run resume() const {
    EXPECT_TRUE(holds_checkpoint(partial_));
    auto tiles =
        std::make_shared<TileKeeper>(partial_, TileKeeper::Start::kGoOn, MemoryConfig{kBound_mb});
    MapDocument document = load_map_without_voxels(partial_);
    document.map.keep_in(tiles);
    EXPECT_EQ(document.map.blocks_in_memory(), 0u);
    SequenceResult sequence;
    sequence.frames = document.frames;
    sequence.depth_camera = document.depth_camera;
    EXPECT_GT(sequence.frames.size(), 5u);
    Mapper resumed = mapper();
    resumed.restore(std::move(document));
    Checkpointer checkpoints(tiles, {0.f, 7}, {}, sequence.frames.size());
    std::vector<std::int64_t> left;
    for (std::int64_t i = sequence.frames.back().index + 1; i < row_.size(); ++i) left.push_back(i);
    sequence = run_sequence(row_, left, resumed, nullptr, std::move(sequence), &checkpoints);
    return finish(std::move(resumed), sequence, &checkpoints);
  }

  DeskRow row_;
  fixture::TemporaryFolder folder_;
  fs::path partial_ = checkpoint_path(folder_.path() / "map.ovimap");
};

TEST_F(TileKeeperTest, ABoundDoesNotChangeTheMap) {
  const Run expected = unbounded();
  for (const int every : {0, 5}) {
    const Run run = bounded(kBound_mb, every);
    EXPECT_EQ(run.bytes, expected.bytes) << "checkpoints every " << every << " frames";
    EXPECT_GT(run.evicted, 100u);
    EXPECT_GT(run.loaded, 60u);
    EXPECT_LE(run.most_blocks * VoxelBlock::kMostBytes, kBound_mb * 1000000u);
    EXPECT_GT(expected.most_blocks, 2 * run.most_blocks) << "the bound was too easy";
    EXPECT_FALSE(fs::exists(partial_));
  }
}

TEST_F(TileKeeperTest, AKilledRunGoesOnWithinTheBound) {
  const Run expected = unbounded();
  {
    Checkpointer checkpoints(
        std::make_shared<TileKeeper>(partial_, TileKeeper::Start::kAnew, MemoryConfig{kBound_mb}),
        {0.f, 7}, {}, 0);
    Mapper killed = mapper();
    run_sequence(
        row_, positions({}, row_.size()), killed,
        [](std::size_t done, std::size_t, const FrameReport*) { return done < 31; }, {},
        &checkpoints);
  }
  EXPECT_EQ(resume().bytes, expected.bytes);
}

/// Frames moved a little and fused again, as when a loop was closed.
TEST_F(TileKeeperTest, FramesAreFusedAgainWithinTheBound) {
  const auto corrected = [&](int max_mb) {
    MapperConfig keeping = config();
    keeping.frame_store.max_mb = 100;
    Mapper mapped(keeping, std::make_shared<DeskRowMasks>());
    Checkpointer checkpoints(
        std::make_shared<TileKeeper>(partial_, TileKeeper::Start::kAnew, MemoryConfig{max_mb}),
        {0.f, 7}, {}, 0);
    const SequenceResult sequence =
        run_sequence(row_, positions({}, row_.size()), mapped, nullptr, {}, &checkpoints);
    std::vector<Pose> poses = poses_of(sequence.frames);
    for (std::size_t i = 0; i < poses.size(); ++i)
      poses[i].translation().x() += 0.0007 * static_cast<double>(i);
    checkpoints.let_tiles_leave(mapped);
    std::size_t most_blocks = 0;
    mapped.fuse_again(poses, sequence.depth_camera, [&](std::size_t, std::size_t) {
      most_blocks = std::max(most_blocks, mapped.map().blocks_in_memory());
    });
    checkpoints.remove();
    return std::pair(mapped.map().content_hash(), most_blocks);
  };
  const auto [whole, whole_blocks] = corrected(0);
  const auto [bounded, bounded_blocks] = corrected(kBound_mb);
  EXPECT_EQ(whole, bounded);
  EXPECT_LE(bounded_blocks * VoxelBlock::kMostBytes, kBound_mb * 1000000u);
  EXPECT_GT(whole_blocks, 2 * bounded_blocks) << "the bound was too easy";
}

/// No file may grow beyond what it is now.
class FullDisk {
 public:
  explicit FullDisk(std::uintmax_t bytes) : old_handler_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    ::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST_F(TileKeeperTest, AFullDiskLeavesTheLastCheckpoint) {
  const Run expected = unbounded();
  std::string fault;
  {
    Checkpointer checkpoints(
        std::make_shared<TileKeeper>(partial_, TileKeeper::Start::kAnew, MemoryConfig{kBound_mb}),
        {0.f, 7}, {}, 0);
    Mapper mapped = mapper();
    std::optional<FullDisk> full;
    fault = error_of([&] {
      run_sequence(
          row_, positions({}, row_.size()), mapped,
          [&](std::size_t done, std::size_t, const FrameReport*) {
            const fs::path log = fs::path(partial_) += "-wal";
            if (done == 20) full.emplace(std::max(fs::file_size(partial_), fs::file_size(log)));
            return true;
          },
          {}, &checkpoints);
    });
  }
  EXPECT_NE(fault.find("map.ovimap.partial"), std::string::npos) << fault;
  EXPECT_NE(fault.find("; "), std::string::npos) << fault;
  EXPECT_EQ(resume().bytes, expected.bytes);
}

TEST_F(TileKeeperTest, ASavedMapGoesOnWithinTheBound) {
  const fs::path saved = folder_.path() / "first.ovimap";
  Mapper first = mapper();
  SequenceResult sequence = run_sequence(row_, positions({0, 20, 1}, row_.size()), first);
  save_map(saved, make_document(std::move(first), sequence, {"desks"}));
  const auto tiles =
      std::make_shared<TileKeeper>(partial_, TileKeeper::Start::kAnew, MemoryConfig{kBound_mb});
  MapDocument document = load_map_without_voxels(saved);
  tiles->adopt(saved);
  document.map.keep_in(tiles);
  const std::uint64_t stored_hash = load_map(saved).map.content_hash();
  EXPECT_EQ(document.map.content_hash(), stored_hash);
  EXPECT_LE(document.map.blocks_in_memory() * VoxelBlock::kMostBytes, kBound_mb * 1000000u);
  constexpr int kLess_mb = kBound_mb / 3;
  tiles->set_bound({kLess_mb});
  document.map.trim();
  const std::size_t spares = document.map.keep_spares(std::numeric_limits<std::size_t>::max());
  EXPECT_LE((document.map.blocks_in_memory() + spares) * VoxelBlock::kMostBytes,
            kLess_mb * 1000000u)
      << "what left is given back";
}

TEST_F(TileKeeperTest, AMapOfAnOlderProgramGoesOnWithinTheBound) {
  const fs::path old = fs::path(OVIMAP_SOURCE_DIR) / "tests/maps/schema6.ovimap";
  const auto tiles =
      std::make_shared<TileKeeper>(partial_, TileKeeper::Start::kAnew, MemoryConfig{kBound_mb});
  const MapDocument document = load_map_in(tiles, old);
  EXPECT_EQ(document.map.blocks_in_memory(), 0u);
  EXPECT_EQ(document.map.content_hash(), load_map(old).map.content_hash());
}

TEST_F(TileKeeperTest, ABoundBelowWhatOneFrameSeesIsRefused) {
  const std::string fault = error_of([&] { bounded(2, 0); });  // a frame of the desk takes more
  EXPECT_NE(fault.find("give --max-memory"), std::string::npos) << fault;
}

TEST_F(TileKeeperTest, AFileThatCannotBeWrittenEndsTheRun) {
  const fs::path nowhere = folder_.path() / "nowhere" / "map.partial";
  Checkpointer checkpoints(
      std::make_shared<TileKeeper>(nowhere, TileKeeper::Start::kAnew, MemoryConfig{kBound_mb}),
      {0.f, 0}, {}, 0);
  Mapper mapped = mapper();
  EXPECT_THROW(run_sequence(row_, positions({}, row_.size()), mapped, nullptr, {}, &checkpoints),
               Error);
}

TEST(MemoryAmount, IsReadInUnitsOfAMillionBytes) {
  EXPECT_EQ(parse_megabytes("300M"), 300);
  EXPECT_EQ(parse_megabytes("1.5G"), 1500);
  for (const char* nonsense : {"", "300", "M", "-3M", "0M", "3 M", "3MB", "nanG", "1e30G", "x"})
    EXPECT_THROW(parse_megabytes(nonsense), Error) << nonsense;
}

}  // namespace
}  // namespace ovimap
