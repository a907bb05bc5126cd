// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
//
// What the judge of pairs of super-points learns from, and what its groups are worth on a map.
//   ovimap_pair_samples MAP SCENE          scores of the map's objects, of those that masks alone
//   and the judge make, and of perfect groups,
//                                          then the IoU of each true thing in each of the four
//   ovimap_pair_samples MAP SCENE OUT      writes samples: 32-bit floats, features of a pair,
//   whether it is one thing, its weight
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "ovimap/eval/scenes/overlap.h"
#include "ovimap/eval/scores/standard_scores.h"
#include "ovimap/instance/consensus/judged_contraction.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/truth/truth.h"
#include "ovimap/map/surface/mesh_extraction.h"

namespace {

using namespace ovimap;

/// Vertices of the truth that a super-point covers, by true object; 0 and less: of none.
using Shares = std::map<std::int32_t, int>;

std::int32_t owner(const Shares& shares) {
  if (shares.empty()) return 0;
  return std::max_element(shares.begin(), shares.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

struct LabelledTruth {
  Truth truth;
  std::vector<std::uint32_t> labels;  ///< of the truth's vertices
  std::map<Label, Shares> shares;

  LabelledTruth(const MapDocument& document, const std::string& scene) : truth(load_truth(scene)) {
    const Mesh mesh = extract_mesh(document.map);
    labels = transfer_labels(truth.mesh.vertices, mesh.vertices, mesh.labels);
    for (std::size_t i = 0; i < labels.size(); ++i)
      if (labels[i] != kNoLabel) ++shares[labels[i]][truth.instances[i]];
  }

  /// What is scored, under objects made of super-points.
  LabelledScene scene(const std::map<Label, std::uint32_t>& object_of) const {
    LabelledScene scene{truth.instances, {}, {}};
    for (std::int32_t& id : scene.truth)
      if (truth.unscored.count(id) > 0) id = 0;
    for (const std::uint32_t label : labels) {
      const auto found = object_of.find(label);
      scene.predicted.push_back(found == object_of.end() ? 0 : found->second);
    }
    return scene;
  }

  void print(const char* name, const LabelledScene& scene) const {
    const StandardScores scores = standard_scores(std::span(&scene, 1));
    std::printf("%-10s AP75 %.3f AP50 %.3f AP25 %.3f mIoU %.3f, %d objects for %d\n", name,
                scores.ap75, scores.ap50, scores.ap25, scores.miou, scores.predicted_instances,
                scores.truth_instances);
  }
};

/// Groups nearly as the truth would and writes down what it was asked: the judge is to know
/// clusters of every size, and such as hold a mistake. In some rounds in any order, in others in
/// the order that the judge of today would choose, with some of its mistakes: these are what it
/// will meet.
class Sampler : public PairJudge {
 public:
  Sampler(std::map<Label, Shares> shares, unsigned round, std::FILE* file)
      : shares_(std::move(shares)), chance_(round), learned_(round % 2 == 1), file_(file) {}

  float log_odds(const PairFeatures& features, Label a, Label b) override {
    const std::int32_t of_a = owner(shares_[a]), of_b = owner(shares_[b]);
    if (of_a <= 0 && of_b <= 0) return -1;
    const bool same = of_a == of_b;
    write(features, same);
    if (!learned_) return same != (any() < 0.01f) ? any() + 0.01f : -1.f;
    const float judged = log_odds_of_one(features);
    if (same == (judged > 0)) return judged;
    return same ? (any() < 0.2f ? 0.01f : judged) : (any() < 0.2f ? judged : -1.f);
  }

  void united(Label old, Label young) override {
    for (const auto& [truth, count] : shares_[young]) shares_[old][truth] += count;
    shares_.erase(young);
  }

 private:
  void write(const PairFeatures& features, bool same) {
    std::fwrite(features.data(), sizeof(float), features.size(), file_);
    const float verdict = same;
    std::fwrite(&verdict, sizeof(float), 1, file_);
  }

  float any() { return std::uniform_real_distribution<float>(0.f, 1.f)(chance_); }

  std::map<Label, Shares> shares_;
  std::mt19937 chance_;
  bool learned_;
  std::FILE* file_;
};

std::vector<Label> roots_of(const EntitySightings& sightings) {
  std::vector<Label> roots;
  for (const auto& [root, seen] : sightings) roots.push_back(root);
  return roots;
}

void write_samples(const MapDocument& document, const LabelledTruth& truth,
                   const SuperPointShapes& shapes, const char* path) {
  constexpr unsigned kRounds = 4;
  std::FILE* file = std::fopen(path, "wb");
  if (!file) throw Error(std::string("cannot write ") + path);
  const EntitySightings& sightings = document.registry.entity_sightings;
  for (unsigned round = 0; round < kRounds; ++round) {
    Sampler sampler(truth.shares, round, file);
    contract_by_judge(roots_of(sightings), sightings, false, shapes,  // it learns of all pairs
                      document.instance_config.consensus.apart_weight, sampler);
  }
  std::fclose(file);
}

using Overlaps = std::array<InstanceOverlaps, 4>;

/// The best IoU of a true thing, at its place among all, with any object.
double best_iou(const InstanceOverlaps& table, std::size_t thing) {
  double best = 0;
  for (const InstanceOverlap& overlap : table.overlaps)
    if (overlap.truth == thing) best = std::max(best, overlap.iou());
  return best;
}

void print_things(const Truth& truth, const Overlaps& tables) {
  for (std::size_t thing = 0; thing < tables[0].truth.size(); ++thing) {
    const InstanceSize& size = tables[0].truth[thing];
    const auto name = truth.instance_names.find(static_cast<std::int32_t>(size.id));
    std::printf("%-6lld %-22s %8lld points  map %.2f consensus %.2f judge %.2f perfect %.2f\n",
                static_cast<long long>(size.id),
                name == truth.instance_names.end() ? "" : name->second.c_str(),
                static_cast<long long>(size.vertices), best_iou(tables[0], thing),
                best_iou(tables[1], thing), best_iou(tables[2], thing), best_iou(tables[3], thing));
  }
}

std::map<Label, std::uint32_t> object_by_label(std::span<const InstanceSummary> objects) {
  std::map<Label, std::uint32_t> object_of;
  for (const InstanceSummary& object : objects)
    for (const Label label : object.super_points) object_of[label] = object.id;
  return object_of;
}

void print_scores(const MapDocument& document, const LabelledTruth& truth,
                  const SuperPointShapes& shapes) {
  InstanceRegistry registry(document.instance_config);
  registry.restore(document.registry);
  registry.settle(shapes, document.mask_frames > 0);
  std::map<Label, std::uint32_t> ideal;
  for (const auto& [label, shares] : truth.shares)
    ideal[label] = static_cast<std::uint32_t>(std::max(owner(shares), 0));
  InstanceRegistry plain(document.instance_config);
  plain.restore(document.registry);
  plain.settle();
  const std::array<LabelledScene, 4> scenes{
      truth.scene(object_by_label(document.instances)),
      truth.scene(object_by_label(summarize_instances(document.map, plain, {}))),
      truth.scene(object_by_label(summarize_instances(document.map, registry, {}))),
      truth.scene(ideal)};
  const std::array<const char*, 4> names{"map", "consensus", "judge", "perfect"};
  Overlaps tables;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    truth.print(names[i], scenes[i]);
    tables[i] = count_overlaps(scenes[i].truth, scenes[i].predicted, Background::kNotPositive);
  }
  print_things(truth.truth, tables);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "ovimap_pair_samples MAP SCENE [OUT]\n");
    return 2;
  }
  try {
    const MapDocument document = load_map(arguments[1]);
    const LabelledTruth truth(document, arguments[2]);
    const SuperPointShapes shapes = measure_super_points(document.map);
    if (count > 3)
      write_samples(document, truth, shapes, arguments[3]);
    else
      print_scores(document, truth, shapes);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "%s\n", fault.what());
    return 1;
  }
}
