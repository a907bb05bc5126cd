// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/command/command.h"
#include "ovimap/pipeline/approach/approach.h"

namespace ovimap::apps {

/// What `ovimap query --approach` was told.
struct ApproachOptions {
  bool asked = false;
  ApproachConfig config;
  std::vector<float> from;            ///< x, y; empty: not said
  std::vector<CLI::Option*> details;  ///< options that mean nothing without --approach

  std::optional<Eigen::Vector2f> start() const;
};

void add_approach_options(CLI::App& command, ApproachOptions& options);

/// Throws Error for a detail of --approach without it.
void check_approach_options(const ApproachOptions& options);

/// Two lines or more under an object's own.
void print_approach(const Approach& approach);

}  // namespace ovimap::apps
