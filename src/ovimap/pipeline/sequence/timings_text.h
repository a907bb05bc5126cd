// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "ovimap/base/stage_timers.h"

namespace ovimap {

/// Stages as a map keeps them (MapRecord::timings): a line "stage p50_ms p95_ms count" each, three
/// decimals, by name.
std::string timings_text(const std::map<std::string, StageSummary>& stages);

/// The way back; p99_ms and total_ms stay 0. Lines that are none are passed over.
std::map<std::string, StageSummary> parse_timings(const std::string& text);

}  // namespace ovimap
