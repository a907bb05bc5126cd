// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "ovimap/server/access.h"
#include "ovimap/server/frame_api.h"
#include "ovimap/server/http_message.h"
#include "ovimap/server/http_server.h"
#include "ovimap/server/viewer_files.h"

namespace ovimap {

/// All that happens to a request once its bytes are read, from who may ask to what is sent: access,
/// limits, files or routes, ETag, compression, headers. Thread-safe.
class RequestDesk {
 public:
  RequestDesk(ServedMap& map, const ServerConfig& config, FrameIntake* intake);

  /// The refusal of a request of which only the head was read: a body may be large, so who may not
  /// send it is told before. Nothing where the body is to be read.
  std::optional<HttpReply> early_refusal(const HttpRequest& head) const;
  HttpReply answer(const HttpRequest& request);

 private:
  std::size_t most_bytes(const HttpRequest& request) const;
  HttpReply find_reply(const HttpRequest& request);
  HttpReply counted_stream(HttpReply reply);

  const ServerConfig config_;
  const AccessRule access_;
  const ViewerFiles files_;
  FrameApi frames_;
  const Router api_;
  RateLimit requests_, work_;
  std::shared_ptr<std::atomic<int>> streams_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace ovimap
