// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval_report.h"

namespace ovimap::apps {

/// One way to make a map: what differs from the program's defaults.
struct AblationVariant {
  std::string name;
  std::string masks, encoder, views;  ///< as the options take them; empty: as for all variants
  std::vector<std::string> settings;  ///< "a.b=c"
  std::string frames = ":";
  bool true_objects = false;  ///< embeds the truth's own objects and maps nothing
};

/// A row of a table in the literature, percent; NaN where there is none.
struct PublishedRow {
  std::string name, where;
  std::vector<double> figures;
};

/// A figure of an evaluation, percent (AQ: a number).
struct AblationColumn {
  std::string name;
  std::optional<double> (*figure)(const EvalFigures&, Protocol);
};

/// Which choices are compared, by which figures, and what was published.
struct Ablation {
  std::string name, title;
  std::vector<AblationColumn> columns;
  std::vector<AblationVariant> variants;
  std::vector<PublishedRow> published;
  bool along_frames = false;  ///< variants are lengths of the recording: draw a curve
};

/// "views", "masks", "fusion", "encoder", "incremental", "schedule"; "timing" is a table apart.
inline constexpr const char* kTiming = "timing";
std::vector<std::string> ablation_names();

struct AblationChoice {
  std::vector<std::string> encoders;  ///< of "encoder"
  std::vector<std::string> models;    ///< of "masks": further sources of masks
};

/// Throws Error for a name that is none.
Ablation make_ablation(const std::string& name, const AblationChoice& choice);

/// A variant's figures on all scenes, both protocols.
struct AblationResult {
  std::string variant;
  EvalFigures figures;
};

std::string ablation_markdown(const Ablation& ablation, const std::vector<AblationResult>& results,
                              const std::string& heading);
/// The paper's stages, as maps remember what they took (supplement, timing table).
std::string timing_markdown(const std::vector<std::filesystem::path>& maps,
                            const std::string& heading);
std::string ablation_csv(const Ablation& ablation, const std::vector<AblationResult>& results);
/// Bars by variant, or curves along the frames, of the standard protocol: SVG.
std::string ablation_svg(const Ablation& ablation, const std::vector<AblationResult>& results);

}  // namespace ovimap::apps
