// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/server/http/http_message.h"
#include "ovimap/server/served/standing_queries.h"

namespace ovimap {

/// Standing queries as a stream of server-sent events (docs/http-api.md, "Standing queries"): of
/// GET the queries are in the address, of POST in the body. `map` and `standing` must outlive the
/// stream. Throw BadRequest, and Error for what nobody can ask.
HttpReply watch_of_address(const ServedMap& map, StandingQueries& standing,
                           const HttpRequest& request);
HttpReply watch_of_body(const ServedMap& map, StandingQueries& standing,
                        const HttpRequest& request);

}  // namespace ovimap
