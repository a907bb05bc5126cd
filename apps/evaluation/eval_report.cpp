// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "eval_report.h"

#include <array>
#include <cstdio>

#include "ovimap/io/exports/json_values.h"

namespace ovimap::apps {

namespace {

constexpr const char* kPool = "all";

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
  return {{"miou", scores.miou},
          {"wiou", scores.wiou},
          {"ap25", scores.ap25},
          {"ap50", scores.ap50},
          {"ap75", scores.ap75},
          {"recall25", scores.recall25},
          {"recall50", scores.recall50},
          {"recall75", scores.recall75},
          {"truth_instances", scores.truth_instances},
          {"predicted_instances", scores.predicted_instances}};
}

nlohmann::json json_of(const RecallGroup& group) {
  return {{"things", group.things}, {"found", group.found}, {"recall", group.recall()}};
}

nlohmann::json json_of(const SizeRecall& recall) {
  return {{"small", json_of(recall.small)},       {"medium", json_of(recall.medium)},
          {"large", json_of(recall.large)},       {"flat", json_of(recall.flat)},
          {"unscored", json_of(recall.unscored)}, {"objects_per_thing", recall.objects_per_thing}};
}

nlohmann::json json_of(const GeometryScores& scores) {
  return {{"accuracy_m", scores.accuracy_m},
          {"accuracy_median_m", scores.accuracy_median_m},
          {"stray", scores.stray},
          {"completeness", scores.completeness},
          {"completeness_1cm", scores.fine_completeness}};
}

nlohmann::json json_of(const BoxScores& scores) {
  return {{"things", scores.things},
          {"mean_iou", scores.mean_iou()},
          {"under_quarter", scores.under_quarter}};
}

/// Panoptic quality belongs to the standard protocol alone.
nlohmann::json json_of(const SemanticScores& scores, bool panoptic) {
  nlohmann::json json = {{"miou", scores.miou},
                         {"macc", scores.macc},
                         {"fwiou", scores.fwiou},
                         {"ap25", scores.ap25},
                         {"ap50", scores.ap50},
                         {"ap75", scores.ap75},
                         {"ap", scores.ap},
                         {"classes", scores.classes},
                         {"instance_classes", scores.instance_classes}};
  if (panoptic) json.update({{"pq", scores.pq}, {"sq", scores.sq}, {"rq", scores.rq}});
  return json;
}

nlohmann::json json_of(const ClassScores& scores, const LabelSet& set, bool panoptic) {
  nlohmann::json json = {
      {"name", set.labels[static_cast<std::size_t>(scores.class_number - 1)].name},
      {"truth_vertices", scores.truth_vertices},
      {"predicted_vertices", scores.predicted_vertices},
      {"iou", json_or_null(scores.iou)},
      {"accuracy", json_or_null(scores.accuracy)},
      {"ap25", json_or_null(scores.ap25)},
      {"ap50", json_or_null(scores.ap50)},
      {"ap75", json_or_null(scores.ap75)},
      {"ap", json_or_null(scores.ap)}};
  if (panoptic) json["pq"] = json_or_null(scores.pq);
  return json;
}

nlohmann::json json_of(const SemanticReport& report, const LabelSet& set, bool panoptic) {
  nlohmann::json json = json_of(report.all, panoptic);
  json["aq"] = report.queries_per_instance;
  json["class_set"] = set.name;
  for (const auto& [name, scores] : report.groups) json["groups"][name] = json_of(scores, panoptic);
  json["per_class"] = nlohmann::json::array();
  for (const ClassScores& scores : report.classes)
    if (scores.truth_vertices > 0 || scores.predicted_vertices > 0)
      json["per_class"].push_back(json_of(scores, set, panoptic));
  return json;
}

nlohmann::json scene_json(const EvalFigures& figures, const std::optional<LabelSet>& set) {
  nlohmann::json json = {{"geometry", json_of(figures.geometry)},
                         {"boxes", json_of(figures.boxes)},
                         {"recall_by_size", json_of(figures.sizes)}};
  if (figures.standard) json["standard"] = json_of(*figures.standard);
  if (figures.reference) json["reference"] = json_of(*figures.reference);
  if (figures.standard_semantic)
    json["standard"]["semantic"] = json_of(*figures.standard_semantic, *set, true);
  if (figures.reference_semantic)
    json["reference"]["semantic"] = json_of(*figures.reference_semantic, *set, false);
  return json;
}

/// A row "| a | b |" of one text and figures; NaN-free figures to three places.
std::string row(const std::string& first, const std::string& second,
                std::initializer_list<std::optional<double>> figures) {
  std::string text = concat("| ", first, " | ", second, " |");
  for (const std::optional<double>& figure : figures) {
    char number[32];
    std::snprintf(number, sizeof number, " %.3f |", figure.value_or(0));
    text += figure ? number : " - |";
  }
  return text + "\n";
}

std::string instance_table(const EvalFigures& all, const std::vector<EvalFigures>& scenes) {
  std::string text =
      "| scene | protocol | mIoU | AP | AP75 | AP50 | AP25 |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  const auto add = [&](const EvalFigures& figures) {
    if (const auto& s = figures.standard)
      text += row(figures.name, "standard", {s->miou, s->ap, s->ap75, s->ap50, s->ap25});
    if (const auto& r = figures.reference)
      text += row(figures.name, "reference", {r->miou, std::nullopt, r->ap75, r->ap50, r->ap25});
  };
  add(all);
  if (scenes.size() > 1)
    for (const EvalFigures& scene : scenes) add(scene);
  return text;
}

std::string semantic_row(const std::string& name, const char* protocol, const SemanticScores& s,
                         bool panoptic, std::optional<double> queries) {
  return row(name, protocol,
             {s.miou, s.macc, s.fwiou, s.ap, s.ap50, s.ap25,
              panoptic ? std::optional(s.pq) : std::nullopt, queries});
}

std::string semantic_table(const EvalFigures& all, const std::vector<EvalFigures>& scenes) {
  std::string text =
      "| scene | protocol | mIoU | mAcc | fwIoU | AP | AP50 | AP25 | PQ | AQ |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  const auto add = [&](const EvalFigures& figures) {
    const auto add_report = [&](const std::optional<SemanticReport>& report, const char* protocol,
                                bool panoptic) {
      if (!report) return;
      text +=
          semantic_row(figures.name, protocol, report->all, panoptic, report->queries_per_instance);
      for (const auto& [group, scores] : report->groups)
        if (scores.classes > 0)
          text += semantic_row(figures.name + ", " + group, protocol, scores, panoptic, {});
    };
    add_report(figures.standard_semantic, "standard", true);
    add_report(figures.reference_semantic, "reference", false);
  };
  add(all);
  if (scenes.size() > 1)
    for (const EvalFigures& scene : scenes) add(scene);
  return text;
}

std::string size_table(const EvalFigures& all, const std::vector<EvalFigures>& scenes,
                       const SizeGroupsConfig& config) {
  char head[256];
  std::snprintf(
      head, sizeof head,
      "| scene | under %g l | under %g l | larger | flat | not scored | objects / true |\n",
      config.small_litres, config.medium_litres);
  std::string text = concat(head, "| --- | --- | --- | --- | --- | --- | --- |\n");
  const auto add = [&](const EvalFigures& figures) {
    const SizeRecall& s = figures.sizes;
    text += "| " + figures.name + " |";
    for (const RecallGroup* group : {&s.small, &s.medium, &s.large, &s.flat, &s.unscored}) {
      char cell[64];
      std::snprintf(cell, sizeof cell, " %.2f (%d / %d) |", group->recall(), group->found,
                    group->things);
      text += group->things > 0 ? cell : " - |";
    }
    char ratio[32];
    std::snprintf(ratio, sizeof ratio, " %.2f |\n", s.objects_per_thing);
    text += ratio;
  };
  add(all);
  if (scenes.size() > 1)
    for (const EvalFigures& scene : scenes) add(scene);
  return text;
}

std::string surface_table(const std::vector<EvalFigures>& scenes) {
  std::string text =
      "| scene | error, mm | median, mm | completeness |\n| --- | --- | --- | --- |\n";
  for (const EvalFigures& scene : scenes) {
    char line[96];
    std::snprintf(line, sizeof line, " | %.1f | %.1f | %.3f |\n", 1e3 * scene.geometry.accuracy_m,
                  1e3 * scene.geometry.accuracy_median_m, scene.geometry.completeness);
    text += "| " + scene.name + line;
  }
  return text;
}

GeometryScores mean_geometry(const std::vector<EvaluatedScene>& scenes) {
  constexpr std::array kFigures = {&GeometryScores::accuracy_m, &GeometryScores::accuracy_median_m,
                                   &GeometryScores::stray, &GeometryScores::completeness,
                                   &GeometryScores::fine_completeness};
  GeometryScores mean;
  for (const auto figure : kFigures) {
    for (const EvaluatedScene& scene : scenes) mean.*figure += scene.geometry.*figure;
    mean.*figure /= static_cast<double>(scenes.size());
  }
  return mean;
}

/// Of `count` scenes from `first` on; everything but name and geometry.
EvalFigures pooled(const Evaluation& evaluation, std::size_t first, std::size_t count,
                   const EvaluationConfig& config, const ProtocolChoice& protocols) {
  EvalFigures figures;
  const bool semantic = evaluation.classes.has_value();
  const auto scenes_of = [&](Protocol protocol) {
    std::vector<LabelledScene> scenes;
    for (std::size_t i = first; i < first + count; ++i)
      scenes.push_back(labelled_scene(evaluation.scenes[i], protocol));
    return scenes;
  };
  std::vector<SizedScene> sized;
  for (std::size_t i = first; i < first + count; ++i) {
    sized.push_back(evaluation.scenes[i].sized);
    figures.boxes += evaluation.scenes[i].boxes;
  }
  figures.sizes = recall_by_size(sized, config.sizes);
  if (protocols.standard) {
    figures.standard = standard_scores(scenes_of(Protocol::kStandard));
    if (semantic)
      figures.standard_semantic =
          semantic_report(evaluation, first, count, Protocol::kStandard, config);
  }
  if (protocols.reference) {
    const ReferenceSummary summary =
        reference_summary(scenes_of(Protocol::kReference), config.reference);
    figures.reference = summary.scene_mean;
    figures.reference_pooled = summary.pooled;
    if (semantic)
      figures.reference_semantic =
          semantic_report(evaluation, first, count, Protocol::kReference, config);
  }
  return figures;
}

}  // namespace

EvalFigures figures_of(const Evaluation& evaluation, const EvaluationConfig& config,
                       const ProtocolChoice& protocols) {
  EvalFigures figures = pooled(evaluation, 0, evaluation.scenes.size(), config, protocols);
  figures.name = kPool;
  figures.geometry = mean_geometry(evaluation.scenes);
  return figures;
}

EvalFigures figures_of(const Evaluation& evaluation, std::size_t scene,
                       const EvaluationConfig& config, const ProtocolChoice& protocols) {
  EvalFigures figures = pooled(evaluation, scene, 1, config, protocols);
  figures.name = evaluation.scenes[scene].name;
  figures.geometry = evaluation.scenes[scene].geometry;
  return figures;
}

EvalTable table_of(const Evaluation& evaluation, const EvaluationConfig& config,
                   const ProtocolChoice& protocols) {
  EvalTable table;
  for (std::size_t i = 0; i < evaluation.scenes.size(); ++i)
    table.scenes.push_back(figures_of(evaluation, i, config, protocols));
  if (table.scenes.size() == 1) {
    table.all = table.scenes.front();
    table.all.name = kPool;
  } else {
    table.all = figures_of(evaluation, config, protocols);
  }
  return table;
}

nlohmann::json eval_json(const Evaluation& evaluation, const EvalTable& table) {
  const auto& [all, scenes] = table;
  nlohmann::json json = {{"scenes", nlohmann::json::object()}, {"notices", evaluation.notices}};
  const std::optional<LabelSet>& set = evaluation.classes;
  for (const EvalFigures& scene : scenes) json["scenes"][scene.name] = scene_json(scene, set);
  if (all.standard)
    json["standard"] = {{"class_agnostic", json_of(*all.standard)},
                        {"geometry", json_of(all.geometry)},
                        {"boxes", json_of(all.boxes)},
                        {"recall_by_size", json_of(all.sizes)}};
  if (all.reference)
    json["reference"] = {{"class_agnostic", json_of(*all.reference)},
                         {"pooled", json_of(*all.reference_pooled)}};
  if (all.standard_semantic)
    json["standard"]["semantic"] = json_of(*all.standard_semantic, *set, true);
  if (all.reference_semantic)
    json["reference"]["semantic"] = json_of(*all.reference_semantic, *set, false);
  return json;
}

std::string eval_markdown(const Evaluation& evaluation, const EvalTable& table,
                          const SizeGroupsConfig& sizes) {
  const auto& [all, scenes] = table;
  std::string text = "Objects, whatever their class";
  if (all.standard)
    text += concat(": ", all.standard->truth_instances, " true, ",
                   all.standard->predicted_instances, " in the map", scenes.size() > 1 ? "s" : "");
  text += "\n\n" + instance_table(all, scenes);
  if (const auto& report = all.standard_semantic ? all.standard_semantic : all.reference_semantic)
    text +=
        concat("\nClasses: ", report->all.classes, " of the ", evaluation.classes->labels.size(),
               " of `", evaluation.classes->name, "` occur\n\n", semantic_table(all, scenes));
  text += "\nThings found (IoU of one half), by the size of their box\n\n" +
          size_table(all, scenes, sizes);
  return text + "\nSurface\n\n" + surface_table(scenes);
}

}  // namespace ovimap::apps
