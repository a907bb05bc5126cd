// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/pipeline/sequence/sequence_run.h"
#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {

/// A box of one colour, world frame, metres.
struct Furniture {
  Eigen::AlignedBox3f box;
  Rgb8 color;
};

inline Furniture furniture(float x, float y, const Eigen::Vector3f& size, Rgb8 color) {
  const Eigen::Vector3f low(x - size.x() / 2, y - size.y() / 2, 0.f);
  return {{low, low + size}, color};
}

/// A floor of 4.4 x 3.6 m with boxes on it and two walls, seen by a camera that circles at 1.6 m
/// height over a part of the round: exact depth, colours and ids (1: floor, 2 and 3: walls, 4 ...
/// the boxes), for maps of one place at different times.
class FurnishedRoom : public FrameSource {
 public:
  std::vector<Furniture> things;
  double first_turn = 0, last_turn = 1;  ///< of the circle
  Pose world_from_room = Pose::Identity();
  int frames = 16;
  std::vector<Furniture> shell = {
      {{Eigen::Vector3f(-2.2f, -1.8f, -0.1f), Eigen::Vector3f(2.2f, 1.8f, 0.f)}, {90, 90, 90}},
      {{Eigen::Vector3f(-2.3f, -1.8f, 0.f), Eigen::Vector3f(-2.2f, 1.8f, 1.2f)}, {140, 140, 140}},
      {{Eigen::Vector3f(-2.2f, 1.8f, 0.f), Eigen::Vector3f(2.2f, 1.9f, 1.2f)}, {150, 150, 150}}};

  std::string kind() const override { return "furnished"; }
  std::int64_t size() const override { return frames; }

  FrameRead read(std::int64_t position) const override {
    Frame frame;
    frame.index = position;
    frame.name = "frame" + std::to_string(position);
    frame.color_camera = frame.depth_camera = kCamera;
    frame.world_from_camera = world_from_room * pose(position);
    frame.color = RgbImage(kCamera.width, kCamera.height);
    frame.depth = DepthImage(kCamera.width, kCamera.height);
    const IdImage ids = trace(pose(position), frame.depth);
    for (std::size_t i = 0; i < ids.size(); ++i) frame.color[i] = color_of(ids[i]);
    return {frame, ""};
  }

  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    DepthImage depth(kCamera.width, kCamera.height);
    return trace(pose(position), depth);
  }

 private:
  static constexpr PinholeCamera kCamera{200, 150, 140.f, 140.f, 99.5f, 74.5f};

  Pose pose(std::int64_t position) const {
    const double turn = first_turn + (last_turn - first_turn) * static_cast<double>(position) /
                                         static_cast<double>(frames);
    const double angle = 2 * M_PI * turn;
    const Eigen::Vector3d eye(1.5 * std::cos(angle), 1.2 * std::sin(angle), 1.6);
    const Eigen::Vector3d aim(-0.5 * std::cos(angle), -0.4 * std::sin(angle), 0.1);
    const Eigen::Vector3d forward = (aim - eye).normalized(),
                          right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
    Pose result = Pose::Identity();
    result.linear() << right, forward.cross(right), forward;
    result.translation() = eye;
    return result;
  }

  std::vector<Furniture> solids() const {
    std::vector<Furniture> all = shell;
    all.insert(all.end(), things.begin(), things.end());
    return all;
  }

  Rgb8 color_of(std::uint16_t id) const { return id == 0 ? Rgb8{} : solids()[id - 1u].color; }

  /// Where a ray enters a box; infinite when it does not.
  static float entry(const Eigen::AlignedBox3f& box, const Eigen::Vector3f& eye,
                     const Eigen::Vector3f& ray) {
    const Eigen::Array3f a = (box.min() - eye).array() / ray.array(),
                         b = (box.max() - eye).array() / ray.array();
    const float enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
    return enter > 0.f && enter <= leave ? enter : std::numeric_limits<float>::infinity();
  }

  IdImage trace(const Pose& room_from_camera, DepthImage& depth) const {
    const std::vector<Furniture> all = solids();
    const Eigen::Vector3f eye = room_from_camera.translation().cast<float>();
    IdImage ids(kCamera.width, kCamera.height);
    for (int y = 0; y < kCamera.height; ++y)
      for (int x = 0; x < kCamera.width; ++x) {
        const Eigen::Vector3f ray =
            room_from_camera.linear().cast<float>() *
            kCamera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
        float nearest = 8.f;
        for (std::size_t i = 0; i < all.size(); ++i)
          if (const float t = entry(all[i].box, eye, ray); t < nearest) {
            nearest = t;
            ids.at(x, y) = static_cast<std::uint16_t>(i + 1);
            depth.at(x, y) = t;
          }
      }
    return ids;
  }
};

/// The room's true ids as 2D entities.
class FurnishedMasks : public MaskSource {
 public:
  explicit FurnishedMasks(const FurnishedRoom& room) : room_(room) {}
  std::int64_t masked_every = 1;  ///< the frames between are not masked
  bool blind = false;             ///< sees nothing from the second frame on
  std::string kind() const override { return "furnished"; }
  std::optional<Entities> entities(const Frame& frame, std::span<const MaskPrompt>) override {
    if (frame.index % masked_every != 0) return std::nullopt;
    if (blind && frame.index != 0)
      return Entities{IdImage(frame.color.width(), frame.color.height()), {}};
    return Entities{*room_.truth_ids(frame.index),
                    std::vector<float>(room_.things.size() + room_.shell.size(), 1.f)};
  }

 private:
  const FurnishedRoom& room_;
};

inline MapperConfig furnished_config() {
  MapperConfig config;
  config.map.voxel_size_m = 0.02f;
  config.semantics.views.min_mask_px = 20;
  config.semantics.views.min_first_depth_px = config.semantics.views.min_depth_px = 10;
  return config;
}

/// The room mapped with true masks and embeddings of colours, or without embeddings; as another
/// visit to the place of `begun` where there is one.
inline MapDocument map_of(const FurnishedRoom& room, MapDocument begun = MapDocument(),
                          bool embedded = true) {
  Mapper mapper(furnished_config(), std::make_shared<FurnishedMasks>(room),
                embedded ? std::make_shared<ColorEncoder>() : nullptr);
  std::vector<std::int64_t> all(static_cast<std::size_t>(room.frames));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int64_t>(i);
  MapHeader header{"furnished"};
  SequenceResult done;
  if (!begun.frames.empty()) {
    const std::int64_t next = begun.frames.back().index + 1;
    header.history.visits = {{"furnished", 0, 0},
                             {"furnished", static_cast<std::int64_t>(begun.frames.size()), next}};
    header.names = begun.names;
    done.frames = begun.frames;
    done.depth_camera = begun.depth_camera;
    mapper.restore(std::move(begun));
    mapper.number_from(next);
  }
  const SequenceResult result = run_sequence(room, all, mapper, nullptr, std::move(done));
  MapDocument document = make_document(std::move(mapper), result, std::move(header));
  document.up = room.world_from_room.linear().cast<float>() * Eigen::Vector3f::UnitZ();
  return document;
}

/// The object whose centroid is nearest to a place of the room.
inline InstanceId object_at(const MapRecord& map, const Pose& room_from_world, float x, float y,
                            float z) {
  InstanceId best = 0;
  float least = std::numeric_limits<float>::max();
  for (const InstanceSummary& instance : map.instances) {
    const Eigen::Vector3f centroid = room_from_world.cast<float>() * instance.centroid;
    const float distance = (centroid - Eigen::Vector3f(x, y, z)).norm();
    if (distance < least) least = distance, best = instance.id;
  }
  return least < 0.35f ? best : 0;
}

}  // namespace ovimap
