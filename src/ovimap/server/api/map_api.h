// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/server/api/frame_api.h"
#include "ovimap/server/http/http_message.h"
#include "ovimap/server/served/served_map.h"
#include "ovimap/server/served/standing_queries.h"

namespace ovimap {

/// The routes under /api/, which docs/http-api.md and openapi.json describe. What is given
/// must outlive the router.
Router map_api(ServedMap& map, FrameApi& frames, StandingQueries& standing);

/// The OpenAPI description as it is served.
const char* openapi_json();

}  // namespace ovimap
