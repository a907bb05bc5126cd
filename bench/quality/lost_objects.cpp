// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
//
// Says of every true object that a map lost at which step it was lost: whether its surface was
// never meshed or has no label, whether super-points already mix it with others, or whether the
// right super-points were put together wrongly.
//   ovimap_lost_objects MAP SCENE [IOU]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <optional>
#include <vector>

#include "ovimap/eval/scenes/labelled_scene.h"
#include "ovimap/eval/scenes/overlap.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/truth/truth.h"
#include "ovimap/map/surface/mesh_extraction.h"

namespace {

using namespace ovimap;

constexpr double kTelling = 0.05;  ///< smaller shares of an object are not printed

/// Vertices of each truth that a label holds.
using Shares = std::map<std::int32_t, int>;

struct Labelling {
  std::vector<std::uint32_t> of_vertex;       ///< 0 = none
  std::map<std::uint32_t, Shares> truths_of;  ///< by label
  InstanceOverlaps table;

  Labelling(const std::vector<std::int32_t>& truth, std::vector<std::uint32_t> labels)
      : of_vertex(std::move(labels)),
        table(count_overlaps(truth, of_vertex, Background::kNotPositive)) {
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (of_vertex[i] != 0) ++truths_of[of_vertex[i]][truth[i]];
  }

  struct Best {
    double iou = 0;
    std::int64_t predicted = 0;
  };
  std::map<std::int32_t, Best> best() const {
    std::map<std::int32_t, Best> result;
    for (const InstanceOverlap& overlap : table.overlaps) {
      Best& of = result[static_cast<std::int32_t>(table.truth[overlap.truth].id)];
      if (overlap.iou() > of.iou) of = {overlap.iou(), table.predicted[overlap.predicted].id};
    }
    return result;
  }
};

std::int32_t owner(const Shares& shares) {
  return std::max_element(shares.begin(), shares.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

class Report {
 public:
  Report(const MapDocument& document, const Truth& truth) : truth_(truth) {
    const Mesh mesh = extract_mesh(document.map);
    std::vector<std::uint32_t> points =
        transfer_labels(truth.mesh.vertices, mesh.vertices, mesh.labels);
    const std::vector<std::uint32_t> ones(mesh.vertices.size(), 1);
    seen_ = transfer_labels(truth.mesh.vertices, mesh.vertices, ones);
    object_of_.assign(document.map.labels().roots().size(), 0);
    for (const InstanceSummary& object : document.instances)
      for (const Label label : object.super_points) object_of_[label] = object.id;
    std::vector<std::uint32_t> objects;
    for (const std::uint32_t label : points) objects.push_back(object_of_[label]);
    super_points_.emplace(truth.instances, points);
    objects_.emplace(truth.instances, objects);
    // What a perfect grouping of these super-points would give.
    std::vector<std::uint32_t> ideal;
    std::map<std::uint32_t, std::uint32_t> owners;
    for (const auto& [label, shares] : super_points_->truths_of)
      owners[label] = static_cast<std::uint32_t>(std::max(owner(shares), 0));
    for (const std::uint32_t label : points) ideal.push_back(label == 0 ? 0 : owners.at(label));
    ideal_.emplace(truth.instances, ideal);
    for (std::size_t i = 0; i < truth.instances.size(); ++i) {
      ++size_[truth.instances[i]];
      seen_of_[truth.instances[i]] += seen_[i] != 0;
      labelled_of_[truth.instances[i]] += points[i] != 0;
    }
  }

  void print(double below) const {
    const auto best = objects_->best(), ideal = ideal_->best();
    int lost = 0;
    for (const InstanceSize& instance : objects_->table.truth) {
      const auto id = static_cast<std::int32_t>(instance.id);
      const auto found = best.find(id);
      const double iou = found == best.end() ? 0 : found->second.iou;
      if (iou >= below) continue;
      ++lost;
      const auto of_ideal = ideal.find(id);
      print_object(id, iou, of_ideal == ideal.end() ? 0 : of_ideal->second.iou, below);
    }
    int false_objects = 0;
    for (std::size_t i = 0; i < objects_->table.predicted.size(); ++i) {
      bool good = false;
      for (const InstanceOverlap& overlap : objects_->table.of_predicted(i))
        good = good || overlap.iou() >= below;
      if (good) continue;
      ++false_objects;
      const auto label = static_cast<std::uint32_t>(objects_->table.predicted[i].id);
      std::printf("surplus object %u, %lld vertices:", label,
                  static_cast<long long>(objects_->table.predicted[i].vertices));
      for (const auto& [id, count] : objects_->truths_of.at(label))
        if (count > kTelling * static_cast<double>(objects_->table.predicted[i].vertices))
          std::printf(" %s %d", name(id).c_str(), count);
      std::printf("\n");
    }
    std::printf("%zu true objects, %d below IoU %.2f; %zu found, %d surplus\n",
                objects_->table.truth.size(), lost, below, objects_->table.predicted.size(),
                false_objects);
  }

 private:
  std::string name(std::int32_t id) const {
    const auto found = truth_.instance_names.find(id);
    return std::to_string(id) + ":" + (found == truth_.instance_names.end() ? "?" : found->second);
  }

  void print_object(std::int32_t id, double iou, double ideal, double below) const {
    const double size = size_.at(id);
    const double seen = seen_of_.at(id) / size, labelled = labelled_of_.at(id) / size;
    const char* cause = labelled < below ? (seen < below ? "not meshed" : "not labelled")
                        : ideal < below  ? "mixed in super-points"
                                         : "grouped wrongly";
    std::printf(
        "%-24s %6.0f vertices, IoU %.2f, of its super-points at best %.2f; meshed %.2f, "
        "labelled %.2f: %s\n",
        name(id).c_str(), size, iou, ideal, seen, labelled, cause);
    for (const auto& [label, shares] : super_points_->truths_of) {
      const auto mine = shares.find(id);
      if (mine == shares.end() || mine->second < kTelling * size) continue;
      std::printf("    super-point %u of object %u holds %.2f of it; has:", label,
                  object_of_[label], mine->second / size);
      for (const auto& [other, count] : shares)
        if (count > kTelling * size) std::printf(" %s %d", name(other).c_str(), count);
      std::printf("\n");
    }
  }

  const Truth& truth_;
  std::vector<std::uint32_t> seen_;
  std::vector<std::uint32_t> object_of_;
  std::optional<Labelling> super_points_, objects_, ideal_;
  std::map<std::int32_t, int> size_, seen_of_, labelled_of_;
};

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "ovimap_lost_objects MAP SCENE [IOU]\n");
    return 2;
  }
  try {
    const MapDocument document = load_map(arguments[1]);
    const Truth truth = load_truth(arguments[2]);
    Report(document, truth).print(count > 3 ? std::atof(arguments[3]) : 0.5);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "%s\n", fault.what());
    return 1;
  }
}
