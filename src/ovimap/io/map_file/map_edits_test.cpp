// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_edits.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_change.h"
#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/io/map_file/searchable_map.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

MapEdit renamed(InstanceId id, const std::string& name) {
  MapEdit edit;
  edit.instances = {id};
  edit.name = name;
  return edit;
}
MapEdit simple(EditAction action, std::vector<InstanceId> ids = {}) {
  MapEdit edit;
  edit.action = action;
  edit.instances = std::move(ids);
  return edit;
}

class MapEditing : public MapFolder {
 protected:
  MapEditing() { save_map(path_, saved_); }

  MapEdit split(InstanceId id, std::vector<Label> leaving) {
    MapEdit edit = simple(EditAction::kSplit, {id});
    edit.super_points = std::move(leaving);
    return edit_map(path_, edit);
  }

  /// What needs no voxels and what is computed from them say the same.
  void expect_consistent() {
    const MapInfo info = read_map_info(path_);
    const MapDocument document = load_corrected_map(path_);
    EXPECT_TRUE(same_instances(info.instances, document.instances));
    EXPECT_TRUE(same_instances(info.hidden, document.hidden));
    EXPECT_EQ(info.names, document.names);
    EXPECT_EQ(info.locked, document.locked);
    const SearchableMap search = read_searchable_map(path_);
    EXPECT_TRUE(same_instances(search.info.instances, document.instances));
    const std::vector<ObjectShape>& shapes = search.shapes.whole();
    ASSERT_EQ(shapes.size(), document.instances.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      EXPECT_EQ(search.shapes.outline(i).footprint, shapes[i].footprint);
      EXPECT_EQ(search.shapes.outline(i).top_m, shapes[i].top_m);
    }
    for (std::size_t i = 0; i < document.instances.size(); ++i) {
      const auto row = search.embeddings.row(static_cast<Eigen::Index>(i));
      const Appearance look = appearance_of(document, document.instances[i].id);
      const Eigen::VectorXf fused = fuse_views(look.views, document.semantics.views.fusion);
      EXPECT_TRUE(fused.size() == 0 ? row.isZero() : row.transpose() == fused);
    }
  }

  void refuse(const MapEdit& edit, const char* why) {
    const Bytes before = read_file(path_);
    const std::string fault = fault_of([&] { edit_map(path_, edit); });
    EXPECT_NE(fault.find(why), std::string::npos) << fault;
    EXPECT_EQ(fault.find('\n'), std::string::npos);
    EXPECT_EQ(read_file(path_), before);
  }

  const MapDocument saved_ = random_document(6, 20);  // objects 1 (super-points 1, 4) and 3
  const fs::path path_ = root_ / "a.ovimap";
};

TEST_F(MapEditing, TheMapIsSeenCorrectedAndStaysAsFound) {
  const MapEdit first = edit_map(path_, renamed(1, "cup"));
  EXPECT_EQ(first.id, 1);
  EXPECT_GT(first.time_s, 1.6e9);
  EXPECT_EQ(read_map_info(path_).names.at(1), "cup");
  expect_consistent();
  edit_map(path_, simple(EditAction::kMerge, {3, 1}));
  expect_consistent();
  EXPECT_EQ(read_map_info(path_).instances.size(), 1u);
  edit_map(path_, simple(EditAction::kHide, {1}));  // an id that was given up
  expect_consistent();
  EXPECT_TRUE(read_map_info(path_).instances.empty());
  EXPECT_EQ(read_map_info(path_).hidden.at(0).id, 3u);
  MapDocument found = load_map(path_);
  EXPECT_EQ(found.edits.size(), 3u);
  found.edits.clear();
  EXPECT_EQ(difference(saved_, found), "");
  EXPECT_EQ(files_in_root(), 1u);
}

TEST_F(MapEditing, APartTakenOffHasAnIdOfItsOwn) {
  const MapEdit done = split(1, {4, 4});
  EXPECT_EQ(done.new_instance, 4u);
  EXPECT_EQ(done.super_points, std::vector<Label>{4});
  expect_consistent();
  const auto instances = read_map_info(path_).instances;
  ASSERT_EQ(instances.size(), 3u);
  EXPECT_EQ(instances[0].super_points, std::vector<Label>{1});
  EXPECT_EQ(instances[2].super_points, std::vector<Label>{4});
  // Mapping will not give that id again.
  EXPECT_EQ(load_map(path_).registry.last_id, 4u);
  edit_map(path_, simple(EditAction::kUndo));
  EXPECT_EQ(load_map(path_).registry.last_id, 4u);
  EXPECT_EQ(split(1, {1}).new_instance, 5u);
}

/// A run goes on with a map while somebody corrects it, and then replaces it.
TEST_F(MapEditing, WhatIsCorrectedMeanwhileIsCarriedOver) {
  edit_map(path_, renamed(3, "table"));
  MapDocument continued = load_map(path_);
  continued.registry.last_id = 9;  // objects that the run found
  const MapEdit part = split(1, {4});
  edit_map(path_, renamed(part.new_instance, "lid"));
  edit_map(path_, simple(EditAction::kDelete, {3}));
  edit_map(path_, simple(EditAction::kUndo));
  EXPECT_TRUE(replace_map(path_, continued).empty());
  const MapInfo info = read_map_info(path_);
  EXPECT_EQ(info.names.at(3), "table");
  EXPECT_EQ(info.names.at(10), "lid");
  EXPECT_EQ(info.instances.size(), 3u);
  EXPECT_EQ(read_edits(path_).size(), 5u);
}

TEST_F(MapEditing, WhatMakesNoSenseAnyMoreIsToldAndLeftOut) {
  MapDocument continued = load_map(path_);
  edit_map(path_, renamed(1, "cup"));
  edit_map(path_, renamed(3, "table"));
  std::erase_if(continued.instances, [](const InstanceSummary& it) { return it.id == 1; });
  const std::vector<std::string> lost = replace_map(path_, continued);
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_NE(lost[0].find("edit 1 (rename): the map has no object 1"), std::string::npos) << lost[0];
  EXPECT_EQ(continued.edits.size(), 1u);
}

/// What waits until the map was replaced corrects the new one.
TEST_F(MapEditing, ACorrectionGoesIntoTheMapThatIsThereWhenItsTurnComes) {
  auto change = std::make_unique<MapChange>(path_);
  std::thread editor([&] { edit_map(path_, renamed(1, "cup")); });
  std::this_thread::sleep_for(
      std::chrono::milliseconds(100));  // or it comes late, which is as well
  save_map(path_, saved_);
  change.reset();
  editor.join();
  EXPECT_EQ(read_map_info(path_).names.at(1), "cup");
}

TEST_F(MapEditing, AMapThatNobodyMayChangeIsReplaced) {
  MapDocument document = load_map(path_);
  fs::permissions(path_, fs::perms::owner_read);
  document.names[1] = "again";
  EXPECT_TRUE(replace_map(path_, document).empty());
  EXPECT_EQ(read_map_info(path_).names.at(1), "again");
}

TEST_F(MapEditing, NothingIsForgotten) {
  edit_map(path_, renamed(1, "cup"));
  edit_map(path_, simple(EditAction::kDelete, {3}));
  const MapEdit undone = edit_map(path_, simple(EditAction::kUndo));
  EXPECT_EQ(undone.undoes, 2);
  expect_consistent();
  EXPECT_EQ(read_map_info(path_).instances.size(), 2u);
  MapEdit redo = simple(EditAction::kUndo);
  redo.undoes = 3;
  edit_map(path_, redo);
  EXPECT_EQ(read_map_info(path_).instances.size(), 1u);
  const MapEdits log = read_edits(path_);
  ASSERT_EQ(log.size(), 4u);
  EXPECT_EQ(log[1].undone_by, 0);
  EXPECT_EQ(log[2].undone_by, 4);
  EXPECT_EQ(log[0].name, "cup");
}

TEST_F(MapEditing, UndoingEverythingLeavesWhatWasFound) {
  edit_map(path_, simple(EditAction::kDelete, {3}));
  edit_map(path_, simple(EditAction::kUndo));
  expect_consistent();
  EXPECT_TRUE(same_instances(read_map_info(path_).instances, saved_.instances));
  refuse(simple(EditAction::kUndo), "nothing to undo");
}

TEST_F(MapEditing, TheLogSurvivesSavingAndMapping) {
  split(1, {4});
  edit_map(path_, renamed(4, "lid"));
  edit_map(path_, simple(EditAction::kLock, {3}));
  const MapEdits log = read_edits(path_);
  MapDocument document = load_map(path_);
  document.instances[1].points += 10;  // as if mapping had gone on
  save_map(root_ / "b.ovimap", document);
  EXPECT_EQ(read_edits(root_ / "b.ovimap"), log);
  const MapInfo later = read_map_info(root_ / "b.ovimap");
  EXPECT_EQ(later.names.at(4), "lid");
  EXPECT_EQ(later.instances.size(), 3u);
  EXPECT_EQ(later.instances[1].points, saved_.instances[1].points + 10);
  save_map(root_ / "c.ovimap", load_map(root_ / "b.ovimap"));
  EXPECT_EQ(read_file(root_ / "b.ovimap"), read_file(root_ / "c.ovimap"));
}

TEST_F(MapEditing, RefusesWhatMakesNoSense) {
  refuse(renamed(9, "x"), "no object 9");
  refuse(renamed(1, "a\nb"), "one line");
  refuse(renamed(1, "\xff"), "UTF-8");
  refuse(renamed(1, std::string(300, 'x')), "too long");
  refuse(simple(EditAction::kDelete), "needs an object");
  refuse(simple(EditAction::kMerge, {1}), "two objects");
  refuse(simple(EditAction::kMerge, {1, 2}), "named twice");  // 2 is an old id of 1
  refuse(simple(EditAction::kSplit, {3}), "single super-point");
  refuse(simple(EditAction::kSplit, {1}), "must leave");
  MapEdit all = simple(EditAction::kSplit, {1});
  all.super_points = {1, 4};
  refuse(all, "must stay");
  all.super_points = {1, 20};
  refuse(all, "no super-point 20");
  MapEdit undo = simple(EditAction::kUndo);
  undo.undoes = 7;
  refuse(undo, "no edit 7");
}

TEST_F(MapEditing, ALockIsOneAgainstPeopleToo) {
  edit_map(path_, simple(EditAction::kLock, {1}));
  refuse(renamed(1, "x"), "undo 1");
  refuse(simple(EditAction::kMerge, {3, 1}), "locked");
  refuse(simple(EditAction::kDelete, {1}), "locked");
  edit_map(path_, simple(EditAction::kHide, {1}));
  refuse(simple(EditAction::kHide, {1}), "hidden already");
  MapEdit unlock = simple(EditAction::kUndo);
  unlock.undoes = 1;
  edit_map(path_, unlock);
  edit_map(path_, renamed(1, "free"));
  refuse(unlock, "undone already");
}

TEST_F(MapEditing, OldMapsCanBeCorrected) {
  for (const char* name : {"schema1.ovimap", "schema2.ovimap", "schema3.ovimap", "schema4.ovimap",
                           "schema4_embed.ovimap", "schema5.ovimap", "schema6.ovimap"}) {
    fs::copy_file(fs::path(OVIMAP_SOURCE_DIR) / "tests/maps" / name, path_,
                  fs::copy_options::overwrite_existing);
    fs::permissions(path_, fs::perms::owner_all);
    const InstanceId id = read_map_info(path_).instances.at(0).id;
    edit_map(path_, renamed(id, "old thing"));
    EXPECT_EQ(read_map_info(path_).names.at(id), "old thing");
    EXPECT_EQ(load_corrected_map(path_).names.at(id), "old thing");
  }
}

TEST_F(MapEditing, OneAtATime) {
  SQLite::Database other(path_.string(), SQLite::OPEN_READWRITE);
  SQLite::Transaction transaction(other, SQLite::TransactionBehavior::IMMEDIATE);
  refuse(renamed(1, "x"), "another program is using it");
  EXPECT_EQ(read_map_info(path_).names, saved_.names);  // reading goes on meanwhile
}

TEST_F(MapEditing, ReadersSeeTheOldMapOrTheNewOne) {
  std::atomic<bool> done = false;
  std::thread reader([&] {
    while (!done) {
      const auto map = read_searchable_map(path_);
      std::size_t points = 0;
      for (const InstanceSummary& instance : map.info.instances) points += instance.points;
      EXPECT_EQ(points, saved_.instances[0].points + saved_.instances[1].points);
    }
  });
  for (int i = 0; i < 10; ++i) {
    MapEdit merge = simple(EditAction::kMerge, {1, 3});
    edit_map(path_, merge);
    edit_map(path_, simple(EditAction::kUndo));
  }
  done = true;
  reader.join();
}

TEST_F(MapEditing, AMapBeingMappedIsLeftAlone) {
  const fs::path partial = root_ / "a.ovimap.partial";
  fs::copy_file(path_, partial);
  std::ofstream(root_ / "a.ovimap.partial-wal") << "";
  EXPECT_NE(fault_of([&] { edit_map(partial, renamed(1, "x")); }).find("being mapped"),
            std::string::npos);
}

TEST_F(MapEditing, ReadingLeavesTheLocksOfAChangeAlone) {
  const MapChange change(path_);
  (void)read_map_info(path_);
  check_map_target(path_);
  const pid_t child = ::fork();  // which has none of its parent's locks
  if (child == 0) {
    constexpr off_t kReserved = 0x40000001;  // the byte that SQLite locks for a change
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    lock.l_start = kReserved;
    lock.l_len = 1;
    const int file = ::open(path_.c_str(), O_RDWR);
    ::_exit(::fcntl(file, F_GETLK, &lock) == 0 && lock.l_type == F_WRLCK ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0) << "another program could change the map at the same time";
}

TEST_F(MapEditing, AMapWithALogBesideItIsLeftAlone) {
  std::ofstream(root_ / "a.ovimap-wal") << "";
  refuse(renamed(1, "x"), "`ovimap info --recover ");
  EXPECT_TRUE(recover_map(path_));
  edit_map(path_, renamed(1, "x"));
  EXPECT_EQ(files_in_root(), 1u);
}

TEST_F(MapEditing, SaysThatItCannotBeWritten) {
  if (::geteuid() == 0) {  // root may write anything, so another user has to try
    const pid_t child = ::fork();
    if (child == 0) {
      fs::permissions(root_, fs::perms::all);
      fs::permissions(path_,
                      fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
      if (::setuid(65534) != 0) ::_exit(2);
      const std::string fault = fault_of([&] { edit_map(path_, renamed(1, "x")); });
      ::_exit(fault.find("copy it into a folder that you can write to") != std::string::npos ? 0
                                                                                             : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0);
  } else {
    fs::permissions(path_, fs::perms::owner_read);
    refuse(renamed(1, "x"), "copy it into a folder that you can write to");
  }
}

TEST_F(MapEditing, AKilledEditLeavesTheOldMapOrTheNewOne) {
  std::mt19937 random(3);
  std::size_t interrupted = 0, edited = 0;
  // A busy machine takes longer for an edit, so the time grows until both have happened.
  for (unsigned round = 0; round < 25 || (round < 500 && (interrupted == 0 || edited == 0));
       ++round) {
    const pid_t child = ::fork();
    if (child == 0) {
      for (int i = 0;; ++i) edit_map(path_, renamed(1, "name " + std::to_string(i)));
    }
    ::usleep(static_cast<useconds_t>(2000 + random() % (20000 + 1000 * round)));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    if (fs::exists(root_ / "a.ovimap-journal")) {
      const std::string fault = fault_of([&] { read_map_info(path_); });
      EXPECT_TRUE(fault.empty() || fault.find("`ovimap info --recover ") != std::string::npos)
          << fault;
      interrupted += !fault.empty();
      EXPECT_TRUE(recover_map(path_));
    }
    const MapInfo info = read_map_info(path_);
    const MapEdits log = read_edits(path_);
    ASSERT_TRUE(log.empty() || info.names.at(1) == log.back().name);
    for (std::size_t i = 0; i < log.size(); ++i)
      ASSERT_EQ(log[i].id, static_cast<std::int64_t>(i + 1));
    edited = log.size();
  }
  EXPECT_GT(interrupted, 0u);
  EXPECT_GT(edited, 0u);
  edit_map(path_, renamed(1, "last"));
  EXPECT_EQ(files_in_root(), 1u);
  MapDocument found = load_map(path_);
  found.edits.clear();
  EXPECT_EQ(difference(saved_, found), "");
}

}  // namespace
}  // namespace ovimap
