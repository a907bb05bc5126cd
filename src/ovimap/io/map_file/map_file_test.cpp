// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_file.h"

#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>

#include <sys/resource.h>
#include <sys/stat.h>

#include "ovimap/base/parallel.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_file_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

using MapFile = MapFolder;

TEST_F(MapFile, ReturnsWhatWasSaved) {
  const MapDocument saved = random_document(60, 1);
  save_map(root_ / "a.ovimap", saved);
  const MapDocument loaded = load_map(root_ / "a.ovimap");
  EXPECT_EQ(difference(saved, loaded), "");
  EXPECT_EQ(loaded.content_hash, saved.map.content_hash());
  EXPECT_EQ(loaded.map.content_hash(), saved.map.content_hash());
}

TEST_F(MapFile, SavingWhatWasLoadedGivesTheSameFile) {
  save_map(root_ / "a.ovimap", random_document(60, 2));
  save_map(root_ / "b.ovimap", load_map(root_ / "a.ovimap"));
  EXPECT_EQ(read_file(root_ / "a.ovimap"), read_file(root_ / "b.ovimap"));
}

TEST_F(MapFile, TheNumberOfThreadsDoesNotShow) {
  const MapDocument saved = random_document(400, 17);
  save_map(root_ / "many.ovimap", saved);
  const ThreadLimit one_thread(1);
  save_map(root_ / "one.ovimap", saved);
  EXPECT_EQ(read_file(root_ / "many.ovimap"), read_file(root_ / "one.ovimap"));
  EXPECT_EQ(difference(saved, load_map(root_ / "many.ovimap")), "");
}

TEST_F(MapFile, AnEmptyMapIsAMap) {
  const MapDocument empty;
  save_map(root_ / "a.ovimap", empty);
  EXPECT_EQ(difference(empty, load_map(root_ / "a.ovimap")), "");
  const MapInfo info = read_map_info(root_ / "a.ovimap");
  EXPECT_EQ(info.blocks, 0u);
  EXPECT_TRUE(info.instances.empty());
}

TEST_F(MapFile, ALoadedMapGoesOnWhereTheSavedOneStopped) {
  MapDocument saved = random_document(30, 3);
  save_map(root_ / "a.ovimap", saved);
  MapDocument loaded = load_map(root_ / "a.ovimap");
  for (MapDocument* document : {&saved, &loaded}) {
    const Label fresh = document->map.labels().create();
    document->map.labels().merge(fresh, 5);
    document->map.find_or_create({3, -2, 40});
  }
  EXPECT_EQ(difference(saved, loaded), "");
  EXPECT_EQ(saved.map.content_hash(), loaded.map.content_hash());
  EXPECT_NE(loaded.map.find({-(1 << 20), 0, (1 << 20) - 1}), nullptr);
}

TEST_F(MapFile, OddNumbersSurvive) {
  MapDocument saved = random_document(2, 4);
  saved.frames[0].timestamp_s = std::numeric_limits<double>::quiet_NaN();
  saved.frames[1].timestamp_s = -std::numeric_limits<double>::infinity();
  saved.frames[2].world_from_camera.matrix()(0, 3) = std::numeric_limits<double>::quiet_NaN();
  saved.instances[0].points = 0;
  saved.instances[0].box.setEmpty();
  save_map(root_ / "a.ovimap", saved);
  const MapDocument loaded = load_map(root_ / "a.ovimap");
  EXPECT_TRUE(std::isnan(loaded.frames[0].timestamp_s));
  EXPECT_EQ(loaded.frames[1].timestamp_s, saved.frames[1].timestamp_s);
  EXPECT_TRUE(std::isnan(loaded.frames[2].world_from_camera.matrix()(0, 3)));
  EXPECT_TRUE(loaded.instances[0].box.isEmpty());
}

TEST_F(MapFile, InfoTellsTheSameAsTheMap) {
  const MapDocument saved = random_document(60, 5);
  save_map(root_ / "a.ovimap", saved);
  const MapInfo info = read_map_info(root_ / "a.ovimap");
  EXPECT_EQ(info.schema, kMapSchema);
  EXPECT_EQ(info.frames, 3);
  EXPECT_EQ(info.mask_frames, 2);
  EXPECT_TRUE(same_instances(info.instances, saved.instances));
  EXPECT_EQ(info.names, saved.names);
  EXPECT_EQ(info.depth_camera, saved.depth_camera);
  EXPECT_EQ(info.voxel_size_m, 0.0213f);
  EXPECT_EQ(info.blocks, saved.map.block_count());
  EXPECT_EQ(info.size_bytes, fs::file_size(root_ / "a.ovimap"));
  EXPECT_EQ(info.content_hash, saved.map.content_hash());
  EXPECT_EQ(info.source, saved.source);
  EXPECT_EQ(info.config_text, saved.config_text);
}

TEST_F(MapFile, MapsThatKeptNothingOfThePastStillTellTheirHistory) {
  const fs::path old = fs::path(OVIMAP_SOURCE_DIR) / "tests/maps/schema6.ovimap";
  MapDocument document = load_map(old);
  EXPECT_EQ(read_map_info(old).schema, 6);
  ASSERT_EQ(document.history.visits.size(), 2u);
  EXPECT_FALSE(document.history.visits[1].recorded_s);
  ASSERT_GE(document.history.events.size(), 2u);
  for (const ObjectEvent& event : document.history.events) EXPECT_EQ(event.was, nullptr);
  document.history.visits[1].recorded_s = 1.7e9;
  save_map(root_ / "new.ovimap", document);
  EXPECT_EQ(difference(document, load_map(root_ / "new.ovimap")), "");
  EXPECT_EQ(read_map_info(root_ / "new.ovimap").schema, kMapSchema);
}

TEST_F(MapFile, SavingReplacesTheOldMapAndItsLogs) {
  save_map(root_ / "a.ovimap", random_document(10, 6));
  std::ofstream(root_ / "a.ovimap-wal") << "log of the old map";
  const MapDocument second = random_document(20, 7);
  save_map(root_ / "a.ovimap", second);
  EXPECT_EQ(difference(second, load_map(root_ / "a.ovimap")), "");
  EXPECT_EQ(files_in_root(), 1u);
}

TEST_F(MapFile, AnyFileNameWillDo) {
  const MapDocument saved = random_document(3, 8);
  const fs::path path = root_ / "file:50% of it?mode=rw#\xc3\xa4 'map'";
  save_map(path, saved);
  EXPECT_EQ(difference(saved, load_map(path)), "");
}

TEST_F(MapFile, ReadsFromAFolderThatCannotBeWritten) {
  const MapDocument saved = random_document(3, 9);
  save_map(root_ / "a.ovimap", saved);
  fs::permissions(root_ / "a.ovimap", fs::perms::owner_read);
  fs::permissions(root_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(difference(saved, load_map(root_ / "a.ovimap")), "");
  fs::permissions(root_, fs::perms::owner_all);
}

TEST_F(MapFile, SaysWhyItCannotBeWritten) {
  const MapDocument document = random_document(1, 10);
  const std::string missing = fault_of([&] { save_map(root_ / "no" / "a.ovimap", document); });
  EXPECT_NE(missing.find("create the folder first"), std::string::npos) << missing;
  const std::string folder = fault_of([&] { save_map(root_, document); });
  EXPECT_NE(folder.find("it is a folder; give a file name"), std::string::npos) << folder;
  EXPECT_NE(fault_of([&] { save_map(root_ / "", document); }).find("it is a folder"),
            std::string::npos);
  EXPECT_NE(fault_of([&] { save_map("/proc/a.ovimap", document); }), "");
  for (const fs::path& path : {root_ / "no" / "a.ovimap", root_, fs::path("/proc/a.ovimap")})
    EXPECT_NE(fault_of([&] { check_map_target(path); }), "");
  EXPECT_EQ(fault_of([&] { check_map_target(root_ / "a.ovimap"); }), "");
  EXPECT_EQ(fault_of([&] { check_map_target(root_ / "a"); }), "");
  const std::string mesh = fault_of([&] { check_map_target(root_ / "a.PLY"); });
  EXPECT_NE(mesh.find("a.ovimap, `ovimap export`"), std::string::npos) << mesh;
  EXPECT_EQ(files_in_root(), 0u);
}

TEST_F(MapFile, WritesThroughALinkAndSparesWhatIsNoFile) {
  const MapDocument first = random_document(3, 15), second = random_document(4, 16);
  save_map(root_ / "a.ovimap", first);
  fs::create_symlink("a.ovimap", root_ / "link.ovimap");
  save_map(root_ / "link.ovimap", second);
  EXPECT_TRUE(fs::is_symlink(root_ / "link.ovimap"));
  EXPECT_EQ(difference(second, load_map(root_ / "a.ovimap")), "");
  fs::create_symlink("nowhere", root_ / "lost.ovimap");
  ASSERT_EQ(::mkfifo((root_ / "pipe.ovimap").c_str(), 0600), 0);
  for (const char* name : {"lost.ovimap", "pipe.ovimap"}) {
    const std::string fault = fault_of([&] { save_map(root_ / name, second); });
    EXPECT_NE(fault.find("give a file name"), std::string::npos) << name << ": " << fault;
    EXPECT_NE(fault_of([&] { load_map(root_ / name); }), "");
  }
  EXPECT_TRUE(fs::is_fifo(root_ / "pipe.ovimap"));
  EXPECT_EQ(files_in_root(), 4u);
}

/// While alive, the process has no right that its user does not grant: root becomes nobody.
class WithoutPrivilege {
 public:
  WithoutPrivilege() { give_up(::geteuid() == 0 ? kNobody : ::geteuid()); }
  ~WithoutPrivilege() { give_up(user_); }
  WithoutPrivilege(const WithoutPrivilege&) = delete;
  WithoutPrivilege& operator=(const WithoutPrivilege&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
  static void give_up(uid_t user) {
    if (::seteuid(user) != 0) ADD_FAILURE() << "cannot become user " << user;
  }
  uid_t user_ = ::geteuid();
};

TEST_F(MapFile, RefusesToWriteIntoAFolderWithoutPermission) {
  const MapDocument document = random_document(1, 11);
  fs::permissions(root_, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                             fs::perms::others_exec);
  const std::string fault = [&] {
    const WithoutPrivilege nobody;
    return fault_of([&] { save_map(root_ / "a.ovimap", document); });
  }();
  fs::permissions(root_, fs::perms::owner_all);
  EXPECT_NE(fault.find("choose a folder that you can write to"), std::string::npos) << fault;
}

/// While alive, no file of this process may grow beyond `bytes`: a full disk without a disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST_F(MapFile, AFailedSaveLeavesTheOldMapAlone) {
  const MapDocument old_map = random_document(10, 12), new_map = random_document(200, 13);
  save_map(root_ / "a.ovimap", old_map);
  const Bytes before = read_file(root_ / "a.ovimap");
  for (const rlim_t bytes : {0, 3000, 20000, 200000, 900000}) {
    const FileSizeLimit limit(bytes);
    const std::string fault = fault_of([&] { save_map(root_ / "a.ovimap", new_map); });
    EXPECT_NE(fault.find("cannot write map"), std::string::npos) << bytes << ": " << fault;
    EXPECT_EQ(fault.find('\n'), std::string::npos);
  }
  EXPECT_EQ(read_file(root_ / "a.ovimap"), before);
  EXPECT_EQ(files_in_root(), 1u);
}

TEST_F(MapFile, RefusesToSaveWhatCouldNotBeLoaded) {
  MapDocument document = random_document(1, 14);
  VoxelMapConfig config;
  config.voxel_size_m = 1e-6f;
  document.map = VoxelMap(config);
  EXPECT_NE(fault_of([&] { save_map(root_ / "a.ovimap", document); }).find("map.voxel_size_m"),
            std::string::npos);
  EXPECT_EQ(files_in_root(), 0u);
}

}  // namespace
}  // namespace ovimap
