// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_edit_log.h"

#include <array>
#include <map>

#include <nlohmann/json.hpp>

#include "ovimap/io/map_file_rows.h"

namespace ovimap {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kNames = {"rename", "merge", "split", "lock", "delete", "hide", "undo"};

/// The words of an edit, by a name each.
template <class Edit, class Visit>
void visit_arguments(Edit& edit, Visit&& visit) {
  visit("instances", edit.instances);
  visit("name", edit.name);
  visit("super_points", edit.super_points);
  visit("new_instance", edit.new_instance);
  visit("undoes", edit.undoes);
  visit("note", edit.note);
}

EditAction action_of(const std::string& name) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (name == kNames[i]) return static_cast<EditAction>(i);
  throw Error("table edits holds an action '" + name + "' that this program does not know");
}

void take_arguments(const std::string& text, MapEdit& edit) {
  try {
    const Json arguments = Json::parse(text);
    visit_arguments(edit, [&](const char* key, auto& value) {
      if (arguments.contains(key)) arguments.at(key).get_to(value);
    });
  } catch (const Json::exception&) {
    throw Error("table edits holds arguments that are not readable");
  }
}

}  // namespace

const char* edit_action_name(EditAction action) {
  return kNames[static_cast<std::size_t>(action)];
}

std::string edit_arguments_json(const MapEdit& edit) {
  Json arguments = Json::object();
  const MapEdit plain;
  visit_arguments(edit, [&](const char* key, const auto& value) {
    if (value != std::decay_t<decltype(value)>{}) arguments[key] = value;
  });
  if (edit.action == EditAction::kRename) arguments["name"] = edit.name;  // empty: taken away
  return arguments.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_utf8(const std::string& text) {
  try {
    (void)Json(text).dump();
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

MapEdits effective_edits(const MapEdits& log) {
  MapEdits marked = log;
  mark_undone(marked);
  std::erase_if(marked, [](const MapEdit& edit) {
    return edit.undone_by != 0 || edit.action == EditAction::kUndo;
  });
  return marked;
}

void mark_undone(MapEdits& log) {
  std::map<std::int64_t, std::int64_t> undone_by;
  for (auto edit = log.rbegin(); edit != log.rend(); ++edit) {
    const auto found = undone_by.find(edit->id);
    edit->undone_by = found == undone_by.end() ? 0 : found->second;
    if (edit->action == EditAction::kUndo && edit->undone_by == 0)
      undone_by[edit->undoes] = edit->id;
  }
}

void write_edits(SQLite::Database& database, const MapEdits& log) {
  RowWriter rows(database, map_tables::kEdits);
  for (const MapEdit& edit : log)
    rows.insert(edit.id, edit.time_s, std::string(edit_action_name(edit.action)),
                edit_arguments_json(edit), edit.undone_by);
  rows.finish();
}

MapEdits read_edits(SQLite::Database& database) {
  MapEdits log;
  if (!has_table(database, map_tables::kEdits)) return log;
  std::vector<std::pair<std::string, std::string>> texts;  // read once the table is verified
  RowReader rows(database, map_tables::kEdits);
  while (rows.next()) {
    MapEdit edit;
    edit.id = rows.integer<std::int64_t>();
    edit.time_s = rows.real();
    std::string action = rows.text();
    texts.emplace_back(std::move(action), rows.text());
    edit.undone_by = rows.integer<std::int64_t>();
    log.push_back(std::move(edit));
  }
  for (std::size_t i = 0; i < log.size(); ++i) {
    log[i].action = action_of(texts[i].first);
    take_arguments(texts[i].second, log[i]);
  }
  return log;
}

}  // namespace ovimap
