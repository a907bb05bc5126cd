// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/transfer/hub_config.h"

#include <cstdlib>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/hub/transfer/http_client.h"

namespace ovimap {

namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

bool is_this_machine(const std::string& origin) {
  for (const char* host : {"http://127.0.0.1:", "http://localhost:", "http://[::1]:"})
    if (origin.starts_with(host)) return true;
  return false;
}

}  // namespace

void list_fields(HubConfig& config, ConfigFields& fields) {
  fields.add("attempts", config.attempts, 1, 100, "tries of one request");
  fields.add("first_wait_s", config.first_wait_s, 0, 60,
             "seconds before the second try; doubled for each one after");
  fields.add("longest_wait_s", config.longest_wait_s, 0, 3600,
             "seconds that a hub may ask to wait; where it asks for more, the fetch ends");
  fields.add("connect_timeout_s", config.connect_timeout_s, 1, 600, "seconds to connect in");
  fields.add("stall_timeout_s", config.stall_timeout_s, 1, 600,
             "seconds without a byte after which a transfer is taken for broken");
}

HubAccess hub_access_from_environment() {
  HubAccess access;
  if (const std::string endpoint = environment("HF_ENDPOINT"); !endpoint.empty())
    access.endpoint = endpoint.substr(0, endpoint.find_last_not_of('/') + 1);
  access.token = environment("HF_TOKEN");
  const std::string origin = origin_of(access.endpoint);
  if (origin.empty())
    throw Error(concat("HF_ENDPOINT is '", access.endpoint,
                       "'; accepted is an address such as https://huggingface.co"));
  if (!access.token.empty() && !origin.starts_with("https:") && !is_this_machine(origin))
    throw Error(concat("HF_TOKEN would travel unencrypted to ", access.endpoint,
                       "; take an https address or unset HF_TOKEN"));
  return access;
}

}  // namespace ovimap
