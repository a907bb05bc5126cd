// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Scores scenes given as text, so that an implementation in another language can be compared:
//   classes COUNT STUFF...
//   scene VERTICES
//   TRUTH_ID TRUTH_CLASS PREDICTED_ID        (one line a vertex)
//   instances COUNT
//   ID CLASS CONFIDENCE                      (one line a predicted instance)
// Prints "NAME VALUE" lines; figures of one class as "PROTOCOL.CLASS.FIGURE", absent ones as
// "none".
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

#include "ovimap/eval/scores/semantic_scores.h"
#include "ovimap/eval/scores/standard_scores.h"

namespace ovimap {
namespace {

SemanticScene read_scene(std::size_t vertices) {
  SemanticScene scene;
  scene.instances.truth.resize(vertices);
  scene.instances.predicted.resize(vertices);
  scene.truth_classes.resize(vertices);
  for (std::size_t v = 0; v < vertices; ++v)
    std::cin >> scene.instances.truth[v] >> scene.truth_classes[v] >> scene.instances.predicted[v];
  std::string word;
  std::size_t count = 0;
  std::cin >> word >> count;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t id = 0;
    std::int32_t class_number = 0;
    float confidence = 0;
    std::cin >> id >> class_number >> confidence;
    scene.predicted_classes[id] = class_number;
    scene.instances.confidence[id] = confidence;
  }
  return scene;
}

void print(const std::string& name, const std::optional<double>& value) {
  if (value)
    std::printf("%s %.17g\n", name.c_str(), *value);
  else
    std::printf("%s none\n", name.c_str());
}

void print_classes(const std::string& protocol, const std::vector<ClassScores>& scores) {
  for (const ClassScores& score : scores) {
    const std::string prefix = protocol + "." + std::to_string(score.class_number) + ".";
    print(prefix + "iou", score.iou);
    print(prefix + "accuracy", score.accuracy);
    print(prefix + "ap25", score.ap25);
    print(prefix + "ap50", score.ap50);
    print(prefix + "ap75", score.ap75);
    print(prefix + "ap", score.ap);
    print(prefix + "pq", score.pq);
  }
  const SemanticScores means = mean_scores(scores);
  print(protocol + ".miou", means.miou);
  print(protocol + ".macc", means.macc);
  print(protocol + ".fwiou", means.fwiou);
  print(protocol + ".ap", means.ap);
  print(protocol + ".pq", means.pq);
}

void print_class_agnostic(const std::vector<SemanticScene>& scenes) {
  std::vector<LabelledScene> labelled;
  for (const SemanticScene& scene : scenes) labelled.push_back(scene.instances);
  const StandardScores scores = standard_scores(labelled);
  print("instances.ap25", scores.ap25);
  print("instances.ap50", scores.ap50);
  print("instances.ap75", scores.ap75);
  print("instances.ap", scores.ap);
  print("instances.miou", scores.miou);
}

int score() {
  SemanticClasses classes;
  std::vector<SemanticScene> scenes;
  std::string line, word;
  std::getline(std::cin, line);
  std::istringstream first(line);
  first >> word >> classes.count;
  for (std::int32_t stuff = 0; first >> stuff;) classes.stuff.push_back(stuff);
  for (std::size_t vertices = 0; std::cin >> word >> vertices;)
    scenes.push_back(read_scene(vertices));
  print_classes("standard", standard_class_scores(scenes, classes));
  print_classes("reference", reference_class_scores(scenes, classes));
  print_class_agnostic(scenes);
  return 0;
}

}  // namespace
}  // namespace ovimap

int main() {
  return ovimap::score();
}
