// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/models/models_fetch.h"
#include "program.h"

namespace ovimap::apps {

namespace {

struct DemoOptions {
  std::filesystem::path folder = "demo";
  std::string masks = "sam";
  bool view = false;
};

/// The demo is what a user would type, and shows it.
class Steps {
 public:
  /// False once a step failed, whose fault was printed; the others are left out.
  bool step(const char* title, const std::vector<std::string>& arguments, int worst = kDone) {
    if (code_ != kDone) return false;
    std::string line = "ovimap";
    for (const std::string& argument : arguments)
      line += argument.find(' ') == std::string::npos ? " " + argument : " \"" + argument + "\"";
    std::printf("\n== %s\n$ %s\n", title, line.c_str());
    std::fflush(stdout);
    const int code = Program().run(arguments);
    if (code > worst) code_ = code;
    return code_ == kDone;
  }
  int code() const { return code_; }

 private:
  int code_ = kDone;
};

void say_how_to_go_on(const std::string& folder, const std::string& map) {
  std::printf(
      "\nLook at   %s/report.html in a browser, the pictures in %s/pictures\n"
      "See       ovimap serve %s\n"
      "Ask       ovimap query %s \"a place for books\" \"largest cabinet\"\n"
      "Go on     ovimap check YOUR_RECORDING              is anything wrong with it?\n"
      "          ovimap run YOUR_RECORDING -o my.ovimap   depth alone, real time\n"
      "          ovimap run YOUR_RECORDING --masks sam -o my.ovimap\n",
      folder.c_str(), folder.c_str(), map.c_str(), map.c_str());
  if (const std::string better = better_encoder(); !better.empty())
    std::printf("Better    words: %s\n", better.c_str());
}

int demo(const DemoOptions& options) {
  const auto path = [&](const char* name) { return (options.folder / name).string(); };
  const std::string room = path("tiny/room"), map = path("tiny.ovimap");
  Steps steps;
  if (options.masks == "sam" && lacks_default())
    steps.step("fetching the small models, once", {"models", "fetch", kDefaultModels});
  steps.step("rendering a furnished room", {"synth", path("tiny"), "--room", "tiny"});
  steps.step("mapping it, with masks on every second frame",
             {"run", room, "--masks", options.masks, "--set", "mask_interval=2", "-o", map,
              "--pictures", path("pictures")});
  steps.step("objects in the map", {"info", map});
  steps.step("finding objects by name",
             {"query", map, "sofa", "lamp", "chair", "elephant", "--top", "1"}, kAnswerIsNo);
  steps.step("a page about it", {"report", map, path("report.html")});
  steps.step("how good it is: the rendered room comes with the truth", {"eval", map, "--gt", room});
  if (steps.code() != kDone) return steps.code();
  say_how_to_go_on(options.folder.string(), map);
  if (options.view) steps.step("in the browser", {"serve", map});
  return steps.code();
}

}  // namespace

Action add_demo(CLI::App& command) {
  auto options = std::make_shared<DemoOptions>();
  command.add_option("FOLDER", options->folder, "where everything goes")->capture_default_str();
  command.add_option("--masks", options->masks, "2D masks: sam, gt (the truth) or a model")
      ->capture_default_str();
  command.add_flag("--view", options->view, "then show the map in the browser");
  return [options] { return demo(*options); };
}

}  // namespace ovimap::apps
