// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "mapping_run.h"
#include "ovimap/server/front/http_server.h"

namespace ovimap::apps {

/// Called once the map can be reached.
using Announce = std::function<void(const HttpServer&)>;

/// A server that answers in a thread of its own. Ends with the object.
class ServerThread {
 public:
  ServerThread(ServedMap& map, const ServerConfig& config, FrameIntake* intake = nullptr);
  ~ServerThread();

  const HttpServer& server() const { return server_; }
  /// Whether it still answers. Throws Error when it ended by itself.
  bool runs();

 private:
  HttpServer server_;
  std::future<void> running_;
};

/// Maps a recording at a camera's pace, a camera, or what clients push, and serves the map
/// meanwhile; then saves it and goes on serving until Ctrl-C. Ctrl-C before that saves what was
/// mapped and ends it. Returns what was mapped, its document given to the served map.
struct LiveService {
  MappingOptions mapping;
  RunTarget target;
  double fps = 30;
  ServerConfig server;
  ServedMapConfig served;
  FrameIntake* intake = nullptr;  ///< frames from there, instead of a recording's
  CameraFeed* camera = nullptr;   ///< feeds the intake; null: clients push into it

  /// `saved`: called when the map is in its file.
  void run(const Announce& announce, const std::function<void(const MappingRun&)>& saved) const;
};

}  // namespace ovimap::apps
