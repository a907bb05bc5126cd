// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "ablation.h"
#include "paper_scenes.h"

namespace ovimap::apps {

/// What was measured on one of the paper's data sets.
struct Reproduction {
  PaperDataset dataset;
  FoundScenes found;
  std::vector<AblationResult> results;  ///< one for each preset
  std::vector<std::string> notes;       ///< why the rows are not quite the paper's
};

/// Why rows made with these masks, this encoder and these scenes are not quite the paper's.
std::vector<std::string> differences_from_paper(const Reproduction& made, const std::string& masks,
                                                const std::string& encoder);

/// Our rows beside the published ones, with notes and missing scenes below.
std::string reproduction_markdown(const Reproduction& made, const std::string& heading);
/// Columns dataset, method, protocol, measured_or_published, then the figures.
std::string reproduction_csv(const Reproduction& made);
nlohmann::json reproduction_json(const Reproduction& made);

}  // namespace ovimap::apps
