// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <ctime>

#include "apps/command/command.h"
#include "apps/command/teach_option.h"
#include "ovimap/io/corrections/taught_file.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/search/teaching.h"

namespace ovimap::apps {

namespace {

struct EditOptions {
  std::filesystem::path map;
  MapEdit edit;
  InstanceId object = 0;
  std::vector<InstanceId> others;
  TeachOption teach;
  bool log = false;
  bool json = false;
};

std::string time_text(double time_s) {
  const auto seconds = static_cast<std::time_t>(std::floor(time_s));
  std::tm utc{};
  char text[32] = "?";
  if (::gmtime_r(&seconds, &utc)) std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

nlohmann::json edit_json(const MapEdit& edit) {
  return {{"id", edit.id},
          {"time", time_text(edit.time_s)},
          {"action", edit_action_name(edit.action)},
          {"arguments", nlohmann::json::parse(edit_arguments_json(edit))},
          {"undone_by", edit.undone_by == 0 ? nlohmann::json() : nlohmann::json(edit.undone_by)}};
}

/// Tells which of the objects that were named go by another number since they became one with it.
void print_aliases(const std::vector<InstanceId>& asked, const std::vector<InstanceId>& edited) {
  for (std::size_t i = 0; i < std::min(asked.size(), edited.size()); ++i)
    if (asked[i] != edited[i])
      std::printf("object %u is part of object %u by now\n", asked[i], edited[i]);
}

/// A number that an object or an edit can have.
CLI::Validator ordinal() {
  const auto fault = [](const std::string& text) {
    std::uint32_t number = 0;
    const bool is_number = CLI::detail::lexical_cast(text, number) && number > 0;
    return is_number ? std::string() : concat("'", text, "' is no number from 1 up");
  };
  return {fault, "NUMBER"};
}

void print_edit(const MapEdit& edit) {
  std::printf("%4lld  %s  %-6s %s", static_cast<long long>(edit.id), time_text(edit.time_s).c_str(),
              edit_action_name(edit.action), edit_arguments_json(edit).c_str());
  if (edit.undone_by != 0)
    std::printf("  (undone by %lld)", static_cast<long long>(edit.undone_by));
  std::printf("\n");
}

int print_log(const EditOptions& options) {
  const MapEdits log = read_edits(options.map);
  nlohmann::json list = nlohmann::json::array();
  for (const MapEdit& edit : log) {
    if (options.json)
      list.push_back(edit_json(edit));
    else
      print_edit(edit);
  }
  if (options.json) print_json({{"map", options.map.string()}, {"edits", list}});
  return kDone;
}

int edit_or_log(const EditOptions& options) {
  if (options.log) return print_log(options);
  MapEdit edit = options.edit;
  if (options.object != 0) edit.instances.push_back(options.object);
  edit.instances.insert(edit.instances.end(), options.others.begin(), options.others.end());
  const std::filesystem::path taught = options.teach.file();
  if (!taught.empty()) (void)read_taught_file(taught);  // rather refuse than half do it
  const std::vector<InstanceId> asked = edit.instances;
  edit = edit_map(options.map, edit);
  const std::size_t examples =
      taught.empty() ? 0 : teach(taught, options.map, open_map_search(options.map));
  if (!options.json) {
    print_edit(edit);
    print_aliases(asked, edit.instances);
    if (!taught.empty())
      std::printf("%zu named objects of this map teach others (%s)\n", examples, taught.c_str());
    return kDone;
  }
  print_json({{"map", options.map.string()},
              {"edit", edit_json(edit)},
              {"taught", taught.empty() ? nlohmann::json() : nlohmann::json(examples)},
              {"instances", read_map_info(options.map).instances.size()}});
  return kDone;
}

/// A subcommand that takes one object first.
CLI::App& add_action(CLI::App& command, EditOptions& options, EditAction action, const char* help) {
  CLI::App& sub = *command.add_subcommand(edit_action_name(action), help);
  sub.callback([&options, action] { options.edit.action = action; });
  if (action != EditAction::kUndo)
    sub.add_option("ID", options.object, "object, as `ovimap info` lists it")
        ->required()
        ->check(ordinal());
  sub.fallthrough();
  return sub;
}

}  // namespace

Action add_edit(CLI::App& command) {
  auto options = std::make_shared<EditOptions>();
  command.add_option("MAP", options->map, "map file")->required();
  add_teach_option(command, options->teach, "whether the named objects of this map teach others");
  command.add_flag("--json", options->json, "print one JSON object");
  command.require_subcommand(1);
  add_action(command, *options, EditAction::kRename, "give an object a name; \"\" takes it away")
      .add_option("NAME", options->edit.name, "one line of text")
      ->required();
  add_action(command, *options, EditAction::kMerge, "several objects are one, which keeps this ID")
      .add_option("OTHER", options->others, "objects that are the same thing")
      ->required();
  add_action(command, *options, EditAction::kSplit, "super-points leave and become a new object")
      .add_option("SUPERPOINT", options->edit.super_points,
                  "those that leave; `ovimap info --json` lists what an object has")
      ->required();
  add_action(command, *options, EditAction::kLock,
             "the object stays as it is, whatever more mapping says");
  add_action(command, *options, EditAction::kDelete, "it is no object; its surface is background");
  add_action(command, *options, EditAction::kHide, "leave it out of lists, answers and pictures");
  add_action(command, *options, EditAction::kUndo, "take an edit back, or take an undo back")
      .add_option("EDIT", options->edit.undoes, "its number in the log; the latest without it")
      ->check(ordinal());
  CLI::App& log = *command.add_subcommand("log", "what was edited, oldest first");
  log.callback([options] { options->log = true; });
  log.fallthrough();
  return [options] { return edit_or_log(*options); };
}

}  // namespace ovimap::apps
