// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/corrections/map_edit_log.h"

#include <array>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "ovimap/io/map_tables/map_file_rows.h"

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

[[noreturn]] void fail_to_take() {
  throw Error("table edits holds arguments that are not readable");
}

/// Numbers out of range must not wrap around to others.
template <class Number>
void take(const Json& json, Number& value) {
  const auto number = json.is_number_integer() ? json.get<std::int64_t>() : -1;
  if (!std::in_range<Number>(number) || number < 0) fail_to_take();
  value = static_cast<Number>(number);
}
void take(const Json& json, std::string& value) {
  json.get_to(value);
}
template <class Number>
void take(const Json& json, std::vector<Number>& values) {
  if (!json.is_array()) fail_to_take();
  for (const Json& item : json) take(item, values.emplace_back());
}

void take_arguments(const std::string& text, MapEdit& edit) {
  try {
    const Json arguments = Json::parse(text);
    if (!arguments.is_object()) fail_to_take();
    visit_arguments(edit, [&](const char* key, auto& value) {
      if (arguments.contains(key)) take(arguments.at(key), value);
    });
  } catch (const Json::exception&) {
    fail_to_take();
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

MapEdits effective_edits(const MapEdits& log) {
  MapEdits marked = log;
  mark_undone(marked);
  std::erase_if(marked, [](const MapEdit& edit) {
    return edit.undone_by != 0 || edit.action == EditAction::kUndo;
  });
  return marked;
}

std::set<InstanceId> corrected_instances(const MapEdits& log, const InstanceAliases& aliases) {
  std::set<InstanceId> corrected;
  for (const MapEdit& edit : effective_edits(log))
    for (const InstanceId id : edit.instances) corrected.insert(resolve_alias(aliases, id));
  return corrected;
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
  if (!holds_table(database, map_tables::kEdits)) return log;
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
    if (log[i].instances.empty() && log[i].action != EditAction::kUndo)
      throw Error(concat("table edits holds an edit ", log[i].id, " of no object"));
  }
  return log;
}

}  // namespace ovimap
