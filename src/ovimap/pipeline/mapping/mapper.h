// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "ovimap/base/stage_timers.h"
#include "ovimap/frames/frame/frame.h"
#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/instance/instance_registry.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/map/rays/ray_cast.h"
#include "ovimap/map/voxels/voxel_map.h"
#include "ovimap/pipeline/mapping/appearance_builder.h"
#include "ovimap/pipeline/mapping/mapper_config.h"
#include "ovimap/pipeline/mapping/moved_fusion.h"
#include "ovimap/pipeline/mapping/picture_motion.h"
#include "ovimap/pipeline/mapping/prepared_frame.h"

namespace ovimap {

class MotionFilter;
struct MovingPixels;

/// What became of one frame.
struct FrameReport {
  int regions = 0;        ///< geometric regions
  int entities = 0;       ///< 2D entities; 0 as well when the frame was not masked
  int segments = 0;       ///< pieces lifted to 3D
  int founded = 0;        ///< new super-points
  int views = 0;          ///< views of objects chosen for embedding
  int moving_px = 0;      ///< pixels that were left out: what they show moves, or was taken
                          ///< out of the frame
  bool labelled = false;  ///< the frame voted for labels (else it added geometry and colour alone,
                          ///< as one that is not masked does)
};

/// The map of instances as one camera sees it.
struct InstanceView {
  DepthImage depth;             ///< metres, 0 = no surface
  Image<InstanceId> instances;  ///< 0 = none
  Image<Label> labels;          ///< roots of super-points, 0 = none
};

/// The class-agnostic instance map, built frame by frame in the paper's order (sections 3.1 and
/// supplement). Synchronous: the same frames give the same map, bit for bit, on every run and
/// thread count.
class Mapper {
 public:
  /// `masks` may be null: then every geometric region is an entity of its own (depth alone).
  /// `encoder` may be null: then objects keep crops of their best views, but no embeddings.
  explicit Mapper(const MapperConfig& config, std::shared_ptr<MaskSource> masks = nullptr,
                  std::shared_ptr<ImageTextEncoder> encoder = nullptr);

  ~Mapper();
  Mapper(Mapper&&) noexcept;
  Mapper& operator=(Mapper&&) noexcept;

  /// From now on views are also shown to what recognizes things; null: to nothing.
  void recognize_with(std::shared_ptr<const ThingRecognizer> recognizer) {
    builder_->recognize_with(std::move(recognizer));
  }
  RecognizerIdentity recognizer() const { return builder_->recognizer(); }

  /// Fuses one frame. Throws what the mask source throws, FrameError for a frame that contradicts
  /// nearly all of the map that it sees (sees_through_map), and, once, what the encoder threw on
  /// views of earlier frames; the map is then as it was before the frame, which can be given again.
  FrameReport process(const Frame& frame);
  /// The same, of a frame that was prepared with the mapper's config.
  FrameReport process(const PreparedFrame& prepared);

  // The parts of `process`, for a pipeline that runs the others on threads of its own.

  /// Notes what that pipeline does (MapRecord::live_steps).
  void note(const LiveStep& step) { live_steps_.push_back(step); }

  /// Adds geometry, colour and, unless `cut` is null, labels. Throws what the encoder threw.
  FrameReport fuse(const PreparedFrame& prepared, const FrameSegments* cut);
  /// Adds the labels of a frame that was fused without, some time ago: its segments vote with the
  /// depth and pose of their own frame on the map as it is now.
  FrameReport label(const PreparedFrame& prepared, const FrameSegments& all);
  enum class Encoder {
    kCatchUp,  ///< while too many views wait for the encoder, so does the mapper
    kRunOn,    ///< views wait, however many
  };
  /// Chooses views of the objects in sight and hands them to the encoder; returns how many.
  int look_at_objects(const Frame& frame, Encoder encoder = Encoder::kCatchUp);
  /// Whether few enough views wait for the encoder to look for more.
  bool encoder_keeps_up() const { return builder_->keeps_up(); }

  /// Moves the map to where its frames are by now: `poses` of all frames so far (world_from_camera
  /// of their depth camera). What a frame shows that moved visibly from where it was fused
  /// (FrameStoreConfig::still_voxels) is fused anew from what is kept (fuse_moved); labels stay
  /// what they are, and so do objects. touched_blocks() are those that were made anew. Frames must
  /// be kept. A map with a store stays within its bound; its blocks may not be frozen then.
  /// `progress(done, total)`: after each kept frame. Throws Error when one is damaged.
  FusedAgain fuse_again(const std::vector<Pose>& poses, const PinholeCamera& depth_camera,
                        const std::function<void(std::size_t, std::size_t)>& progress = nullptr);

  /// The map seen from a frame's depth camera, guided by its depth (method section 8).
  InstanceView project(const Frame& frame);

  /// What super-points look like now; views that the encoder has not answered have no embedding
  /// yet.
  const SuperPointLooks& looks() const { return builder_->looks(); }
  /// The same, to be stored (AppearanceBuilder::remember).
  std::shared_ptr<PendingLooks> remember_looks() { return builder_->remember(map_.labels()); }
  /// What is to be stored beside the voxels, but for what the objects look like and what is found
  /// at the end: `frames` were fused, seen by `depth_camera`.
  MapRecord record(MapHeader header, std::vector<FrameLogEntry> frames,
                   const PinholeCamera& depth_camera) const;
  /// Goes on where the mapper of a stored map stopped, which had the same config; on a fresh mapper
  /// only.
  void restore(MapDocument&& document);
  /// From now on frames are of another recording, whose position 0 is that number in the map.
  void number_from(std::int64_t first) { first_number_ = first; }
  /// What the map calls a frame (FrameLogEntry::index).
  std::int64_t number_of(const Frame& frame) const { return first_number_ + frame.index; }

  /// From now on what the encoder throws is counted instead of thrown; its views stay without
  /// embedding.
  void forgive_encoder() { builder_->forgive_encoder(); }
  EncoderFailures encoder_failures() const { return builder_->encoder_failures(); }
  /// Takes in what the encoder has answered by now, as every look at objects does.
  void take_embeddings() { builder_->take_answers(map_.labels()); }
  /// Waits until every view chosen so far is embedded. Throws what the encoder threw.
  void await_encoder();
  /// The same after the last frame. Called again after it threw, it finishes without the views that
  /// the encoder failed on.
  void finish();
  /// What the super-points look like; waits likewise. Call once, after the last frame.
  SuperPointLooks take_looks();

  const MapperConfig& config() const { return config_; }
  /// Null when there is none.
  const std::shared_ptr<ImageTextEncoder>& encoder() const { return builder_->encoder(); }
  const VoxelMap& map() const { return map_; }
  VoxelMap& map() { return map_; }
  VoxelMap take_map() && { return std::move(map_); }
  const InstanceRegistry& registry() const { return registry_; }
  /// What moved so far while it was seen (MotionConfig::mode kTrack).
  const std::vector<Mover>& movers() const;
  /// Which space frames of this visit looked through.
  const SeenFree& seen_free() const;
  const KeptFrames& kept_frames() const { return frame_store_.frames(); }
  const StageTimers& timers() const { return timers_; }
  StageTimers& timers() { return timers_; }
  int frames() const { return frames_; }
  /// Slots of the map's blocks that the last `process`, `fuse` or `label` touched.
  const std::vector<std::uint32_t>& touched_blocks() const { return touched_blocks_; }
  int mask_frames() const { return mask_frames_; }
  /// The masks of this run: frames that had some, and those whose masks told nothing
  /// (FrameSegments::blank).
  struct MaskCount {
    int frames = 0, blank = 0;
  };
  const MaskCount& masks_seen() const { return masks_seen_; }

 private:
  void settle();
  /// Throws FrameError for a frame that contradicts nearly all of the map that it sees, unless
  /// those before it have done so for a while (MotionConfig::stays_s).
  void require_agreement(const PreparedFrame& prepared);
  MovingPixels find_motion(const PreparedFrame& prepared);
  std::vector<std::uint32_t> take_back(const PreparedFrame& prepared, const MovingPixels& moving);
  std::vector<std::uint32_t> clear_free_space(const Observation& observation);
  std::vector<SegmentAssociation> find_labels(const PreparedFrame& prepared,
                                              const FrameSegments* cut);
  Image<InstanceId> instances_of(const Image<Label>& labels) const;
  bool wants_masks(const Frame& frame) const;
  FrameReport observe(const Frame& frame, const FrameSegments* cut,
                      std::span<const SegmentAssociation> associations);

  MapperConfig config_;
  std::shared_ptr<MaskSource> masks_;
  VoxelMap map_;
  InstanceRegistry registry_;
  std::unique_ptr<AppearanceBuilder> builder_;
  StageTimers timers_;
  FrameStore frame_store_;
  std::vector<Pose> fused_from_;  ///< of all frames: the poses that the voxels have them from
  SeparateLooks looks_;
  struct Disagreement {
    double first_s = 0;  ///< time of the first frame on end that was left out
    int frames = 0;
  };
  std::optional<Disagreement> disagreement_;
  MaskMotion mask_motion_;
  std::unique_ptr<MotionFilter> motion_;
  bool settled_ = false;  ///< the objects are those of all that is in the map
  std::vector<std::uint32_t> touched_blocks_;
  std::vector<LiveStep> live_steps_;
  std::string writing_reader_;  ///< read the writing that restored views have; empty: nothing did
  int frames_ = 0, mask_frames_ = 0;
  MaskCount masks_seen_;
  std::int64_t first_number_ = 0;
};

}  // namespace ovimap
