// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/corrections/map_edit_desk.h"

#include <algorithm>
#include <chrono>

#include "ovimap/base/error.h"
#include "ovimap/base/text/printable.h"
#include "ovimap/io/corrections/map_edit_log.h"

namespace ovimap {

namespace {

constexpr std::ptrdiff_t kLongestName = 200;  // letters

/// Judges an edit against the map as it is corrected so far, and fills in what follows from it.
class EditDesk {
 public:
  EditDesk(const MapRecord& found, const MapRecord& corrected, InstanceAliases aliases)
      : found_(found), corrected_(corrected), aliases_(std::move(aliases)) {}

  void complete(MapEdit& edit) const {
    const auto needed = [&](std::size_t least, const char* what) {
      if (edit.instances.size() < least)
        throw Error(concat("`", edit_action_name(edit.action), "` needs ", what));
    };
    if (edit.action == EditAction::kUndo) return find_undone(edit);
    needed(edit.action == EditAction::kMerge ? 2 : 1,
           edit.action == EditAction::kMerge ? "at least two objects" : "an object");
    for (InstanceId& id : edit.instances) id = object(id).id;
    if (edit.action != EditAction::kHide)
      for (const InstanceId id : edit.instances) refuse_locked(id);
    const InstanceSummary& first = object(edit.instances.front());
    if (edit.action == EditAction::kRename) check_name(edit.name);
    if (edit.action == EditAction::kMerge) check_merge(edit.instances);
    if (edit.action == EditAction::kSplit) complete_split(first, edit);
    if (edit.action == EditAction::kLock) edit.super_points = first.super_points;
    if (edit.action == EditAction::kHide && is_hidden(first.id))
      throw Error(concat("object ", first.id, " is hidden already"));
  }

 private:
  /// The object that an id stands for by now.
  const InstanceSummary& object(InstanceId asked) const {
    const InstanceId id = resolve_alias(aliases_, asked);
    for (const auto* list : {&corrected_.instances, &corrected_.hidden})
      if (const InstanceSummary* found = find_instance(*list, id)) return *found;
    throw Error(concat("the map has no object ", asked, "; `ovimap info` lists those it has"));
  }

  bool is_hidden(InstanceId id) const { return find_instance(corrected_.hidden, id) != nullptr; }

  void refuse_locked(InstanceId id) const {
    if (!corrected_.locked.contains(id)) return;
    for (const MapEdit& edit : effective_edits(found_.edits))
      if (edit.action == EditAction::kLock && edit.instances.front() == id)
        throw Error(
            concat("object ", id, " is locked; `ovimap edit MAP undo ", edit.id, "` unlocks it"));
  }

  static void check_name(const std::string& name) {
    const auto begins_letter = [](char byte) { return (byte & 0xc0) != 0x80; };  // of UTF-8
    const std::ptrdiff_t letters = std::count_if(name.begin(), name.end(), begins_letter);
    if (letters > kLongestName)
      throw Error(
          concat("a name of ", letters, " letters is too long; give at most ", kLongestName));
    if (!is_printable(name))
      throw Error("a name is one line of UTF-8 text; give one without control characters");
  }

  static void check_merge(std::vector<InstanceId> ids) {
    std::sort(ids.begin(), ids.end());
    const auto twice = std::adjacent_find(ids.begin(), ids.end());
    if (twice != ids.end())
      throw Error(concat("object ", *twice, " is named twice; name different ones"));
  }

  void complete_split(const InstanceSummary& whole, MapEdit& edit) const {
    const std::vector<Label>& has = whole.super_points;
    if (has.size() < 2)
      throw Error(
          concat("object ", whole.id, " is a single super-point, which cannot be taken apart"));
    std::vector<Label>& leaving = edit.super_points;
    std::sort(leaving.begin(), leaving.end());
    leaving.erase(std::unique(leaving.begin(), leaving.end()), leaving.end());
    for (const Label label : leaving)
      if (!std::binary_search(has.begin(), has.end(), label))
        throw Error(concat("object ", whole.id, " has no super-point ", label,
                           "; `ovimap info --json` lists those it has"));
    if (leaving.empty() || leaving.size() == has.size())
      throw Error(concat("some of the ", has.size(), " super-points of object ", whole.id,
                         " must leave and some must stay"));
    edit.new_instance = last_instance(found_) + 1;
  }

  void find_undone(MapEdit& edit) const {
    if (edit.undoes == 0) {
      const MapEdits effective = effective_edits(found_.edits);
      if (effective.empty()) throw Error("there is nothing to undo; the map is as it was found");
      edit.undoes = effective.back().id;
      return;
    }
    for (const MapEdit& other : found_.edits) {
      if (other.id != edit.undoes) continue;
      if (other.undone_by != 0)
        throw Error(concat("edit ", other.id, " is undone already; `undo ", other.undone_by,
                           "` brings it back"));
      return;
    }
    throw Error(concat("the map has no edit ", edit.undoes, "; `ovimap edit MAP log` lists them"));
  }

  const MapRecord& found_;
  const MapRecord& corrected_;
  InstanceAliases aliases_;
};

}  // namespace

MapEdit append_edit(MapRecord& found, const LabelForest& forest, const VoxelSource& voxels,
                    MapEdit edit) {
  MapRecord corrected = found;
  InstanceAliases aliases = apply_edits(corrected, forest, voxels);
  EditDesk(found, corrected, std::move(aliases)).complete(edit);
  edit.id = found.edits.empty() ? 1 : found.edits.back().id + 1;
  edit.undone_by = 0;
  if (edit.time_s == 0)
    edit.time_s =
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  found.edits.push_back(edit);
  mark_undone(found.edits);
  return edit;
}

}  // namespace ovimap
