// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/server/http/http_message.h"
#include "ovimap/server/served/served_map.h"

namespace ovimap {

/// The visits of the map, and what each found appeared, gone or moved.
HttpReply show_history(const ServedMap& map);

/// What became of objects between two times that the address may name, "since" and "until", as
/// people write them (docs/query.md, "Times"). Throws Error for what is no time, and MomentUnknown.
HttpReply show_changes(const ServedMap& map, const HttpRequest& request);

/// The surface of an object as it was before an event: points in the world, metres, and their
/// colours. Throws BadRequest for a number that is none.
HttpReply show_past_surface(const ServedMap& map, const HttpRequest& request);

/// A picture of it, JPEG. Throws likewise.
HttpReply show_past_crop(const ServedMap& map, const HttpRequest& request);

}  // namespace ovimap
