// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/mesh/ply.h"
#include "program_fixture.h"

namespace ovimap {

/// The truth is the map itself, so that every figure that knows no classes is perfect.
class TruthfulProgramTest : public EncodedProgramTest {
 protected:
  void make_map(const std::string& encoder) {
    map_with(encoder);
    ASSERT_EQ(run("export room.ovimap truth.ply").code, 0);
    write_truth(read_ply(path("truth.ply")));
  }

  void write_truth(const Mesh& mesh) {
    write_ply(path("replica/scene_mesh.ply"), mesh);
    std::string instances, classes;
    for (const std::uint32_t label : mesh.labels) {
      instances += concat(label, "\n");
      classes += concat(label == 0 ? 0 : label % 3 + 1, "\n");
    }
    write_text(path("replica/instance_labels_scene.txt"), instances);
    write_text(path("replica/semantic_labels_scene.txt"), classes);
    write_text(path("replica/labels.json"),
               R"({"classes": {"1": "wall", "2": "sofa", "3": "teapot"}})");
  }

  /// The truth's mesh with every position put elsewhere; the labels stay.
  void move_truth(const Eigen::Matrix3f& by) {
    Mesh mesh = read_ply(path("truth.ply"));
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex = by * vertex;
    write_ply(path("replica/scene_mesh.ply"), mesh);
  }
};

}  // namespace ovimap
