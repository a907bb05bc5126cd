// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

class ConfigFields;

/// What a thing measures: of the smallest upright box, turned about the vertical, round what is
/// seen of it.
struct MeasuredSize {
  float litres = 0;
  float thickness_m = 0;  ///< the least of its three sides
  float breadth_m = 0;    ///< the middle one
};

/// By id; of labels above 0. `points` in metres, z up, as long as `labels`.
std::map<std::int32_t, MeasuredSize> measured_sizes(std::span<const Eigen::Vector3f> points,
                                                    std::span<const std::int32_t> labels);

struct SizeGroupsConfig {
  float small_litres = 2, medium_litres = 20;
  float flat_thickness_m = 0.03f;  ///< flat things are no thicker ...
  float flat_breadth_ratio = 2;    ///< ... and so many times as broad
};
void list_fields(SizeGroupsConfig& config, ConfigFields& fields);

/// One scene: true things, what was found of them, and which count where.
struct SizedScene {
  std::vector<std::int32_t> truth;       ///< id per vertex, things that are not scored included
  std::vector<std::uint32_t> predicted;  ///< as in LabelledScene
  std::map<std::int32_t, MeasuredSize> sizes;
  std::set<std::int32_t> unscored;   ///< too small or too little seen
  std::set<std::int32_t> structure;  ///< walls, floors and ceilings: no things
};

struct RecallGroup {
  std::string name;
  int things = 0, found = 0;

  double recall() const { return things > 0 ? static_cast<double>(found) / things : 0; }
};

struct SizeRecall {
  RecallGroup small, medium, large;  ///< by litres
  RecallGroup flat;                  ///< of any of these sizes
  RecallGroup unscored;              ///< in no other group
  double objects_per_thing = 0;      ///< predicted instances / true ones, walls and all included
};

/// A thing is found by an instance whose IoU with it is at least one half; over all scenes. One
/// instance finds one thing: no two things share so much with it.
SizeRecall recall_by_size(std::span<const SizedScene> scenes, const SizeGroupsConfig& config = {});

}  // namespace ovimap
