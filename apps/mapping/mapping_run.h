// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/command/command.h"
#include "ovimap/pipeline/alignment/map_alignment.h"
#include "ovimap/pipeline/live/camera_feed.h"
#include "ovimap/pipeline/live/live_run.h"
#include "ovimap/pipeline/sequence/last_loops.h"
#include "ovimap/track/sensor_doubts.h"

namespace ovimap::apps {

/// How the camera was tracked.
struct TrackingRun {
  TrackSummary summary;
  LoopCorrections corrections;                                 ///< while frames came
  LoopReport loops;                                            ///< after the last one
  std::vector<std::pair<std::int64_t, std::int64_t>> unknown;  ///< unknown_places
  std::vector<std::string> sensor_doubts;  ///< none: camera and times are as described
  std::optional<AlignmentSearch> placing;  ///< what objects said of where in a map the camera is
};

/// Frames of a run that were mapped by themselves, since nothing says where they lie.
struct MapPart {
  std::filesystem::path map;
  std::int64_t first = 0, last = 0;  ///< of the recording's frames
  std::size_t frames = 0;            ///< in the map
  std::size_t objects = 0;
  std::optional<AlignmentSearch> placing;  ///< of the part in the map; nullopt: not looked for
};

/// A recording, mapped.
struct MappingRun {
  std::unique_ptr<FrameSource> source;  ///< null where frames were pushed
  bool masks_wanted = false;            ///< there was a source of 2D masks
  Mapper::MaskCount masks_seen;         ///< by this run
  std::size_t frames_before = 0;        ///< in the map or checkpoint that it went on with
  SequenceResult sequence;
  std::optional<LiveRunResult> live;         ///< of map_live
  std::optional<std::size_t> people_frames;  ///< that showed people, who were left out
  std::optional<TrackingRun> tracking;       ///< where poses were not given
  std::optional<Pose> map_from_recording;    ///< by which its poses were moved
  std::vector<MapPart> parts;                ///< mapped by themselves
  StageTimers timers;
  MapDocument document;
  std::unique_ptr<Checkpointer> checkpoints;  ///< remove them when the map is saved
};

/// Where a run leaves its map: with it, the run makes checkpoints.
struct RunTarget {
  std::filesystem::path map;
  bool resume = false;  ///< go on with the checkpoint or map that is there
  std::filesystem::path continued =
      {};              ///< another visit to the place of this map; empty: a new map
  bool align = false;  ///< the recording may lie elsewhere than the map, and is moved there
  std::filesystem::path repeated = {};  ///< the map of a live run, to be made again; map_live alone
};

/// Whether a map lies there that the run makes anew.
bool replaces_a_map(const RunTarget& target);

/// Opens what the options name and maps it, with progress under `title`; Ctrl-C ends it early with
/// what was mapped so far. `keep_masks`: folder in which masks are kept and looked for; empty:
/// nowhere. Throws what the parts throw, and Error when an unfinished run left a checkpoint that
/// `target` does not resume, or one of other settings that it does, or when the recording does not
/// lie where the map is that it goes on with (misfit).
MappingRun map_recording(const MappingOptions& options, const std::string& title,
                         const std::filesystem::path& keep_masks = {},
                         const RunTarget& target = {});

/// Whoever follows a live run and may correct its map meanwhile.
class LiveAudience {
 public:
  virtual ~LiveAudience() = default;
  /// The mapping is about to begin, with what an earlier run knew of the map's names and
  /// corrections.
  virtual void begin(const MapperConfig& config, const EncoderIdentity& encoder,
                     const std::map<InstanceId, std::string>& names, const MapEdits& edits) = 0;
  /// As LiveMapper::after_frame.
  virtual void after_frame(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                           const PinholeCamera& depth_camera) = 0;
  /// As LiveMapper::while_waiting.
  virtual void while_waiting(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                             const PinholeCamera& depth_camera) = 0;
  /// As LiveMapper::after_tracking.
  virtual void after_tracking(const TrackedFrame& frame) = 0;
  /// Corrections by now.
  virtual MapEdits edits() const = 0;
  /// The mapping has ended; returns the corrections that the map is saved with.
  virtual MapEdits end() = 0;
};

/// The same as a camera of `fps` frames a second would have it, or as the run of `target.repeated`
/// did it. Networks let the mapping go first. `intake`: frames come from there instead, at their
/// own pace, until it ends. `camera`: feeds it, and is started when the mapping is.
MappingRun map_live(const MappingOptions& options, double fps, const RunTarget& target = {},
                    LiveAudience* audience = nullptr, FrameIntake* intake = nullptr,
                    CameraFeed* camera = nullptr);

}  // namespace ovimap::apps
