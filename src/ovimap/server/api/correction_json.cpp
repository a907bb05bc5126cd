// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/correction_json.h"

#include <array>

#include "ovimap/server/http/request_body.h"

namespace ovimap {

namespace {

using nlohmann::json;

constexpr std::array kActions = {EditAction::kRename, EditAction::kMerge,  EditAction::kSplit,
                                 EditAction::kLock,   EditAction::kDelete, EditAction::kHide,
                                 EditAction::kUndo};

EditAction action_of(const json& body) {
  const std::string kind = field<std::string>(body, "kind").value_or("");
  for (const EditAction action : kActions)
    if (kind == edit_action_name(action)) return action;
  throw BadRequest(400, "'kind' is one of rename, merge, split, lock, delete, hide, undo");
}

InstanceId id_field(const json& body, const char* name, const char* meaning) {
  const auto id = field<InstanceId>(body, name);
  if (!id || *id == 0) throw BadRequest(400, concat("'", name, "' is missing: ", meaning));
  return *id;
}

void take_name(const json& body, MapEdit& edit) {
  check_keys(body, {"kind", "instance", "name"});
  if (!body.contains("name"))
    throw BadRequest(400, "'name' is missing; an empty one takes the name away");
  edit.name = *field<std::string>(body, "name");
}

}  // namespace

MapEdit edit_of(const json& body) {
  MapEdit edit;
  edit.action = action_of(body);
  if (edit.action == EditAction::kUndo) {
    check_keys(body, {"kind", "edit"});
    edit.undoes = field<std::int64_t>(body, "edit").value_or(0);
    return edit;
  }
  edit.instances = {id_field(body, "instance", "the id of an object")};
  switch (edit.action) {
    case EditAction::kRename:
      take_name(body, edit);
      break;
    case EditAction::kMerge:
      check_keys(body, {"kind", "instance", "into"});
      edit.instances.insert(edit.instances.begin(),
                            id_field(body, "into", "the id of the object that stays"));
      break;
    case EditAction::kSplit:
      check_keys(body, {"kind", "instance", "super_points"});
      edit.super_points = numbers_field<Label>(body, "super_points");
      break;
    default:
      check_keys(body, {"kind", "instance"});
  }
  return edit;
}

json edit_json(const MapEdit& edit) {
  json line = json::parse(edit_arguments_json(edit));
  line["id"] = edit.id;
  line["kind"] = edit_action_name(edit.action);
  line["time_s"] = edit.time_s;
  line["undone_by"] = edit.undone_by == 0 ? json() : json(edit.undone_by);
  return line;
}

}  // namespace ovimap
