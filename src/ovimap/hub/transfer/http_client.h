// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "ovimap/hub/transfer/hub_config.h"

namespace ovimap {

/// What came before the body.
struct HttpHead {
  long status = 0;         ///< 0: no answer came
  std::uint64_t from = 0;  ///< the body's first byte in the whole: 0 but for status 206
};

struct TransferReply {
  HttpHead head;
  std::string fault;  ///< why the transfer broke; empty when the body came whole
  std::optional<double> retry_after_s;
  std::string next_url;  ///< of the header `Link: <URL>; rel="next"`; empty without one
};

/// Takes the next bytes of a body of status 200 or 206. False ends the transfer.
using ByteSink = std::function<bool(const HttpHead& head, std::span<const char> bytes)>;

/// "https://host:443" of an address; empty when it is none of http or https.
std::string origin_of(const std::string& url);

/// GET over libcurl. Redirects are followed, never from https to http; the token goes to its own
/// origin alone, so that where a hub sends a client on to never sees it. Proxies are those of the
/// environment (https_proxy, no_proxy).
class TransferClient {
 public:
  TransferClient(const HubConfig& config, const HubAccess& access);
  ~TransferClient();

  /// Asks for the bytes of `url` from `first_byte` on. `keep_going` is asked about once a second;
  /// false ends the transfer.
  TransferReply get(
      const std::string& url, std::uint64_t first_byte, const ByteSink& sink,
      const std::function<bool()>& keep_going = [] { return true; }) const;

 private:
  TransferReply request(const std::string& url, std::uint64_t first_byte, const ByteSink& sink,
                        const std::function<bool()>& keep_going, std::string& redirect) const;

  HubConfig config_;
  std::string token_origin_, token_;
  std::unique_ptr<void, void (*)(void*)> handle_;  ///< one, so that connections are kept
};

}  // namespace ovimap
