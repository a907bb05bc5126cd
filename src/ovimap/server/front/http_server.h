// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/pipeline/live/frame_intake.h"
#include "ovimap/server/served/served_map.h"

namespace ovimap {

struct ServerConfig {
  std::string host = "127.0.0.1";       ///< address to bind
  int port = 8080;                      ///< 0: any free one
  std::string token;                    ///< who does not show it is refused; empty: nobody is asked
  std::vector<std::string> host_names;  ///< by which this machine is called beside its own ones
  std::filesystem::path tls_certificate, tls_key;  ///< PEM; empty: nothing is encrypted
  std::filesystem::path viewer;                    ///< folder of the web page; empty: none

  // Half as many where they are encrypted: an unfinished handshake takes 130 kB.
  int max_connections = 512;            ///< open at once; one that does little goes for a new one
  int max_connections_of_one = 256;     ///< of these, from one address
  std::size_t max_event_streams = 128;  ///< of these connections
  std::size_t max_event_streams_of_one = 32;
  std::size_t max_standing_queries = 4000;  ///< of all clients that watch for something
  std::size_t max_standing_queries_of_one = 2000;
  std::size_t max_body_bytes = 1 << 16;
  std::size_t max_frame_bytes = 32 << 20;  ///< of a body that carries a frame's images
  double requests_per_second = 400;        ///< of one address, on average
  double request_burst = 2000;             ///< ... and at once: a large map's chunks
  double work_per_second = 10;             ///< queries, corrections, exports, which cost the most
  double work_burst = 40;
  FrameSourceConfig frames;   ///< limits of the depth in pushed frames
  bool moves_frames = false;  ///< whether their poses can be corrected: the run keeps its frames
  int patience_s = 5;         ///< for a whole head, and for each piece of a body, read or written
  int idle_s = 5;             ///< that a connection rests between two requests

  bool encrypted() const { return !tls_certificate.empty(); }
};

/// Serves one map to browsers and programs (docs/http-api.md).
class HttpServer {
 public:
  /// Binds the port. `map` must outlive the server. Throws Error when the port is taken, the host
  /// is none of this machine's, other machines could reach it and no token is set, or the
  /// certificate cannot be used.
  /// `intake`: where frames go that clients push; null: they may not.
  HttpServer(ServedMap& map, const ServerConfig& config, FrameIntake* intake = nullptr);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;
  /// What to open in a browser, the token included.
  std::string address() const;

  /// Answers requests until stop() is called from another thread.
  void run();
  /// Ends event streams and run(). The map gives no events from then on.
  void stop();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ovimap
