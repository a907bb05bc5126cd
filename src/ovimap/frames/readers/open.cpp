// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/frames/readers/readers.h"
#include "ovimap/frames/recording/gyroscope.h"

namespace ovimap {

namespace {

/// Most particular layout first.
const Reader* const kReaders[] = {
    &kReplicaReader, &kSevenScenesReader, &kIclNuimReader, &kTumReader,      &kScanNetReader,
    &kSensReader,    &kOniReader,         &kRedwoodReader, &kRecord3dReader, &kFolderReader};
/// Layouts of one file.
const Reader* const kFileReaders[] = {&kSensReader, &kOniReader};

const Reader* reader_of(const std::filesystem::path& folder) {
  for (const Reader* reader : kReaders)
    if (reader->recognises(folder)) return reader;
  return nullptr;
}

/// The reader of a file; null where it is none that is read.
const Reader* reader_of_file(const std::filesystem::path& file) {
  const auto found = std::find_if(std::begin(kFileReaders), std::end(kFileReaders),
                                  [&](const Reader* reader) { return reader->recognises(file); });
  return found == std::end(kFileReaders) ? nullptr : *found;
}

/// Of ROS 1, ROS 2 or MCAP.
bool is_bag(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".bag" || ending == ".mcap" || ending == ".db3";
}

/// The first folder in this one that holds a recording, by name; empty when there is none.
std::filesystem::path recording_in(const std::filesystem::path& folder) {
  std::filesystem::path first;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) try {
      const bool earlier = first.empty() || entry.path() < first;
      if (earlier && entry.is_directory() && reader_of(entry.path())) first = entry.path();
    } catch (const std::filesystem::filesystem_error&) {  // not for us to read
    }
  return first;
}

const Reader& find_reader(const std::filesystem::path& folder) {
  if (const Reader* reader = reader_of(folder)) return *reader;
  if (std::filesystem::is_empty(folder))
    throw Error(concat(folder.string(), " is empty; give the folder of a recording"));
  if (const std::filesystem::path inside = recording_in(folder); !inside.empty())
    throw Error(concat(folder.string(), " holds no frames itself, but '", inside.string(),
                       "' in it is a recording; give that"));
  std::string looked_for;
  for (const Reader* reader : kReaders)
    looked_for += concat(looked_for.empty() ? "" : "; ", reader->looks_for);
  throw Error(
      concat(folder.string(),
             " holds no known layout (docs/sources.md describes them); looked for: ", looked_for));
}

/// Cameras that the user gives go before those that a recording has for each frame.
void override_cameras(const std::filesystem::path& folder, Recording& recording) {
  const CameraRig assumed = recording.rig;
  for (const char* name : {"camera.yaml", "calibration.yaml"})
    if (std::filesystem::exists(folder / name)) apply_calibration(folder / name, recording.rig);
  const CameraRig& rig = recording.rig;
  if (assumed.color_camera == rig.color_camera && assumed.depth_camera == rig.depth_camera &&
      assumed.color_lens == rig.color_lens && assumed.depth_lens == rig.depth_lens)
    return;
  for (RecordedFrame& frame : recording.frames) frame.camera.reset();
}

/// What the gyroscope of a recording says of its frames, where it has one.
void find_orientations(const std::filesystem::path& folder, Recording& recording) {
  const std::filesystem::path file = folder / kGyroscopeFile;
  if (!std::filesystem::exists(file)) return;
  const OrientationTimeline timeline(read_gyroscope(file));
  for (RecordedFrame& frame : recording.frames)
    frame.orientation = timeline.at(frame.depth_time_s.value_or(frame.timestamp_s));
}

}  // namespace

std::unique_ptr<FrameSource> open_frame_source(const std::filesystem::path& path,
                                               const FrameSourceConfig& config) {
  std::error_code unreadable;
  const auto status = std::filesystem::status(path, unreadable);
  if (!std::filesystem::exists(status))
    throw Error(concat(path.string(), " does not exist; give a folder of frames"));
  const bool is_folder = std::filesystem::is_directory(status);
  if (path.extension() == ".r3d" && !is_folder)
    throw Error(concat(path.string(), " is a zip file; unzip it, and give the folder"));
  const Reader* file_reader = is_folder ? nullptr : reader_of_file(path);
  if (!is_folder && is_bag(path))
    throw Error(concat(path.string(), " is a bag; `ovimap-bag ", path.filename().string(),
                       " FOLDER` makes a recording of it"));
  if (!is_folder && !file_reader)
    throw Error(concat(path.string(),
                       " is a file; give the folder that holds the frames, or a .sens "
                       "or .oni file"));
  const std::filesystem::path folder = is_folder ? path : path.parent_path();
  if (!(config.min_depth_m < config.max_depth_m))
    throw Error(concat("min_depth_m is ", config.min_depth_m, " and max_depth_m ",
                       config.max_depth_m, "; the first must be smaller"));
  try {
    const Reader& reader = is_folder ? find_reader(path) : *file_reader;
    Recording recording = reader.list_frames(path, config);
    override_cameras(folder, recording);
    find_orientations(folder, recording);
    return open_recording(std::move(recording), config);
  } catch (const std::filesystem::filesystem_error& fault) {
    throw Error(concat(path.string(), " cannot be listed: ", fault.code().message()));
  }
}

}  // namespace ovimap
