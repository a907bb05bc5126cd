// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "command.h"
#include "ovimap/eval/geometry_scores.h"
#include "ovimap/eval/reference_scores.h"
#include "ovimap/eval/standard_scores.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/map_file.h"
#include "ovimap/io/truth.h"

namespace ovimap::apps {

namespace {

struct EvalOptions {
  std::vector<std::filesystem::path> maps, truths;
  bool json = false;
};

struct SceneScores {
  LabelledScene scene;
  GeometryScores geometry;
};

SceneScores score_scene(const std::filesystem::path& map, const std::filesystem::path& source) {
  const Truth truth = load_truth(source);
  const MapDocument document = load_map(map);
  const Mesh mesh = extract_instance_mesh(document.map, document.instances);
  SceneScores result{
      {truth.instances, transfer_labels(truth.mesh.vertices, mesh.vertices, mesh.labels), {}},
      geometry_scores(truth.mesh, mesh)};
  if (result.geometry.completeness == 0.0)
    throw Error(concat("map ", map.string(), " and truth ", source.string(),
                       " do not overlap; are they in the same frame and scale?"));
  return result;
}

nlohmann::json json_of(const StandardScores& scores) {
  return {{"miou", scores.miou},
          {"ap25", scores.ap25},
          {"ap50", scores.ap50},
          {"ap75", scores.ap75},
          {"ap", scores.ap},
          {"recall25", scores.recall25},
          {"recall50", scores.recall50},
          {"recall75", scores.recall75},
          {"truth_instances", scores.truth_instances},
          {"predicted_instances", scores.predicted_instances}};
}

nlohmann::json json_of(const ReferenceScores& scores) {
  return {{"miou", scores.miou},         {"wiou", scores.wiou},
          {"ap25", scores.ap25},         {"ap50", scores.ap50},
          {"ap75", scores.ap75},         {"recall25", scores.recall25},
          {"recall50", scores.recall50}, {"recall75", scores.recall75}};
}

nlohmann::json json_of(const GeometryScores& scores) {
  return {{"accuracy_m", scores.accuracy_m},
          {"accuracy_median_m", scores.accuracy_median_m},
          {"stray", scores.stray},
          {"completeness", scores.completeness},
          {"completeness_1cm", scores.fine_completeness}};
}

void print_table(const StandardScores& standard, const ReferenceScores& reference,
                 const std::vector<SceneScores>& scenes) {
  std::printf("%-10s %6s %6s %6s %6s %6s\n", "protocol", "mIoU", "AP", "AP75", "AP50", "AP25");
  std::printf("%-10s %6.3f %6.3f %6.3f %6.3f %6.3f\n", "standard", standard.miou, standard.ap,
              standard.ap75, standard.ap50, standard.ap25);
  std::printf("%-10s %6.3f %6s %6.3f %6.3f %6.3f\n", "reference", reference.miou, "-",
              reference.ap75, reference.ap50, reference.ap25);
  std::printf("%d true objects, %d in the map\n", standard.truth_instances,
              standard.predicted_instances);
  for (const SceneScores& scene : scenes)
    std::printf("surface error %.1f mm (median %.1f), completeness %.3f\n",
                scene.geometry.accuracy_m * 1e3, scene.geometry.accuracy_median_m * 1e3,
                scene.geometry.completeness);
}

int eval(const EvalOptions& options) {
  if (options.maps.size() != options.truths.size())
    throw Error(concat(options.maps.size(), " maps but ", options.truths.size(),
                       " truths; give one --gt SOURCE for each map, in order"));
  std::vector<SceneScores> scenes;
  std::vector<LabelledScene> labelled;
  nlohmann::json per_scene = nlohmann::json::object();
  double accuracy = 0, completeness = 0;
  for (std::size_t i = 0; i < options.maps.size(); ++i) {
    scenes.push_back(score_scene(options.maps[i], options.truths[i]));
    labelled.push_back(scenes.back().scene);
    accuracy += scenes.back().geometry.accuracy_m;
    completeness += scenes.back().geometry.completeness;
    per_scene[options.maps[i].string()] = {
        {"standard", json_of(standard_scores(std::span(&labelled.back(), 1)))},
        {"reference", json_of(reference_scores(labelled.back()))},
        {"geometry", json_of(scenes.back().geometry)}};
  }
  const StandardScores standard = standard_scores(labelled);
  const ReferenceSummary reference = reference_summary(labelled);
  const auto count = static_cast<double>(scenes.size());
  if (options.json)
    print_json({{"standard",
                 {{"class_agnostic", json_of(standard)},
                  {"geometry",
                   {{"accuracy_m", accuracy / count}, {"completeness", completeness / count}}}}},
                {"reference",
                 {{"class_agnostic", json_of(reference.scene_mean)},
                  {"pooled", json_of(reference.pooled)}}},
                {"scenes", per_scene}});
  else
    print_table(standard, reference.scene_mean, scenes);
  return kDone;
}

}  // namespace

Action add_eval(CLI::App& command) {
  auto options = std::make_shared<EvalOptions>();
  command.add_option("MAP", options->maps, "map files; several are pooled")->required();
  command
      .add_option("--gt", options->truths, "scene with truth, one for each map in the same order")
      ->required();
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return eval(*options); };
}

}  // namespace ovimap::apps
