// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
//
// How large the things of a name are in a map, where, and how their surface is spread: what
// tools/make_seen_sizes.py learns from rendered rooms.
//   ovimap_object_measures MAP SCENE
// For each object that is a true one (IoU of a quarter or more) a line
// "word;height;length;depth;bottom;top share;covered share".
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "ovimap/eval/scenes/labelled_scene.h"
#include "ovimap/eval/scenes/overlap.h"
#include "ovimap/io/truth/truth.h"
#include "ovimap/pipeline/search/map_search.h"
#include "ovimap/semantics/relations/object_measures.h"

namespace {

using namespace ovimap;

constexpr double kLeastIou = 0.25;

/// The name of the true thing that an object is, by id.
std::map<InstanceId, std::string> names_of(const MapSearch& search, const Truth& truth) {
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> labels;
  const Eigen::Matrix3f world_from_ground = ground_from_world(search.info.up).transpose();
  for (std::size_t i = 0; i < search.scene.shapes.size(); ++i)
    for (const Eigen::Vector3f& point : search.scene.shapes.whole()[i].surface) {
      points.push_back(world_from_ground * point);
      labels.push_back(search.info.instances[i].id);
    }
  const InstanceOverlaps table =
      count_overlaps(truth.instances, transfer_labels(truth.mesh.vertices, points, labels),
                     Background::kNotPositive);
  std::map<InstanceId, std::string> names;
  for (const InstanceOverlap& overlap : table.overlaps) {
    const auto name =
        truth.instance_names.find(static_cast<std::int32_t>(table.truth[overlap.truth].id));
    if (overlap.iou() >= kLeastIou && name != truth.instance_names.end())
      names.try_emplace(static_cast<InstanceId>(table.predicted[overlap.predicted].id),
                        name->second);
  }
  return names;
}

void print_measures(const char* map, const char* scene) {
  const MapSearch search = open_map_search(map);
  const std::map<InstanceId, std::string> names = names_of(search, load_truth(scene));
  const std::vector<ObjectMeasures>& measures = search.scene.shapes.measures();
  for (std::size_t i = 0; i < measures.size(); ++i) {
    const auto name = names.find(search.info.instances[i].id);
    if (name == names.end()) continue;
    const ObjectMeasures& of = measures[i];
    std::printf("%s;%.4g;%.4g;%.4g;%.4g;%.4g;%.4g\n", name->second.c_str(), of.height_m,
                of.length_m, of.depth_m, of.bottom_m, of.top_share, of.covered_share);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: ovimap_object_measures MAP SCENE\n");
    return 2;
  }
  try {
    print_measures(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
