// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "ovimap/io/exports/object_titles.h"

namespace ovimap {

/// The instances as a table, a line each after a line of column names: id, name, min_x ... max_z,
/// centroid_x ..., points, views, confidence, label; metres in the world frame. RFC 4180: commas,
/// CRLF, names with commas, quotes or line breaks in quotes; a number that is absent is an empty
/// field.
std::string instances_csv(std::span<const InstanceSummary> instances, const ObjectTitles& titles);

}  // namespace ovimap
