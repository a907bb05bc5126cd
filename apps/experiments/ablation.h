// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/evaluation/eval_report.h"
#include "published.h"

namespace ovimap::apps {

/// How often networks are asked in a video, whatever its frame rate; 0: in every frame.
struct AblationSchedule {
  double masks_s = 0, views_s = 0;
};

/// One way to make a map: what differs from the program's defaults.
struct AblationVariant {
  std::string name;
  std::string masks, encoder, views;  ///< as the options take them; empty: as for all variants
  std::vector<std::string> settings;  ///< "a.b=c"
  std::string frames = ":";
  std::optional<AblationSchedule> schedule;
  bool true_objects = false;  ///< embeds the truth's own objects and maps nothing
  std::string curve = {};     ///< of a variant that is one point of a curve: which one
  int frame_count = 0;        ///< ... and where on it
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
  bool along_frames = false;  ///< variants are points of curves along the recording
};

/// The columns of the paper's two comparisons: instances' mIoU, AP75, AP50, AP25, then classes'
/// mIoU, mAcc, AP25, AP50, AP.
std::vector<AblationColumn> comparison_columns();

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
  AblationVariant variant;
  EvalFigures figures;
};

/// By the standard protocol; 0 where the scenes give none.
inline double value_of(const AblationColumn& column, const AblationResult& result) {
  return column.figure(result.figures, Protocol::kStandard).value_or(0);
}

std::string ablation_markdown(const Ablation& ablation, const std::vector<AblationResult>& results,
                              const std::string& heading);
/// The paper's stages, as maps remember what they took (supplement, timing table).
std::string timing_markdown(const std::vector<std::filesystem::path>& maps,
                            const std::string& heading);
std::string ablation_csv(const Ablation& ablation, const std::vector<AblationResult>& results);
/// Bars by variant, of the standard protocol: SVG.
std::string ablation_bars(const Ablation& ablation, const std::vector<AblationResult>& results);
/// A panel for each column with a curve along the frames for each AblationVariant::curve: SVG.
std::string ablation_curves(const Ablation& ablation, const std::vector<AblationResult>& results);

}  // namespace ovimap::apps
