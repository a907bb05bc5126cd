// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "ovimap/server/api/frame_api.h"
#include "ovimap/server/api/viewer_files.h"
#include "ovimap/server/front/http_server.h"
#include "ovimap/server/http/access.h"
#include "ovimap/server/http/http_message.h"
#include "ovimap/server/http/sent_bodies.h"
#include "ovimap/server/http/shares.h"
#include "ovimap/server/served/standing_queries.h"

namespace ovimap {

/// All that happens to a request once its bytes are read, from who may ask to what is sent: access,
/// limits, files or routes, ETag, compression, headers. Thread-safe.
class RequestDesk {
 public:
  RequestDesk(ServedMap& map, const ServerConfig& config, FrameIntake* intake);

  /// What the head of a request is enough to decide.
  struct Decision {
    std::optional<HttpReply> refusal;  ///< nothing: the body is to be read, then answer() is asked
    /// Of a refusal: the client did nothing wrong, so the body is read, if only to drop it, and the
    /// next request may follow.
    bool reads_on = false;
    RouteCost cost = RouteCost::kLittle;
    std::shared_ptr<void> place = nullptr;  ///< the body's, kept until the request is answered
  };
  Decision early(const HttpRequest& head);

  /// Of a request that early() let pass.
  HttpReply answer(const HttpRequest& request);

  /// A refusal as it is sent.
  static HttpReply refused(HttpReply reply);

 private:
  Decision find_decision(const HttpRequest& head);
  std::optional<HttpReply> misfit(const HttpRequest& head, BodyType body) const;
  std::optional<HttpReply> shortage(const HttpRequest& head, const Route& route,
                                    std::shared_ptr<void>& place);
  HttpReply find_reply(const HttpRequest& request);
  void compress(const HttpRequest& request, HttpReply& reply);
  HttpReply counted_stream(const HttpRequest& request, HttpReply reply);

  const ServerConfig config_;
  const AccessRule access_;
  const ViewerFiles files_;
  FrameApi frames_;
  StandingQueries standing_;
  const Router api_;
  RateLimit requests_, work_;
  SentBodies sent_;
  Shares streams_, body_bytes_, frame_bytes_;
};

}  // namespace ovimap
