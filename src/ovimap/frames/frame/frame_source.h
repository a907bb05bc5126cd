// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame.h"

namespace ovimap {

class ConfigFields;

/// What a recording's poses are to a caller.
enum class PoseNeed {
  kAll,        ///< a frame without a pose is a faulty one
  kAllOrNone,  ///< likewise, unless no frame of the recording has one
  kNone,       ///< poses are not read
};

struct FrameSourceConfig {
  float min_depth_m = 0.1f;      ///< nearer depth is invalid
  float max_depth_m = 10.f;      ///< farther depth is invalid
  float max_time_gap_s = 0.02f;  ///< colour, depth and pose farther apart do not belong together
  int min_confidence = 1;        ///< depth of less is invalid (Record3D: 0 low, 1 medium, 2 high)
  PoseNeed poses = PoseNeed::kAll;  ///< the caller's, not a setting of the user's
};
void list_fields(FrameSourceConfig& config, ConfigFields& fields);

/// A frame, or why there is none. Exactly one of the two is set.
struct FrameRead {
  std::optional<Frame> frame;
  std::string fault;  ///< "FILE: PHRASE", as "frame-000005.depth.png: is 320x240, expected 640x480"
};

/// Frames that cannot be used for one and the same reason.
struct FaultCount {
  std::string phrase;   ///< without the file name
  std::string example;  ///< FrameRead::fault of the first
  std::int64_t frames = 0;
};

/// Groups faults ("FILE: PHRASE") by their phrase, the most frequent first.
std::vector<FaultCount> count_faults(const std::vector<std::string>& faults);

/// A recorded sequence of frames. Reading is thread-safe and never throws for a bad frame.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The layout: "replica", "7scenes", "icl-nuim", "tum", "scannet", "sens", "oni",
  /// "redwood", "record3d", "folder".
  virtual std::string kind() const = 0;
  virtual std::int64_t size() const = 0;
  /// Whether its frames come with poses.
  virtual bool posed() const { return true; }
  /// Whether a lens of the colour camera is known, and its images come rectified from it.
  virtual bool rectified() const { return false; }

  /// The frame at `position` in [0, size()); its Frame::index is `position`.
  [[nodiscard]] virtual FrameRead read(std::int64_t position) const = 0;

  /// True instance ids at `position` in the colour camera (nullopt: this source has none). Throws
  /// Error when the file of the ids is broken or of another size than the colour images.
  [[nodiscard]] virtual std::optional<IdImage> truth_ids(std::int64_t position) const {
    (void)position;
    return std::nullopt;
  }
};

/// Opens what `path` contains: the layout is recognised by its files; `camera.yaml` and then
/// `calibration.yaml` beside them override the cameras (camera_rig.h has the format). Throws Error
/// when the path is missing, no layout fits (the message lists what was looked for), the layout's
/// own description is broken, or no frame has colour, depth and, where
/// `config` needs it, a pose.
std::unique_ptr<FrameSource> open_frame_source(const std::filesystem::path& path,
                                               const FrameSourceConfig& config = {});

/// Positions first, first+step, ... below last.
struct FrameRange {
  std::int64_t first = 0;
  std::int64_t last = -1;  ///< -1: to the end
  std::int64_t step = 1;
};

/// Reads "A:B:STEP" with each part optional. Throws Error when it is not that.
FrameRange parse_frame_range(const std::string& text);
std::vector<std::int64_t> positions(const FrameRange& range, std::int64_t size);

/// The frames of a range, as if the recording had no others; each keeps the Frame::index that it
/// has there. Throws Error when the range holds none.
std::unique_ptr<FrameSource> choose_frames(std::unique_ptr<FrameSource> source,
                                           const FrameRange& range);

}  // namespace ovimap
