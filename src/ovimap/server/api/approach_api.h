// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/server/http/http_message.h"
#include "ovimap/server/served/served_map.h"

namespace ovimap {

/// Where to stand to see an object: {"instance", "from": [x, y], and settings of ApproachConfig}.
/// Throws BadRequest, and Error for a setting out of its range.
HttpReply answer_approach(const ServedMap& map, const HttpRequest& request);

/// The scene graph: rooms, doors, places, objects, relations.
HttpReply show_rooms(const ServedMap& map);

/// Where somebody who scans should look next.
HttpReply show_gaps(const ServedMap& map);

}  // namespace ovimap
