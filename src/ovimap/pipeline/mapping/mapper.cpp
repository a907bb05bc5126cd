// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/mapper.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "ovimap/base/error.h"
#include "ovimap/base/version.h"
#include "ovimap/map/fusion/integrate.h"
#include "ovimap/map/fusion/seen_ahead.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/pipeline/motion/motion_filter.h"

namespace ovimap {

namespace {

Observation observation_of(const PreparedFrame& prepared, const FrameSegments* cut,
                           std::span<const Label> labels, const DepthImage& depth) {
  const Image<float>& sigma = prepared.estimate.sigma_m;
  return {.depth = depth,
          .camera = prepared.frame->depth_camera,
          .world_from_camera = prepared.frame->world_from_camera,
          .color = &prepared.color,
          .plane_slope = &prepared.surface.plane_slope,
          .sigma_m = sigma.empty() ? nullptr : &sigma,
          .segment_ids = cut ? &cut->segments.ids : nullptr,
          .segment_labels = labels};
}

Observation observation_of(const PreparedFrame& prepared, const FrameSegments* cut,
                           std::span<const Label> labels) {
  return observation_of(prepared, cut, labels, prepared.estimate.depth_m);
}

/// All that the sensor saw, what was taken out of the frame included: holes would hide what is
/// empty, and whose the rest of somebody is.
Observation whole_of(const PreparedFrame& prepared) {
  const std::optional<DepthReading>& whole = prepared.whole;
  const DepthEstimate& estimate = whole ? whole->estimate : prepared.estimate;
  const DepthSurface& surface = whole ? whole->surface : prepared.surface;
  return {.depth = estimate.depth_m,
          .camera = prepared.frame->depth_camera,
          .world_from_camera = prepared.frame->world_from_camera,
          .plane_slope = &surface.plane_slope,
          .sigma_m = estimate.sigma_m.empty() ? nullptr : &estimate.sigma_m,
          .free_m = prepared.free_m.empty() ? nullptr : &prepared.free_m};
}

/// Nothing where nothing moves, or there are no segments.
std::optional<FrameSegments> without(const IdImage& moving, const FrameSegments* cut) {
  if (cut == nullptr || moving.empty()) return std::nullopt;
  FrameSegments still = *cut;
  still.segments = still_segments(cut->segments, moving);
  return still;
}

/// The image itself where nothing moves, else a copy in `still`.
const DepthImage& without(const IdImage& moving, const DepthImage& depth, DepthImage& still) {
  return moving.empty() ? depth : still = still_depth(depth, moving);
}

std::vector<Label> labels_of(std::span<const SegmentAssociation> associations) {
  std::vector<Label> labels;
  for (const SegmentAssociation& segment : associations) labels.push_back(segment.label);
  return labels;
}

/// Adds to slots in block-index order others in that order.
void add_slots(const std::vector<std::uint32_t>& added, const VoxelMap& map,
               std::vector<std::uint32_t>& slots) {
  if (added.empty()) return;
  std::vector<std::uint32_t> all;
  std::set_union(slots.begin(), slots.end(), added.begin(), added.end(), std::back_inserter(all),
                 [&map](std::uint32_t a, std::uint32_t b) {
                   return pack_index(map.block_index(a)) < pack_index(map.block_index(b));
                 });
  slots = std::move(all);
}

}  // namespace

Mapper::Mapper(const MapperConfig& config, std::shared_ptr<MaskSource> masks,
               std::shared_ptr<ImageTextEncoder> encoder)
    : config_(config),
      masks_(std::move(masks)),
      map_(config.map),
      registry_(config.instance),
      frame_store_(config.frame_store),
      mask_motion_(config.mask_motion),
      motion_(std::make_unique<MotionFilter>(config.motion)) {
  if (config_.view_interval == 0)
    config_.view_interval = encoder ? 1 : config_.stored_view_interval;
  builder_ = std::make_unique<AppearanceBuilder>(config_.semantics, std::move(encoder));
  if (config_.mask_interval == 0 && !(masks_ && masks_->is_slow())) config_.mask_interval = 1;
}

Mapper::~Mapper() = default;
Mapper::Mapper(Mapper&&) noexcept = default;
Mapper& Mapper::operator=(Mapper&&) noexcept = default;

FrameReport Mapper::process(const Frame& frame) {
  const std::shared_ptr<const Frame> borrowed(std::shared_ptr<const Frame>(), &frame);
  return process(prepare_frame(borrowed, config_, timers_));
}

FrameReport Mapper::process(const PreparedFrame& prepared) {
  live_steps_.clear();  // they no longer tell how all of the map was made
  const Frame& frame = *prepared.frame;
  std::optional<FrameSegments> cut;
  if (wants_masks(frame)) cut = cut_segments(prepared, masks_.get(), config_, timers_);
  FrameReport report = fuse(prepared, cut ? &*cut : nullptr);
  if (frames_ % config_.view_interval == 0) report.views = look_at_objects(frame);
  return report;
}

bool Mapper::wants_masks(const Frame& frame) const {
  return config_.mask_interval > 0 ? frames_ % config_.mask_interval == 0
                                   : mask_motion_.wants(frame);
}

FrameReport Mapper::fuse(const PreparedFrame& prepared, const FrameSegments* cut) {
  builder_->rethrow_failure();  // before anything changes
  require_agreement(prepared);
  settled_ = false;
  const MovingPixels moving = find_motion(prepared);
  const std::optional<FrameSegments> still = without(moving.ids, cut);
  if (still) cut = &*still;
  DepthImage copy;
  const DepthImage& depth = without(moving.ids, prepared.estimate.depth_m, copy);
  {
    auto t = timers_.measure("allocate");  // first: a frame without room changes nothing
    touched_blocks_ = allocate_blocks(map_, observation_of(prepared, nullptr, {}, depth));
  }
  const std::vector<SegmentAssociation> associations = find_labels(prepared, cut);
  const std::vector<Label> labels = labels_of(associations);
  // Before what moves, space is as free as before anything else.
  const std::vector<std::uint32_t> cleared = clear_free_space(whole_of(prepared));
  const std::vector<std::uint32_t> taken_back = take_back(prepared, moving);
  {
    auto t = timers_.measure("integrate");
    integrate_in(map_, observation_of(prepared, cut, labels, depth), touched_blocks_);
  }
  add_slots(cleared, map_, touched_blocks_);
  add_slots(taken_back, map_, touched_blocks_);
  if (config_.frame_store.max_mb > 0) {
    auto t = timers_.measure("keep_frame");
    DepthImage seen;
    frame_store_.add(number_of(*prepared.frame), prepared.frame->depth_camera,
                     without(moving.ids, prepared.frame->depth, seen), prepared.color,
                     cut ? &cut->segments.ids : nullptr, labels);
  }
  ++frames_;
  fused_from_.push_back(prepared.frame->world_from_camera);
  mask_motion_.add(prepared.frame->world_from_camera);
  if (cut) mask_motion_.masked();
  FrameReport report = observe(*prepared.frame, cut, associations);
  report.moving_px = static_cast<int>(moving.ids.size()) -
                     static_cast<int>(std::count(moving.ids.begin(), moving.ids.end(), 0));
  return report;
}

void Mapper::require_agreement(const PreparedFrame& prepared) {
  if (!config_.free_space.enabled) return;
  auto t = timers_.measure("agreement");
  const Frame& frame = *prepared.frame;
  if (!sees_through_map(map_, whole_of(prepared))) {
    disagreement_.reset();
    return;
  }
  if (!disagreement_) disagreement_ = {frame.timestamp_s, 0};
  // What stays so is so: it was the map that was wrong, a hand on the lens or a wardrobe.
  // Where clocks stand still a frame is a tick.
  const float patience_s = config_.motion.stays_s;
  if (frame.timestamp_s - disagreement_->first_s >= static_cast<double>(patience_s) ||
      ++disagreement_->frames > ticks_of(patience_s))
    return;
  throw FrameError(concat(frame.name,
                          ": sees through most of the surface that the map has there; its depth is "
                          "wrong, or its pose"));
}

MovingPixels Mapper::find_motion(const PreparedFrame& prepared) {
  if (config_.motion.mode == DynamicMode::kOff) return {};
  auto t = timers_.measure("motion");
  const Frame& frame = *prepared.frame;
  return motion_->see(map_, whole_of(prepared), frame.taken_out, config_.free_space,
                      frame.timestamp_s, number_of(frame));
}

std::vector<std::uint32_t> Mapper::take_back(const PreparedFrame& prepared,
                                             const MovingPixels& moving) {
  if (config_.motion.mode == DynamicMode::kOff || !config_.free_space.enabled) return {};
  auto t = timers_.measure("take_back");
  return motion_->take_back(map_, whole_of(prepared), moving, config_.free_space);
}

std::vector<std::uint32_t> Mapper::clear_free_space(const Observation& observation) {
  if (!config_.free_space.enabled ||
      !looks_.next(observation.world_from_camera, config_.free_space))
    return {};
  auto t = timers_.measure("free_space");
  return ovimap::clear_free_space(map_, observation, config_.free_space).slots;
}

FrameReport Mapper::label(const PreparedFrame& prepared, const FrameSegments& all) {
  settled_ = false;
  const IdImage* const moving = motion_->moved_in(number_of(*prepared.frame));
  const std::optional<FrameSegments> still = without(moving ? *moving : IdImage(), &all);
  const FrameSegments& cut = still ? *still : all;
  const std::vector<SegmentAssociation> associations = find_labels(prepared, &cut);
  const std::vector<Label> labels = labels_of(associations);
  {
    auto t = timers_.measure("vote");
    touched_blocks_ = vote_labels(map_, observation_of(prepared, &cut, labels));
  }
  frame_store_.add_labels(number_of(*prepared.frame), cut.segments.ids, labels);
  return observe(*prepared.frame, &cut, associations);
}

FusedAgain Mapper::fuse_again(const std::vector<Pose>& poses, const PinholeCamera& depth_camera,
                              const std::function<void(std::size_t, std::size_t)>& progress) {
  OVIMAP_ASSERT(poses.size() == static_cast<std::size_t>(frames_));
  auto t = timers_.measure("fuse_again");
  settled_ = false;
  motion_->forget_space();
  const FrameStoreConfig& store = config_.frame_store;
  PoseChange change = change_of(std::move(fused_from_), poses,
                                double{store.still_voxels} * double{config_.map.voxel_size_m},
                                double{store.still_at_m});
  FusedAgain done =
      fuse_moved(map_, frame_store_.frames(), change, config_, depth_camera, progress);
  fused_from_ = std::move(change.after);
  looks_ = done.looks;
  mask_motion_.move(poses);
  touched_blocks_ = done.slots;
  return done;
}

std::vector<SegmentAssociation> Mapper::find_labels(const PreparedFrame& prepared,
                                                    const FrameSegments* cut) {
  if (!cut) return {};
  auto t = timers_.measure("associate");
  const Frame& frame = *prepared.frame;
  const Image<VoxelRef> voxels =
      surface_voxels(map_, frame.depth, frame.depth_camera, frame.world_from_camera);
  return associate(cut->segments, voxels, map_, config_.association);
}

FrameReport Mapper::observe(const Frame& frame, const FrameSegments* cut,
                            std::span<const SegmentAssociation> associations) {
  if (!cut) return {};
  auto t = timers_.measure("registry");
  registry_.observe(cut->segments, associations, number_of(frame), cut->masked, map_.labels());
  mask_frames_ += cut->masked;
  masks_seen_.frames += cut->masked;
  masks_seen_.blank += cut->blank;
  FrameReport report;
  report.regions = cut->regions;
  report.entities = cut->entities;
  report.labelled = true;
  report.segments = static_cast<int>(cut->segments.segments.size());
  report.founded = static_cast<int>(std::count_if(associations.begin(), associations.end(),
                                                  [](const auto& a) { return a.founded; }));
  return report;
}

int Mapper::look_at_objects(const Frame& frame, Encoder encoder) {
  const InstanceView view = project(frame);
  int chosen = 0;
  {
    auto t = timers_.measure("views");
    const Registration registration(frame, view.depth, config_.occlusion_margin_m);
    chosen = builder_->choose(frame,
                              {.depth = view.depth,
                               .instances = view.instances,
                               .labels = view.labels,
                               .sensor_depth = frame.depth,
                               .color_index = registration.color_index(),
                               .camera = frame.depth_camera,
                               .world_from_camera = frame.world_from_camera,
                               .frame = number_of(frame)},
                              registry_, map_.labels());
  }
  auto t = timers_.measure("await_encoder");
  builder_->submit(encoder == Encoder::kCatchUp);
  return chosen;
}

const std::vector<Mover>& Mapper::movers() const {
  return motion_->movers();
}

const SeenFree& Mapper::seen_free() const {
  return motion_->space();
}

MapRecord Mapper::record(MapHeader header, std::vector<FrameLogEntry> frames,
                         const PinholeCamera& depth_camera) const {
  MapRecord record;
  static_cast<MapHeader&>(record) = std::move(header);
  record.instance_config = config_.instance;
  record.registry = registry_.state();
  record.semantics.views = config_.semantics.views;
  record.semantics.crops = config_.semantics.crops;
  if (encoder()) record.semantics.encoder = encoder()->identity();
  record.semantics.recognizer = builder_->recognizer();
  record.semantics.writing_reader = writing_reader_;
  record.frames = std::move(frames);
  record.kept_frames = kept_frames();
  record.depth_camera = depth_camera;
  record.mask_frames = mask_frames_;
  record.seen_free = motion_->space();
  record.movers = motion_->movers();
  record.live_steps = live_steps_;
  record.version = concat(version(), " (", commit(), ")");
  return record;
}

void Mapper::restore(MapDocument&& document) {
  OVIMAP_ASSERT(frames_ == 0);
  map_ = std::move(document.map);
  registry_.restore(std::move(document.registry));
  if (document.semantics.recognizer != builder_->recognizer())  // other numbers mean other things
    for (auto& [label, look] : document.semantics.looks)
      for (ObjectView& view : look.views) view.things.resize(0);
  writing_reader_ = std::move(document.semantics.writing_reader);
  builder_->restore(std::move(document.semantics.looks));
  frame_store_.restore(std::move(document.kept_frames), document.frames.size(),
                       document.depth_camera);
  for (const FrameLogEntry& frame : document.frames) {
    fused_from_.push_back(frame.world_from_camera);
    looks_.next(frame.world_from_camera, config_.free_space);
    mask_motion_.add(frame.world_from_camera);
    if (frame.labelled) mask_motion_.masked();
  }
  motion_->restore(std::move(document.seen_free), std::move(document.movers), document.frames);
  live_steps_ = std::move(document.live_steps);
  frames_ = static_cast<int>(document.frames.size());
  mask_frames_ = document.mask_frames;
}

void Mapper::await_encoder() {
  auto t = timers_.measure("await_encoder");
  builder_->catch_up(map_.labels());
}

void Mapper::settle() {
  if (settled_) return;
  auto t = timers_.measure("objects");
  if (config_.instance.instances == InstanceReading::kConsensus && config_.instance.judged)
    registry_.settle(measure_super_points(map_), mask_frames_ > 0);
  else
    registry_.settle();
  settled_ = true;
}

void Mapper::finish() {
  settle();
  {
    auto t = timers_.measure("await_encoder");
    builder_->finish(map_.labels());
  }
  for (const double milliseconds : builder_->take_durations_ms())
    timers_.add("embed", milliseconds);
}

SuperPointLooks Mapper::take_looks() {
  finish();
  return builder_->take();
}

InstanceView Mapper::project(const Frame& frame) {
  auto t = timers_.measure("project");
  const Image<VoxelRef> voxels =
      surface_voxels(map_, frame.depth, frame.depth_camera, frame.world_from_camera);
  Projection seen = cast_rays_with_depth(map_, frame.depth, voxels, frame.depth_camera,
                                         frame.world_from_camera, config_.max_range_m);
  Image<InstanceId> instances = instances_of(seen.labels);
  return {std::move(seen.depth), std::move(instances), std::move(seen.labels)};
}

/// Asks the registry once per label in sight: a frame shows a few of the map's labels.
Image<InstanceId> Mapper::instances_of(const Image<Label>& labels) const {
  constexpr InstanceId kUnasked = ~InstanceId{0};
  const LabelForest& forest = map_.labels();
  std::vector<InstanceId> known(forest.roots().size(), kUnasked);
  Image<InstanceId> instances(labels.width(), labels.height());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    InstanceId& id = known[labels[i]];
    if (id == kUnasked) id = registry_.instance_of(forest.root(labels[i]));
    instances[i] = id;
  }
  return instances;
}

}  // namespace ovimap
