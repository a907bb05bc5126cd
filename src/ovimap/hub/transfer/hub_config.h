// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace ovimap {

class ConfigFields;

/// How patient a fetch is with the network.
struct HubConfig {
  int attempts = 5;          ///< tries of one request, before a fetch gives up
  float first_wait_s = 1.f;  ///< before the second try; doubled for each one after
  float longest_wait_s =
      120.f;  ///< a hub that asks for a longer one (Retry-After) is not waited for
  int connect_timeout_s = 20;
  int stall_timeout_s = 30;  ///< a transfer without a byte for so long is broken
};
void list_fields(HubConfig& config, ConfigFields& fields);

/// Which hub, and as whom.
struct HubAccess {
  std::string endpoint = "https://huggingface.co";  ///< without a slash at its end
  std::string token;                                ///< empty: as nobody
};

/// $HF_ENDPOINT and $HF_TOKEN where they are set. Throws Error when the endpoint is no http or
/// https address, or when the token would leave this machine unencrypted.
HubAccess hub_access_from_environment();

}  // namespace ovimap
