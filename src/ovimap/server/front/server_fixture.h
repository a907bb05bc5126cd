// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <thread>

#include <nlohmann/json.hpp>

#include "ovimap/server/front/http_client_fixture.h"
#include "ovimap/server/front/http_server.h"

namespace ovimap::fixture {

/// A server on a free port of this machine, in a thread of its own. It listens from the beginning.
class RunningServer {
 public:
  RunningServer(const std::filesystem::path& map, ServerConfig config,
                const ServedMapConfig& served, FrameIntake* intake = nullptr)
      : map_(map, served), server_(map_, with_free_port(std::move(config)), intake) {
    thread_ = std::thread([this] { server_.run(); });
  }
  ~RunningServer() {
    server_.stop();
    thread_.join();
  }

  int port() const { return server_.port(); }
  const HttpServer& server() const { return server_; }
  ServedMap& map() { return map_; }
  HttpClient client(const char* from = "127.0.0.1") const { return HttpClient(port(), from); }

 private:
  static ServerConfig with_free_port(ServerConfig config) {
    config.port = 0;
    return config;
  }
  ServedMap map_;
  HttpServer server_;
  std::thread thread_;
};

}  // namespace ovimap::fixture
