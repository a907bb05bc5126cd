// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ovimap/io/map_file/map_edits.h"

namespace ovimap {

// Corrections as docs/http-api.md has them.

/// The edit that a body asks for; each kind has fields of its own. Throws BadRequest.
MapEdit edit_of(const nlohmann::json& body);

/// A line of the log.
nlohmann::json edit_json(const MapEdit& edit);

}  // namespace ovimap
