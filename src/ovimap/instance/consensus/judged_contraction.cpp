// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/judged_contraction.h"

#include <tsl/robin_map.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace ovimap {

namespace {

using Node = std::uint32_t;  ///< place of a root among all roots in order

constexpr int kWitnesses = 3;  // frames that say the same of two clusters, and none otherwise
constexpr float kSure = 16.f;  // what they say comes before what is only likely

class LearnedJudge : public PairJudge {
 public:
  float log_odds(const PairFeatures& features, Label, Label) override {
    return log_odds_of_one(features);
  }
};

/// A cluster goes by its oldest node.
class JudgedContraction {
 public:
  JudgedContraction(std::span<const Label> roots, const EntitySightings& sightings, bool masked,
                    const SuperPointShapes& shapes, double apart_weight, PairJudge& judge)
      : roots_(roots),
        masked_(masked),
        apart_weight_(apart_weight),
        judge_(judge),
        borders_of_(roots.size()),
        version_(roots.size(), 0) {
    into_.resize(roots_.size());
    std::iota(into_.begin(), into_.end(), Node{0});
    for (const Label root : roots_) clusters_.push_back(cluster_of(root, sightings, shapes));
    measure_entities();
    touch(shapes);
    meet();
    agreement_ = mean_agreement();
  }

  void run() {
    for (Node node = 0; node < roots_.size(); ++node)
      for (const auto& [other, border] : borders_of_[node])
        if (node < other) judge(node, other);
    while (!queue_.empty()) {
      const Judged next = queue_.top();
      queue_.pop();
      if (next.old_version == version_[next.old] && next.young_version == version_[next.young])
        contract(next.old, next.young);
    }
  }

  std::map<Label, Label> objects() const {
    std::map<Label, Label> objects;
    for (Node node = 0; node < roots_.size(); ++node) {
      Node cluster = node;
      while (into_[cluster] != cluster) cluster = into_[cluster];
      objects.emplace_hint(objects.end(), roots_[node], roots_[cluster]);
    }
    return objects;
  }

 private:
  /// By the other cluster; no edges where they meet in entities alone.
  using Borders = tsl::robin_map<Node, SuperPointBorder>;

  struct Judged {
    float log_odds;
    Node old, young;
    std::uint32_t old_version, young_version;
    /// Among equals the older go first.
    bool operator<(const Judged& other) const {
      return std::tie(log_odds, other.old, other.young) < std::tie(other.log_odds, old, young);
    }
  };

  static PointCluster cluster_of(Label root, const EntitySightings& sightings,
                                 const SuperPointShapes& shapes) {
    PointCluster cluster;
    if (const auto found = shapes.of.find(root); found != shapes.of.end())
      cluster.shape = found->second;
    const std::int64_t vertices = std::max<std::int64_t>(1, cluster.shape.vertices);
    for (const EntitySighting& sighting : sightings.at(root)) {
      cluster.shares.push_back({sighting, vertices, 0});
      cluster.rated |= sighting.is_rated();
    }
    return cluster;
  }

  void measure_entities() {
    std::map<EntitySighting, std::int64_t> vertices;
    for (const PointCluster& cluster : clusters_)
      for (const EntityShare& share : cluster.shares) vertices[share.sighting] += share.vertices;
    for (PointCluster& cluster : clusters_)
      for (EntityShare& share : cluster.shares) share.entity_vertices = vertices[share.sighting];
  }

  void touch(const SuperPointShapes& shapes) {
    for (const auto& [labels, border] : shapes.borders) {
      const auto a = place_of(labels.first), b = place_of(labels.second);
      if (a == roots_.size() || b == roots_.size()) continue;
      borders_of_[a][b] += border;
      borders_of_[b][a] += border;
    }
  }

  /// The end where it is none of those to be contracted.
  Node place_of(Label root) const {
    const auto found = std::lower_bound(roots_.begin(), roots_.end(), root);
    return static_cast<Node>((found != roots_.end() && *found == root ? found : roots_.end()) -
                             roots_.begin());
  }

  void meet() {
    std::vector<std::pair<EntitySighting, Node>> shown;
    for (Node node = 0; node < clusters_.size(); ++node)
      for (const EntityShare& share : clusters_[node].shares)
        shown.emplace_back(share.sighting, node);
    std::sort(shown.begin(), shown.end());
    for (std::size_t i = 0; i < shown.size(); ++i)
      for (std::size_t j = i + 1; j < shown.size() && shown[j].first == shown[i].first; ++j) {
        borders_of_[shown[i].second].try_emplace(shown[j].second);
        borders_of_[shown[j].second].try_emplace(shown[i].second);
      }
  }

  /// Of all frames that show two super-points which some frame joins, the share that says of them
  /// what most say.
  float mean_agreement() const {
    double agreed = 0, met = 0;
    for (Node node = 0; node < roots_.size(); ++node)
      for (const auto& [other, border] : borders_of_[node]) {
        if (other < node) continue;
        const Meetings meetings = meetings_of(clusters_[node], clusters_[other]);
        if (meetings.joined == 0) continue;
        agreed += std::max(meetings.joined, meetings.apart);
        met += meetings.joined + meetings.apart;
      }
    return met > 0 ? static_cast<float>(agreed / met) : 1.f;
  }

  void judge(Node old, Node young) {
    const float log_odds = log_odds_of(old, young);
    if (log_odds > 0) queue_.push({log_odds, old, young, version_[old], version_[young]});
  }

  float log_odds_of(Node old, Node young) {
    const PointCluster &a = clusters_[old], &b = clusters_[young];
    const Meetings met = meetings_of(a, b);
    const auto by_masks =
        static_cast<float>(std::log1p(met.joined) - std::log1p(apart_weight_ * met.apart));
    if (a.shape.vertices == 0 || b.shape.vertices == 0) return by_masks;
    if (masked_ && !a.rated && !b.rated && are_unanimous(met)) return kSure * by_masks;
    return judge_.log_odds(pair_features(a, b, met, borders_of_[old].at(young), agreement_),
                           roots_[old], roots_[young]);
  }

  static bool are_unanimous(const Meetings& met) {
    return (met.apart == 0 && met.joined >= kWitnesses) ||
           (met.joined == 0 && met.apart >= kWitnesses);
  }

  void contract(Node old, Node young) {
    clusters_[old] = united(clusters_[old], clusters_[young]);
    clusters_[young] = {};
    into_[young] = old;
    ++version_[old], ++version_[young];
    borders_of_[old].erase(young);
    const Borders moved = std::exchange(borders_of_[young], {});
    for (const auto& [other, border] : moved) {
      borders_of_[other].erase(young);
      if (other == old) continue;
      borders_of_[old][other] += border;
      borders_of_[other][old] += border;
    }
    judge_.united(roots_[old], roots_[young]);
    for (const auto& [other, border] : borders_of_[old])
      judge(std::min(old, other), std::max(old, other));
  }

  std::span<const Label> roots_;
  bool masked_;
  double apart_weight_;
  PairJudge& judge_;
  std::vector<PointCluster> clusters_;
  std::vector<Borders> borders_of_;
  std::vector<Node> into_;              ///< the cluster each went into; itself while it is one
  std::vector<std::uint32_t> version_;  ///< of each cluster, counts how often it changed
  float agreement_ = 1;
  std::priority_queue<Judged> queue_;
};

}  // namespace

std::map<Label, Label> contract_by_judge(std::span<const Label> roots,
                                         const EntitySightings& sightings, bool masked,
                                         const SuperPointShapes& shapes, double apart_weight,
                                         PairJudge& judge) {
  JudgedContraction contraction(roots, sightings, masked, shapes, apart_weight, judge);
  contraction.run();
  return contraction.objects();
}

std::map<Label, Label> contract_by_judge(std::span<const Label> roots,
                                         const EntitySightings& sightings, bool masked,
                                         const SuperPointShapes& shapes, double apart_weight) {
  LearnedJudge judge;
  return contract_by_judge(roots, sightings, masked, shapes, apart_weight, judge);
}

}  // namespace ovimap
