// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <thread>

#include "command.h"
#include "ovimap/base/parallel.h"
#include "ovimap/server/access.h"
#include "ovimap/server/http_server.h"
#include "ovimap/server/viewer_files.h"

namespace ovimap::apps {

namespace {

struct ServeOptions {
  std::filesystem::path map;
  ServerConfig server;
  ServedMapConfig served;
  std::string viewer = "auto";
  bool no_limits = false, json = false;
};

std::filesystem::path viewer_folder(const std::string& option) {
  if (option != "auto") return option == "none" ? "" : option;
  return find_viewer(std::filesystem::read_symlink("/proc/self/exe"));
}

/// Connections and sizes stay limited.
void lift_limits(ServerConfig& config) {
  constexpr double kMany = 1e9;
  config.requests_per_second = config.request_burst = kMany;
  config.work_per_second = config.work_burst = kMany;
}

void announce(const ServeOptions& options, const HttpServer& server) {
  if (options.json) {
    const nlohmann::json said = {{"map", options.map.string()},
                                 {"address", server.address()},
                                 {"port", server.port()},
                                 {"viewer", !options.server.viewer.empty()}};
    std::printf("%s\n", said.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
                            .c_str());  // one line: whoever waits for it reads lines
  } else {
    if (options.server.viewer.empty() && options.viewer == "auto")
      std::fprintf(stderr,
                   "no viewer beside the program: install Node.js with npm and run `make "
                   "build`; the API works without\n");
    std::printf("%s is at %s (Ctrl-C ends it)\n", options.map.c_str(), server.address().c_str());
  }
  std::fflush(stdout);
}

int serve(ServeOptions options) {
  const ThreadLimit limit(options.served.threads);
  ServerConfig& config = options.server;
  if (config.token.empty() && !is_loopback(config.host)) config.token = random_token();
  config.viewer = viewer_folder(options.viewer);
  if (options.no_limits) lift_limits(config);
  ServedMap map(options.map, options.served);
  HttpServer server(map, config);
  watch_for_interrupt();
  std::jthread ender([&server](const std::stop_token& ended) {
    while (!interrupted() && !ended.stop_requested())
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    server.stop();
  });
  announce(options, server);
  server.run();
  return kDone;
}

}  // namespace

Action add_serve(CLI::App& command) {
  auto options = std::make_shared<ServeOptions>();
  command.add_option("MAP", options->map, "map file")->required();
  command.add_option("--port", options->server.port, "port to listen at; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command
      .add_option("--host", options->server.host,
                  "address to listen at; 0.0.0.0: other machines too, who then need the token")
      ->capture_default_str();
  command.add_option("--token", options->server.token,
                     "what clients must show; without it a random one where other machines are let "
                     "in, none otherwise");
  command.add_option("--viewer", options->viewer, "folder of the web page; auto, or none")
      ->capture_default_str();
  command
      .add_option("--encoder", options->served.encoder,
                  "what understands queries: auto (the map's own), none, default, or a model")
      ->capture_default_str();
  command
      .add_option("--classes", options->served.classes,
                  "names to guess from: replica51, scannet200, scannet20 or a text file with one a "
                  "line")
      ->capture_default_str();
  add_model_dirs(command, options->served.model_dirs);
  command.add_option("--threads", options->served.threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--no-limits", options->no_limits,
                   "answer as often as one asks: for tests, and where everybody is trusted");
  command.add_flag("--json", options->json, "print one JSON object once the map can be reached");
  return [options] { return serve(*options); };
}

}  // namespace ovimap::apps
