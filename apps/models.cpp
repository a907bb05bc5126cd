// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "command.h"
#include "ovimap/inference/models/model_folder.h"

namespace ovimap::apps {

namespace {

struct ModelsOptions {
  std::string name;
  std::vector<std::filesystem::path> model_dirs;
  bool json = false;
};

int list(const ModelsOptions& options) {
  nlohmann::json rows = nlohmann::json::array();
  for (const ModelListing& model : list_models(model_search_path(options.model_dirs))) {
    rows.push_back({{"name", model.name},
                    {"kind", model.kind},
                    {"folder", model.folder.string()},
                    {"fault", model.fault}});
    if (!options.json)
      std::printf("%-20s %-14s %s\n", model.name.c_str(),
                  model.kind.empty() ? "broken" : model.kind.c_str(),
                  model.fault.empty() ? model.folder.c_str() : model.fault.c_str());
  }
  if (options.json) print_json({{"models", rows}});
  return rows.empty() ? kAnswerIsNo : kDone;
}

int verify(const ModelsOptions& options) {
  const ModelFolder model =
      read_model_folder(find_model(options.name, model_search_path(options.model_dirs)));
  verify_model_files(model);
  if (options.json)
    print_json({{"name", options.name}, {"folder", model.folder.string()}, {"verdict", "ok"}});
  else
    std::printf("%s: all files are as model.yaml says\n", model.folder.c_str());
  return kDone;
}

int path(const ModelsOptions& options) {
  nlohmann::json folders = nlohmann::json::array();
  for (const std::filesystem::path& folder : model_search_path(options.model_dirs)) {
    folders.push_back(folder.string());
    if (!options.json) std::printf("%s\n", folder.c_str());
  }
  if (options.json) print_json({{"path", folders}});
  return kDone;
}

}  // namespace

Action add_models(CLI::App& command) {
  auto options = std::make_shared<ModelsOptions>();
  auto action = std::make_shared<Action>();
  command.require_subcommand(1);
  add_model_dirs(command, options->model_dirs);
  command.add_flag("--json", options->json, "print one JSON object");
  command.add_subcommand("list", "models that can be found")->fallthrough()->callback([=] {
    *action = [=] { return list(*options); };
  });
  CLI::App* verify_command =
      command.add_subcommand("verify", "check a model's files against its description")
          ->fallthrough();
  verify_command->add_option("MODEL", options->name, "name or folder of a model")->required();
  verify_command->callback([=] { *action = [=] { return verify(*options); }; });
  command.add_subcommand("path", "where models are looked for")->fallthrough()->callback([=] {
    *action = [=] { return path(*options); };
  });
  return [action] { return (*action)(); };
}

}  // namespace ovimap::apps
