// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

class ConfigFields;

struct FrameStoreConfig {
  int max_mb = 0;          ///< for all kept frames together, 10^6 bytes; 0: none is kept
  int color_quality = 85;  ///< of their JPEGs, 1 to 100
  /// A frame whose pose is corrected stays as it was fused where that moves by less than so many
  /// voxels what it shows still_at_m ahead: the map cannot show it.
  float still_voxels = 0.5f;
  float still_at_m = 3.f;
};
void list_fields(FrameStoreConfig& config, ConfigFields& fields);

/// Whether frames are of another camera and not of one whose lens breathes: of another size, or
/// focal lengths or a centre that differ by a fiftieth of the width.
bool is_other_camera(const PinholeCamera& a, const PinholeCamera& b);

/// The images that a kept frame was compressed from; all have the depth camera's size.
struct KeptImages {
  DepthImage depth;     ///< metres, 0 = invalid
  RgbImage color;       ///< registered to the depth; black = unknown
  IdImage segment_ids;  ///< empty: the frame did not vote for labels
};
/// Throws Error with a phrase when the images are not of that size, or a segment has no label.
KeptImages decode_kept(const KeptFrame& frame, const PinholeCamera& depth_camera);
/// The depth alone; throws likewise.
DepthImage decode_kept_depth(const KeptFrame& frame, const PinholeCamera& depth_camera);

/// Keeps fused frames, compressed, so that they can be fused again when their poses turn out to be
/// wrong. When they grow beyond the budget, every second of them goes, and from there on only
/// every second, fourth, ... frame is kept: what is kept stays spread over the whole recording.
/// All are of one camera: those of an earlier one go when another comes.
class FrameStore {
 public:
  explicit FrameStore(const FrameStoreConfig& config) : config_(config) {}

  /// The next fused frame. `segment_ids` may be null; `labels`: of the segments, [id - 1].
  void add(std::int64_t source_index, const PinholeCamera& depth_camera, const DepthImage& depth,
           const RgbImage& color, const IdImage* segment_ids, std::span<const Label> labels);
  /// The labels of a frame that was added without, if it is kept.
  void add_labels(std::int64_t source_index, const IdImage& segment_ids,
                  std::span<const Label> labels);

  /// By their position among the fused frames.
  const KeptFrames& frames() const { return frames_; }
  /// Goes on with what another one kept of so many frames.
  void restore(KeptFrames frames, std::size_t fused, const PinholeCamera& depth_camera);

 private:
  void make_room();

  FrameStoreConfig config_;
  PinholeCamera camera_;  ///< of the frames
  KeptFrames frames_;
  std::map<std::int64_t, std::size_t> positions_;  ///< of kept frames, by source index
  std::size_t bytes_ = 0;
  std::size_t fused_ = 0;   ///< frames seen
  std::size_t stride_ = 1;  ///< every how manieth is kept
};

}  // namespace ovimap
