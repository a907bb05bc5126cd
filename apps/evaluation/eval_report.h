// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "ovimap/pipeline/evaluation/map_evaluation.h"

namespace ovimap::apps {

/// Which protocols a user asked for.
struct ProtocolChoice {
  bool standard = true, reference = true;
};

/// All figures of some scenes; those that were not asked for, or cannot be had, are absent.
struct EvalFigures {
  std::string name;  ///< of the scene; "all" for the pool
  std::optional<StandardScores> standard;
  std::optional<ReferenceScores> reference, reference_pooled;
  std::optional<SemanticReport> standard_semantic, reference_semantic;
  GeometryScores geometry;  ///< means over the scenes
  BoxScores boxes;
  SizeRecall sizes;  ///< of the `standard` protocol
};

/// Of all scenes pooled, or of one of them.
EvalFigures figures_of(const Evaluation& evaluation, const EvaluationConfig& config,
                       const ProtocolChoice& protocols);
EvalFigures figures_of(const Evaluation& evaluation, std::size_t scene,
                       const EvaluationConfig& config, const ProtocolChoice& protocols);

/// All scenes pooled, and each of them.
struct EvalTable {
  EvalFigures all;
  std::vector<EvalFigures> scenes;
};
/// What is pooled of one scene is that scene's, and not computed again.
EvalTable table_of(const Evaluation& evaluation, const EvaluationConfig& config,
                   const ProtocolChoice& protocols);

nlohmann::json eval_json(const Evaluation& evaluation, const EvalTable& table);

/// Tables that a terminal and a Markdown page both show well.
std::string eval_markdown(const Evaluation& evaluation, const EvalTable& table,
                          const SizeGroupsConfig& sizes);

}  // namespace ovimap::apps
