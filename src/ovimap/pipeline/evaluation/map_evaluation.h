// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ovimap/eval/geometry/frame_check.h"
#include "ovimap/eval/geometry/geometry_scores.h"
#include "ovimap/eval/scores/box_scores.h"
#include "ovimap/eval/scores/reference_scores.h"
#include "ovimap/eval/scores/semantic_scores.h"
#include "ovimap/eval/scores/size_recall.h"
#include "ovimap/eval/scores/standard_scores.h"
#include "ovimap/inference/models/onnx_session.h"
#include "ovimap/semantics/classes/class_names.h"

namespace ovimap {

struct EvaluationConfig {
  TransferConfig transfer;
  FrameCheckConfig frames;
  GeometryScoresConfig geometry;
  ReferenceProtocolConfig reference;
  SemanticReferenceConfig semantic_reference;
  SizeGroupsConfig sizes;
  int min_embedded_views = 2;  ///< the reference protocol drops objects with fewer
};
void list_fields(EvaluationConfig& config, ConfigFields& fields);

struct EvaluationOptions {
  /// "auto": the truth's own names where it has some; "truth": those, and an error without; else
  /// what read_label_set takes.
  std::string classes = "auto";
  std::string encoder = "auto";  ///< as encoder_of_map takes it; "none": no semantic figures
  std::vector<std::filesystem::path> model_dirs;
  RuntimeConfig runtime;
};

/// A map and the recording whose truth it is scored against.
struct MapAndTruth {
  std::filesystem::path map;  ///< or a PLY file: a surface, and objects where vertices have labels
  std::filesystem::path source;
};

/// What a map says at the vertices of its truth.
struct EvaluatedScene {
  std::string name;      ///< the map's path
  SemanticScene labels;  ///< classes are empty where there are no semantic figures;
                         ///< things that are not scored are unlabelled in it
  SizedScene sized;      ///< the same with everything
  std::map<std::uint32_t, std::int32_t> picture_classes;  ///< predicted as the paper does, by the
                                                          ///< nearest name alone
  std::vector<std::uint32_t> few_views;  ///< objects with too few embedded views; empty for a map
                                         ///< without embeddings
  GeometryScores geometry;
  BoxScores boxes;  ///< of things that are scored; a PLY file has none
  int embedding_queries = 0, embedded_instances = 0;
};

struct Evaluation {
  std::vector<EvaluatedScene> scenes;
  std::optional<LabelSet> classes;   ///< absent: there are no semantic figures
  std::vector<std::string> notices;  ///< what a person should know of the figures
};

/// Loads maps and truths, transfers labels and projects the objects' embeddings onto the classes.
/// Semantic figures need a truth with classes and a map with embeddings in every scene; what is
/// missing stands in the notices. Throws Error for maps and truths that cannot be read or do not
/// lie in one frame and scale, for class ids that nothing names, and where `classes` was named but
/// a truth has none.
Evaluation evaluate_maps(std::span<const MapAndTruth> pairs, const EvaluationOptions& options,
                         const EvaluationConfig& config = {});

enum class Protocol { kStandard, kReference };

/// Figures of one protocol.
struct SemanticReport {
  SemanticScores all;
  std::vector<std::pair<std::string, SemanticScores>> groups;  ///< head, common, tail
  std::vector<ClassScores> classes;  ///< class_number - 1 is the position in Evaluation::classes
  double queries_per_instance = 0;   ///< AQ: embedding queries per object that has an embedding
};

/// Of `count` scenes from `first` on, pooled. The evaluation must have classes.
SemanticReport semantic_report(const Evaluation& evaluation, std::size_t first, std::size_t count,
                               Protocol protocol, const EvaluationConfig& config = {});

/// The scene as the class-agnostic figures of a protocol take it.
LabelledScene labelled_scene(const EvaluatedScene& scene, Protocol protocol);

}  // namespace ovimap
