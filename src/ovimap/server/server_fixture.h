// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <thread>

#include <httplib.h>
#include <nlohmann/json.hpp>

#include "ovimap/server/http_server.h"

namespace ovimap::fixture {

/// A server on a free port of this machine, in a thread of its own.
class RunningServer {
 public:
  RunningServer(const std::filesystem::path& map, ServerConfig config,
                const ServedMapConfig& served, FrameIntake* intake = nullptr)
      : map_(map, served), server_(map_, with_free_port(std::move(config)), intake) {
    thread_ = std::thread([this] { server_.run(); });
    while (!answers()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ~RunningServer() {
    server_.stop();
    thread_.join();
  }

  int port() const { return server_.port(); }
  const HttpServer& server() const { return server_; }
  ServedMap& map() { return map_; }
  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port());
    client.set_read_timeout(20);
    return client;
  }

 private:
  static ServerConfig with_free_port(ServerConfig config) {
    config.port = 0;
    return config;
  }
  bool answers() const { return static_cast<bool>(client().Get("/api/map")); }

  ServedMap map_;
  HttpServer server_;
  std::thread thread_;
};

/// A connection that says whatever a test wants it to, HTTP or not.
class RawConnection {
 public:
  explicit RawConnection(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    timeval patience{10, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~RawConnection() { ::close(socket_); }
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;

  bool connected() const { return connected_; }
  void send(const std::string& bytes) const {
    (void)!::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  /// What comes first, at most 64 KiB; empty: nothing, or the connection was closed.
  std::string receive() const {
    std::string bytes(1 << 16, '\0');
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }

 private:
  int socket_;
  bool connected_ = false;
};

}  // namespace ovimap::fixture
