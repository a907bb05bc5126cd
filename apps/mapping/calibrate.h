// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/command/command.h"

namespace ovimap::apps {

Action add_calibrate(CLI::App& command);

}  // namespace ovimap::apps
