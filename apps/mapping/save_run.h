// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mapping_run.h"

namespace ovimap::apps {

/// Saves what a run made, with what people corrected meanwhile in the map that it replaces.
void save_run(const RunTarget& target, MappingRun& run);

}  // namespace ovimap::apps
