// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "apps/command/teach_option.h"
#include "camera_run.h"
#include "ovimap/base/parallel.h"
#include "ovimap/inference/encoders/text_cache.h"
#include "ovimap/io/corrections/taught_file.h"
#include "ovimap/server/api/viewer_files.h"
#include "ovimap/server/http/access.h"
#include "run_report.h"
#include "serve_live.h"

namespace ovimap::apps {

namespace {

struct ServeOptions {
  std::string subject;  ///< the map, or with `live` the recording
  std::filesystem::path output, continued;
  MappingOptions mapping;
  ServerConfig server;
  ServedMapConfig served;
  std::string viewer = "auto";
  std::filesystem::path token_file;
  TeachOption teach;
  double fps = 30;
  bool live = false, resume = false, no_limits = false, json = false;

  /// Clients send the frames.
  bool pushed() const { return live && subject == "http"; }
  /// A camera sends them.
  bool plugged() const { return live && names_camera(subject); }
  std::filesystem::path map() const { return live ? output : std::filesystem::path(subject); }
};

std::filesystem::path viewer_folder(const std::string& option) {
  if (option != "auto") return option == "none" ? "" : option;
  return find_viewer(std::filesystem::read_symlink("/proc/self/exe"));
}

std::string first_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string text(4096, '\0');  // the line may have no end: /dev/zero
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.empty())
    throw Error(concat("'", file.string(), "' holds no token; write one line into it"));
  return text.substr(0, text.find_first_of("\r\n"));
}

/// Connections and sizes stay limited.
void lift_limits(ServerConfig& config) {
  constexpr double kMany = 1e9;
  config.requests_per_second = config.request_burst = kMany;
  config.work_per_second = config.work_burst = kMany;
}

/// One line: whoever waits for it reads lines.
void print_line(const nlohmann::json& value) {
  std::printf("%s\n", value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  std::fflush(stdout);
}

void announce(const ServeOptions& options, const HttpServer& server) {
  if (options.json)
    return print_line({{"map", options.map().string()},
                       {"address", server.address()},
                       {"port", server.port()},
                       {"viewer", !options.server.viewer.empty()}});
  if (options.server.viewer.empty() && options.viewer == "auto")
    std::fprintf(stderr,
                 "no viewer beside the program: install Node.js with npm and run `make "
                 "build`; the API works without\n");
  std::printf("%s is at %s (Ctrl-C %s)\n", options.map().c_str(), server.address().c_str(),
              options.live ? "saves it and ends" : "ends it");
  std::fflush(stdout);
}

int serve_live(ServeOptions options) {
  std::optional<CameraRun> camera;
  if (options.plugged()) camera.emplace(options.mapping);
  const ProgramConfig config = read_program_config(options.mapping);
  FrameIntake intake(static_cast<std::size_t>(config.live.queue));
  LiveService service{options.mapping,
                      {options.output, options.resume, options.continued},
                      options.fps,
                      options.server,
                      options.served};
  service.served.encoder = options.mapping.encoder;
  service.server.frames = config.source;
  if (options.mapping.poses == "track") service.server.frames.poses = PoseNeed::kNone;
  service.server.moves_frames = config.mapper.frame_store.max_mb > 0 && config.memory.max_mb == 0 &&
                                options.mapping.poses != "track" &&
                                options.mapping.poses != "refine";
  if (options.pushed()) service.intake = &intake;
  if (camera) service.intake = &camera->intake(), service.camera = &camera->feed();
  service.run([&](const HttpServer& server) { announce(options, server); },
              [&](const MappingRun& run) {
                const double fps = service.intake ? sent_fps(*run.live) : options.fps;
                report_faults(run);
                if (options.json)
                  print_line({{"saved", run_json(options.output, run, fps)}});
                else
                  print_run(options.output, run, fps);
                advise_on_objects(run);
                std::fflush(stdout);
              });
  return camera && !camera->report_loss() ? kAnswerIsNo : kDone;
}

void serve_map(const ServeOptions& options) {
  ServedMap map(options.map(), options.served);
  ServerThread thread(map, options.server);
  announce(options, thread.server());
  while (!interrupted() && thread.runs())
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

/// What --token, --token-file or OVIMAP_TOKEN say, in this order; a random one where other machines
/// are let in and none is given; empty: none.
std::string token_of(const ServeOptions& options) {
  const auto checked = [](std::string token) {
    check_token(token);
    return token;
  };
  const char* variable = std::getenv("OVIMAP_TOKEN");
  if (!options.server.token.empty()) return checked(options.server.token);
  if (!options.token_file.empty()) return checked(first_line(options.token_file));
  if (variable != nullptr && *variable != '\0') return checked(variable);
  return is_loopback(options.server.host) ? "" : random_token();
}

int serve(ServeOptions options) {
  options.served.cache = user_cache_folder();
  const ThreadLimit limit(options.mapping.threads);
  ServerConfig& config = options.server;
  config.token = token_of(options);
  config.viewer = viewer_folder(options.viewer);
  if (options.no_limits) lift_limits(config);
  options.mapping.source = options.subject;
  options.served.encoder = options.mapping.encoder;
  options.served.model_dirs = options.mapping.model_dirs;
  options.served.threads = options.mapping.threads;
  options.served.taught = options.teach.file();
  (void)read_taught_file(options.served.taught);  // says now what is wrong with it
  if (options.pushed() && options.mapping.frames != ":")
    throw Error("--frames chooses frames of a recording; leave it away where clients send them");
  if (options.output.empty()) options.output = options.continued;
  if (options.live && options.output.empty())
    throw Error("say where the map goes with --output, or which one to go on with by --continue");
  watch_for_interrupt();
  if (options.live) return serve_live(std::move(options));
  serve_map(options);
  return kDone;
}

/// Who may ask, and how they reach the server.
void add_access_options(CLI::App& command, ServeOptions& options) {
  auto* token = command.add_option(
      "--token", options.server.token,
      "what clients must show; without any a random one where other machines are let in, none "
      "otherwise. Other users of this machine see it in the list of programs: prefer --token-file, "
      "or the variable OVIMAP_TOKEN");
  command.add_option("--token-file", options.token_file, "file whose first line is the token")
      ->check(CLI::ExistingFile)
      ->excludes(token);
  command.add_option("--host-name", options.server.host_names,
                     "name by which clients call this machine, without port; localhost and "
                     "loopback addresses are always taken, with a token any name is. Repeatable");
  auto* certificate =
      command.add_option("--tls-cert", options.server.tls_certificate,
                         "certificate with its chain, PEM: the server speaks HTTPS alone");
  auto* key = command.add_option("--tls-key", options.server.tls_key, "its private key, PEM");
  certificate->needs(key);
  key->needs(certificate);
}

/// What makes sense while a map is made alone.
void add_live_options(CLI::App& command, ServeOptions& options) {
  auto* live =
      command.add_flag("--live", options.live,
                       "map the recording MAP names, at a camera's pace, and serve the map "
                       "meanwhile");
  command
      .add_option(
          "-o,--output", options.output,
          "map file that --live writes; with --continue the map itself where it is not given")
      ->needs(live);
  command
      .add_option("--continue", options.continued,
                  "a map of the same place that --live goes on with (docs/changes.md)")
      ->needs(live);
  command.add_option("--fps", options.fps, "that pace, frames a second")
      ->check(CLI::Range(0.1, 1000.))
      ->needs(live)
      ->capture_default_str();
  command
      .add_flag("--resume", options.resume,
                "go on with the frames that a killed run, or the map, does not have yet")
      ->needs(live);
  add_mapping_settings(command, options.mapping);
  add_poses(command, options.mapping);
  for (const char* name : {"--masks", "--recognizer", "--preset", "--views", "--config", "--set",
                           "--frames", "--poses", "--people"})
    command.get_option(name)->needs(live);
}

}  // namespace

Action add_serve(CLI::App& command) {
  auto options = std::make_shared<ServeOptions>();
  command
      .add_option("MAP", options->subject,
                  "map file; with --live a recording, openni: for a camera, or http: frames that "
                  "clients send "
                  "(docs/live.md)")
      ->required();
  command.add_option("--port", options->server.port, "port to listen at; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command
      .add_option("--host", options->server.host,
                  "address to listen at; 0.0.0.0: other machines too, who then need the token")
      ->capture_default_str();
  add_access_options(command, *options);
  command.add_option("--viewer", options->viewer, "folder of the web page; auto, or none")
      ->capture_default_str();
  command
      .add_option("--classes", options->served.classes,
                  "names to guess from: replica51, scannet200, scannet20 or a text file with one a "
                  "line")
      ->capture_default_str();
  add_teach_option(command, options->teach,
                   "whether what people name here teaches other maps, and they this one");
  add_live_options(command, *options);
  command.add_flag("--no-limits", options->no_limits,
                   "answer as often as one asks: for tests, and where everybody is trusted");
  command.add_flag("--json", options->json, "print one JSON object once the map can be reached");
  return [options] { return serve(*options); };
}

}  // namespace ovimap::apps
