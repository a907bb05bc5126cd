// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/frame_store.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

constexpr float kUnits_per_m = 4000.f;  // a quarter of a millimetre, up to 16.38 m
constexpr float kFurthest = 65535.f;
/// JPEGs turn the black of unknown colour into something near it.
constexpr int kDarkest = 12;

Image<std::uint16_t> depth_units(const DepthImage& depth) {
  Image<std::uint16_t> units(depth.width(), depth.height());
  std::transform(depth.begin(), depth.end(), units.begin(), [](float metres) {
    const float value = std::round(metres * kUnits_per_m);
    return value > 0.f && value <= kFurthest ? static_cast<std::uint16_t>(value) : std::uint16_t{0};
  });
  return units;
}

void set_labels(const IdImage& segment_ids, std::span<const Label> labels, KeptFrame& frame) {
  frame.segments_png = encode_png(segment_ids);
  frame.labels.assign(labels.begin(), labels.end());
}

std::size_t size_of(const KeptFrame& frame) {
  return frame.depth_png.size() + frame.color_jpeg.size() + frame.segments_png.size() +
         frame.labels.size() * sizeof(Label);
}

}  // namespace

void list_fields(FrameStoreConfig& config, ConfigFields& fields) {
  fields.add("max_mb", config.max_mb, 0, 1 << 30,
             "fused frames kept in the map for `ovimap correct`, 10^6 bytes; 0: none");
  fields.add("color_quality", config.color_quality, 1, 100, "of their colour, as JPEG");
  fields.add("still_voxels", config.still_voxels, 0.f, 1e6f,
             "a closed loop fuses again what moved by more than so many voxels");
  fields.add("still_at_m", config.still_at_m, 0.f, 1000.f, "measured so far ahead of the camera");
}

DepthImage decode_kept_depth(const KeptFrame& frame, const PinholeCamera& depth_camera) {
  const ImageSize size{depth_camera.width, depth_camera.height};
  const GrayPng units = decode_gray(frame.depth_png, size);
  DepthImage depth(units.values.width(), units.values.height());
  std::transform(units.values.begin(), units.values.end(), depth.begin(),
                 [](std::uint16_t value) { return static_cast<float>(value) / kUnits_per_m; });
  return depth;
}

KeptImages decode_kept(const KeptFrame& frame, const PinholeCamera& depth_camera) {
  const ImageSize size{depth_camera.width, depth_camera.height};
  KeptImages images;
  images.depth = decode_kept_depth(frame, depth_camera);
  images.color = decode_rgb(frame.color_jpeg, size);
  for (Rgb8& color : images.color)
    if (color.r + color.g + color.b <= kDarkest) color = {};
  if (frame.segments_png.empty()) return images;
  images.segment_ids = decode_gray(frame.segments_png, size).values;
  for (const std::uint16_t id : images.segment_ids)
    if (id > frame.labels.size())
      throw Error(concat("has segment ", id, ", but only ", frame.labels.size(), " labels"));
  return images;
}

bool is_other_camera(const PinholeCamera& a, const PinholeCamera& b) {
  if (a.width != b.width || a.height != b.height) return true;
  const Eigen::Array4f apart(a.fx - b.fx, a.fy - b.fy, a.cx - b.cx, a.cy - b.cy);
  return (apart.abs() > 0.02f * static_cast<float>(a.width)).any();
}

void FrameStore::add(std::int64_t source_index, const PinholeCamera& depth_camera,
                     const DepthImage& depth, const RgbImage& color, const IdImage* segment_ids,
                     std::span<const Label> labels) {
  if (is_other_camera(camera_, depth_camera)) restore({}, fused_, depth_camera);
  const std::size_t position = fused_++;
  if (config_.max_mb == 0 || position % stride_ != 0) return;
  auto frame = std::make_shared<KeptFrame>();
  frame->depth_png = encode_png(depth_units(depth));
  frame->color_jpeg = encode_jpeg(color, config_.color_quality);
  if (segment_ids) set_labels(*segment_ids, labels, *frame);
  bytes_ += size_of(*frame);
  frames_[position] = std::move(frame);
  positions_[source_index] = position;
  make_room();
}

void FrameStore::add_labels(std::int64_t source_index, const IdImage& segment_ids,
                            std::span<const Label> labels) {
  const auto position = positions_.find(source_index);
  const auto kept = position == positions_.end() ? frames_.end() : frames_.find(position->second);
  if (kept == frames_.end()) return;
  auto frame = std::make_shared<KeptFrame>(*kept->second);
  bytes_ -= size_of(*frame);
  set_labels(segment_ids, labels, *frame);
  bytes_ += size_of(*frame);
  kept->second = std::move(frame);
  make_room();
}

void FrameStore::make_room() {
  constexpr std::size_t kMegabyte = 1000000;
  while (bytes_ > static_cast<std::size_t>(config_.max_mb) * kMegabyte && frames_.size() > 1) {
    stride_ *= 2;
    std::erase_if(frames_, [&](const auto& entry) {
      const bool goes = entry.first % stride_ != 0;
      if (goes) bytes_ -= size_of(*entry.second);
      return goes;
    });
  }
}

void FrameStore::restore(KeptFrames frames, std::size_t fused, const PinholeCamera& depth_camera) {
  frames_ = std::move(frames);
  fused_ = fused;
  camera_ = depth_camera;
  bytes_ = 0;
  // Whoever kept every fourth frame kept those at multiples of four, but for a beginning that
  // nobody kept.
  std::size_t multiples = 0;
  for (const auto& [position, frame] : frames_) {
    bytes_ += size_of(*frame);
    multiples |= position;
  }
  stride_ = 1;
  while (multiples != 0 ? multiples % (2 * stride_) == 0 : !frames_.empty() && stride_ < fused_)
    stride_ *= 2;
}

}  // namespace ovimap
