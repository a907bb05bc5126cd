// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "models_fetch.h"
#include "ovimap/inference/models/model_folder.h"

namespace ovimap::apps {

namespace {

double megabytes_in(const std::filesystem::path& folder) {
  constexpr double kBytesPerMb = 1e6;
  double bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return bytes / kBytesPerMb;
}

std::string remark(const ModelListing& model, const std::string& preferred) {
  std::string text = model.variant.empty() ? "" : ", " + model.variant;
  if (model.name == preferred && model.kind == "dual_encoder") text += ", taken by --encoder auto";
  if (model.doubtful) text += ", its self-test failed";
  return text;
}

nlohmann::json list_installed(const FetchOptions& options, const std::string& preferred) {
  nlohmann::json rows = nlohmann::json::array();
  for (const ModelListing& model : list_models(model_search_path(options.model_dirs))) {
    const double size_mb = megabytes_in(model.folder);
    rows.push_back({{"name", model.name},
                    {"kind", model.kind},
                    {"folder", model.folder.string()},
                    {"size_mb", size_mb},
                    {"variant", model.variant},
                    {"doubtful", model.doubtful},
                    {"fault", model.fault}});
    if (options.json) continue;
    if (model.fault.empty())
      std::printf("%-20s %-14s %6.0f MB  %s%s\n", model.name.c_str(), model.kind.c_str(), size_mb,
                  model.folder.c_str(), remark(model, preferred).c_str());
    else
      std::printf("%-20s %-14s %s\n", model.name.c_str(), "broken", model.fault.c_str());
  }
  return rows;
}

std::string sizes_text(const CatalogueEntry& entry) {
  std::string text;
  for (const ModelVariant& variant : model_variants())
    if (const auto size = entry.size_mb.find(variant.name); size != entry.size_mb.end())
      text += concat(text.empty() ? "" : ", ", variant.name, " ", size->second, " MB");
  return text;
}

nlohmann::json list_fetchable(const FetchOptions& options) {
  nlohmann::json rows = nlohmann::json::array();
  if (!options.json) std::puts("\ncan be fetched with `ovimap models fetch NAME`:");
  for (const CatalogueEntry& entry : read_catalogue(options.catalogue)) {
    rows.push_back({{"name", entry.name},
                    {"kind", entry.kind},
                    {"repository", entry.repository},
                    {"size_mb", entry.size_mb},
                    {"license", entry.license},
                    {"good_for", entry.good_for},
                    {"documentation", entry.documentation},
                    {"tried", entry.tried}});
    if (!options.json)
      std::printf("%-20s %-14s %s; %s; %s%s\n", entry.name.c_str(), entry.kind.c_str(),
                  entry.good_for.c_str(), sizes_text(entry).c_str(), entry.license.c_str(),
                  entry.tried ? "" : "; not tried here");
  }
  return rows;
}

int list(const FetchOptions& options) {
  const std::string preferred = preferred_encoder(options.model_dirs);
  const nlohmann::json installed = list_installed(options, preferred),
                       fetchable = list_fetchable(options);
  if (options.json)
    print_json({{"models", installed}, {"fetchable", fetchable}, {"auto", preferred}});
  return installed.empty() ? kAnswerIsNo : kDone;
}

int verify(const FetchOptions& options) {
  const ModelFolder model =
      read_model_folder(find_model(options.name, model_search_path(options.model_dirs)));
  verify_model_files(model);
  if (options.json)
    print_json({{"name", options.name}, {"folder", model.folder.string()}, {"verdict", "ok"}});
  else
    std::printf("%s: all files are as model.yaml says\n", model.folder.c_str());
  return kDone;
}

int path(const FetchOptions& options) {
  nlohmann::json folders = nlohmann::json::array();
  for (const std::filesystem::path& folder : model_search_path(options.model_dirs)) {
    folders.push_back(folder.string());
    if (!options.json) std::printf("%s\n", folder.c_str());
  }
  if (options.json) print_json({{"path", folders}});
  return kDone;
}

void add_fetch(CLI::App& command, FetchOptions& options, std::function<void()> chosen) {
  CLI::App* fetch_command =
      command.add_subcommand("fetch", "get a model from the model hub")->fallthrough();
  fetch_command
      ->add_option("MODEL", options.name,
                   "name in the catalogue: see list; default: what ovimap itself brings")
      ->required();
  fetch_command
      ->add_option("--variant", options.variant,
                   "full, fp16 (half the size) or quantized (a quarter; other words)")
      ->capture_default_str();
  fetch_command->add_option("--as", options.as, "another name for its folder");
  fetch_command->callback(std::move(chosen));
}

void add_try(CLI::App& command, const std::shared_ptr<FetchOptions>& shared,
             const std::shared_ptr<Action>& action) {
  auto options = std::make_shared<TryOptions>();
  CLI::App* try_command =
      command.add_subcommand("try", "how near a picture is to texts")->fallthrough();
  try_command->add_option("MODEL", options->model, "an encoder")->required();
  try_command->add_option("PICTURE", options->picture, "PNG or JPEG")->required();
  try_command->add_option("TEXT", options->texts, "texts, as they are")->required();
  try_command->callback([=] {
    *action = [=] {
      options->model_dirs = shared->model_dirs;
      options->json = shared->json;
      return try_model(*options);
    };
  });
}

}  // namespace

Action add_models(CLI::App& command) {
  auto options = std::make_shared<FetchOptions>();
  auto action = std::make_shared<Action>();
  command.require_subcommand(1);
  add_model_dirs(command, options->model_dirs);
  command.add_flag("--json", options->json, "print one JSON object");
  command.add_option("--catalogue", options->catalogue, "YAML file instead of the built-in one");
  one_value(command.add_option("--set", options->settings,
                               "patience with the network, such as hub.attempts=10"));
  command.add_subcommand("list", "models that are there, and those that can be fetched")
      ->fallthrough()
      ->callback([=] { *action = [=] { return list(*options); }; });
  add_fetch(command, *options, [=] { *action = [=] { return fetch(*options); }; });
  add_try(command, options, action);
  command.add_subcommand("hub", "whether the model hub answers")->fallthrough()->callback([=] {
    *action = [=] { return hub_answers(*options); };
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
