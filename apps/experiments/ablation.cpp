// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ablation.h"

#include "ovimap/base/config.h"

namespace ovimap::apps {

namespace {

constexpr double kPercent = 100;

const SemanticReport* semantic(const EvalFigures& figures, Protocol protocol) {
  const auto& report =
      protocol == Protocol::kStandard ? figures.standard_semantic : figures.reference_semantic;
  return report ? &*report : nullptr;
}

template <double SemanticScores::*Field>
std::optional<double> class_figure(const EvalFigures& figures, Protocol protocol) {
  const SemanticReport* report = semantic(figures, protocol);
  return report ? std::optional(kPercent * report->all.*Field) : std::nullopt;
}

template <double StandardScores::*Standard, double ReferenceScores::*Reference>
std::optional<double> instance_figure(const EvalFigures& figures, Protocol protocol) {
  if (protocol == Protocol::kStandard)
    return figures.standard ? std::optional(kPercent * (*figures.standard).*Standard)
                            : std::nullopt;
  return figures.reference ? std::optional(kPercent * (*figures.reference).*Reference)
                           : std::nullopt;
}

std::optional<double> queries_per_object(const EvalFigures& figures, Protocol protocol) {
  const SemanticReport* report = semantic(figures, protocol);
  return report ? std::optional(report->queries_per_instance) : std::nullopt;
}

const AblationColumn kMiou{"mIoU", class_figure<&SemanticScores::miou>};
const AblationColumn kMacc{"mAcc", class_figure<&SemanticScores::macc>};
const AblationColumn kAp25{"AP25", class_figure<&SemanticScores::ap25>};
const AblationColumn kAp50{"AP50", class_figure<&SemanticScores::ap50>};
const AblationColumn kAp{"AP", class_figure<&SemanticScores::ap>};
const AblationColumn kQueries{"AQ", queries_per_object};
const AblationColumn kObjectMiou{"inst mIoU",
                                 instance_figure<&StandardScores::miou, &ReferenceScores::miou>};
const AblationColumn kObjectAp75{"inst AP75",
                                 instance_figure<&StandardScores::ap75, &ReferenceScores::ap75>};
const AblationColumn kObjectAp50{"inst AP50",
                                 instance_figure<&StandardScores::ap50, &ReferenceScores::ap50>};
const AblationColumn kObjectAp25{"inst AP25",
                                 instance_figure<&StandardScores::ap25, &ReferenceScores::ap25>};

AblationVariant of_views(std::string name, std::string views, bool true_objects = false) {
  AblationVariant variant;
  variant.name = std::move(name);
  variant.views = std::move(views);
  variant.true_objects = true_objects;
  return variant;
}

Ablation views() {
  Ablation ablation{"views", "Which views of an object are embedded", {}, {}, {}, false};
  ablation.columns = {kMiou, kMacc, kAp25, kAp50, kQueries};
  ablation.variants = {of_views("random", "random"),
                       of_views("pixels", "vis"),
                       of_views("coverage", "viewcov"),
                       of_views("paper", "paper"),
                       of_views("default", "default"),
                       of_views("true objects, pixels", "vis", true),
                       of_views("true objects, coverage", "viewcov", true),
                       of_views("true objects, default", "default", true)};
  ablation.published = published_views();
  return ablation;
}

AblationVariant of_masks(std::string name, std::string masks) {
  AblationVariant variant;
  variant.name = std::move(name);
  variant.masks = std::move(masks);
  return variant;
}

Ablation masks(const std::vector<std::string>& models) {
  Ablation ablation{"masks", "Where the 2D entities come from", {}, {}, {}, false};
  ablation.columns = {kObjectMiou, kObjectAp75, kObjectAp50, kObjectAp25,
                      kMiou,       kMacc,       kAp25,       kAp50};
  ablation.variants = {of_masks("none: depth alone", "none"), of_masks("sam: MobileSAM", "sam")};
  for (const std::string& model : models) ablation.variants.push_back(of_masks(model, model));
  ablation.variants.push_back(of_masks("gt: true 2D masks", "gt"));
  ablation.variants.push_back(of_masks("true objects", "gt"));
  ablation.variants.back().true_objects = true;
  ablation.published = published_masks();
  return ablation;
}

Ablation fusion() {
  Ablation ablation{"fusion", "How the embeddings of an object's views become one", {}, {}, {},
                    false};
  ablation.columns = {kMiou, kMacc, kAp25, kAp50, kAp};
  for (const char* rule : {"pixel_weighted", "mean", "max_cosine", "min_l1"}) {
    AblationVariant variant;
    variant.name = rule;
    variant.settings = {std::string("views.fusion=") + rule};
    ablation.variants.push_back(variant);
  }
  ablation.published = published_fusion();
  return ablation;
}

Ablation encoder(const std::vector<std::string>& encoders) {
  Ablation ablation{"encoder", "Which encoder embeds the views", {}, {}, {}, false};
  ablation.columns = {kMiou, kMacc, kAp25, kAp50, kAp};
  for (const std::string& name :
       encoders.empty() ? std::vector<std::string>{"default"} : encoders) {
    AblationVariant variant;
    variant.name = variant.encoder = name;
    ablation.variants.push_back(variant);
  }
  ablation.published = published_encoders();
  return ablation;
}

/// The paper's figure has no table: its curves cannot be printed beside ours.
Ablation incremental() {
  Ablation ablation{"incremental", "Figures as the recording goes on", {}, {}, {}, true};
  ablation.columns = {kObjectMiou, kObjectAp50, kMiou, kMacc, kAp25, kAp50, kQueries};
  for (const auto& [curve, strategy] :
       {std::pair{"coverage", "viewcov"}, std::pair{"pixels", "vis"}})
    for (const int frames : {25, 50, 100, 150, 200}) {
      AblationVariant variant = of_views(concat(curve, ", ", frames), strategy);
      variant.frames = concat(":", frames);
      variant.curve = curve;
      variant.frame_count = frames;
      ablation.variants.push_back(std::move(variant));
    }
  return ablation;
}

Ablation schedule() {
  Ablation ablation{"schedule", "Networks on every frame, or on as many as keep up", {}, {}, {},
                    false};
  ablation.columns = {kMiou, kMacc, kAp25, kAp50, kAp, kObjectMiou, kObjectAp50};
  const auto of_periods = [](std::string name, double masks_s, double views_s) {
    AblationVariant variant;
    variant.name = std::move(name);
    variant.schedule = AblationSchedule{masks_s, views_s};
    return variant;
  };
  // At 30 frames a second: every frame, every 5th, and the paper's every 30th and every 10th.
  ablation.variants = {of_periods("offline: every frame", 0, 0),
                       of_periods("masks 6 a second", 1. / 6, 0),
                       of_periods("masks 1 a second", 1, 0),
                       of_periods("paper: masks 1, views 3 a second", 1, 1. / 3)};
  AblationVariant by_itself;
  by_itself.name = "by motion (default)";
  ablation.variants.push_back(by_itself);
  ablation.published = published_schedule();
  return ablation;
}

}  // namespace

std::vector<AblationColumn> comparison_columns() {
  return {kObjectMiou, kObjectAp75, kObjectAp50, kObjectAp25, kMiou, kMacc, kAp25, kAp50, kAp};
}

std::vector<std::string> ablation_names() {
  return {"views", "masks", "fusion", "encoder", "incremental", "schedule"};
}

Ablation make_ablation(const std::string& name, const AblationChoice& choice) {
  if (name == "views") return views();
  if (name == "masks") return masks(choice.models);
  if (name == "fusion") return fusion();
  if (name == "encoder") return encoder(choice.encoders);
  if (name == "incremental") return incremental();
  if (name == "schedule") return schedule();
  std::vector<std::string> names = ablation_names();
  names.emplace_back(kTiming);
  throw Error(concat("ablation '", name, "': no such ablation, did you mean '",
                     nearest_word(name, names), "'?"));
}

}  // namespace ovimap::apps
