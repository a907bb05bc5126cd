// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Our side of the comparison with Open3D (open3d_fusion.py): fuses and casts frames one by one,
// when told to on stdin, and prints what each took. Usage: ovimap_fusion_steps RECORDING FOLDER
// FOLDER takes the frames as raw arrays, colour registered to depth, so that both sides get the
// same.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/instance/association.h"
#include "ovimap/io/mesh/ply.h"
#include "ovimap/map/fusion/integrate.h"
#include "ovimap/map/rays/ray_cast.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/pipeline/mapping/prepared_frame.h"

namespace ovimap {
namespace {

constexpr float kMaxRange_m = 10.f;

template <class T>
void write_raw(const std::filesystem::path& path, const T* values, std::size_t count) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(values),
             static_cast<std::streamsize>(count * sizeof(T)));
}

double milliseconds(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

class Steps {
 public:
  Steps(const std::filesystem::path& recording, std::filesystem::path folder)
      : source_(open_frame_source(recording)), folder_(std::move(folder)) {}

  std::int64_t size() const { return source_->size(); }

  /// Readies a frame and writes it for the other side; what its depth segmentation took.
  double load(std::int64_t position) {
    FrameRead read = source_->read(position);
    if (!read.frame) throw Error(read.fault);
    StageTimers timers;
    frame_ = std::make_unique<PreparedFrame>(
        prepare_frame(std::make_shared<const Frame>(std::move(*read.frame)), config_, timers));
    cut_ = *cut_segments(*frame_, nullptr, config_, timers);
    const Frame& frame = *frame_->frame;
    write_raw(folder_ / "depth", frame.depth.data(), frame.depth.size());
    write_raw(folder_ / "color", frame_->color.data(), frame_->color.size());
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> pose = frame.world_from_camera.matrix();
    write_raw(folder_ / "pose", pose.data(), 16);
    const PinholeCamera& c = frame.depth_camera;
    const double camera[] = {double(c.width), double(c.height), c.fx, c.fy, c.cx, c.cy};
    write_raw(folder_ / "camera", camera, 6);
    const auto stages = timers.summary();
    return stages.at("surface").total_ms + stages.at("regions").total_ms;
  }

  /// Association by votes, then fusion of distance, colour and labels.
  double fuse() {
    const auto start = std::chrono::steady_clock::now();
    const Frame& frame = *frame_->frame;
    const auto voxels =
        surface_voxels(map_, frame.depth, frame.depth_camera, frame.world_from_camera);
    std::vector<Label> labels;
    for (const auto& segment : associate(cut_.segments, voxels, map_, config_.association))
      labels.push_back(segment.label);
    integrate(map_, {.depth = frame.depth,
                     .camera = frame.depth_camera,
                     .world_from_camera = frame.world_from_camera,
                     .color = &frame_->color,
                     .plane_slope = &frame_->surface.plane_slope,
                     .segment_ids = &cut_.segments.ids,
                     .segment_labels = labels});
    return milliseconds(start);
  }

  /// Depth and label of every pixel, as mapping asks for them: guided by the sensor's depth.
  double cast_guided() const {
    const auto start = std::chrono::steady_clock::now();
    const Frame& frame = *frame_->frame;
    const auto voxels =
        surface_voxels(map_, frame.depth, frame.depth_camera, frame.world_from_camera);
    (void)cast_rays_with_depth(map_, frame.depth, voxels, frame.depth_camera,
                               frame.world_from_camera, kMaxRange_m);
    return milliseconds(start);
  }

  /// The same without the guide, as a viewer asks for them.
  double cast_all() const {
    const auto start = std::chrono::steady_clock::now();
    const Frame& frame = *frame_->frame;
    (void)cast_rays(map_, frame.depth_camera, frame.world_from_camera, kMaxRange_m);
    return milliseconds(start);
  }

  void write_mesh(const std::filesystem::path& path) const { write_ply(path, extract_mesh(map_)); }

 private:
  std::unique_ptr<FrameSource> source_;
  std::filesystem::path folder_;
  MapperConfig config_;
  VoxelMap map_{config_.map};
  std::unique_ptr<PreparedFrame> frame_;
  FrameSegments cut_;
};

int serve(Steps& steps) {
  std::printf("%lld\n", static_cast<long long>(steps.size()));
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string command, argument;
    words >> command >> argument;
    double answer = 0;
    if (command == "load") answer = steps.load(std::stoll(argument));
    if (command == "fuse") answer = steps.fuse();
    if (command == "guided") answer = steps.cast_guided();
    if (command == "cast") answer = steps.cast_all();
    if (command == "mesh") steps.write_mesh(argument);
    std::printf("%.4f\n", answer);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace ovimap

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: ovimap_fusion_steps RECORDING FOLDER\n", stderr);
    return 2;
  }
  try {
    ovimap::Steps steps(argv[1], argv[2]);
    return ovimap::serve(steps);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ovimap_fusion_steps: %s\n", error.what());
    return 2;
  }
}
