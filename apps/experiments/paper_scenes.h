// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"

namespace ovimap::apps {

/// A data set as the paper uses it.
struct PaperDataset {
  std::string name;     ///< as published rows are marked
  std::string classes;  ///< the set its classes are projected onto
  std::vector<std::string> scenes;
  std::vector<std::string> settings;  ///< of the released code that depend on the images' size
};
PaperDataset paper_replica();
PaperDataset paper_scannet();

/// A scene that can be mapped and scored.
struct PaperScene {
  std::string name;
  std::filesystem::path source;
  std::string masks;   ///< as --masks takes it, for this scene
  std::string frames;  ///< about kPaperFrames of them, evenly spaced, as --frames takes it
};
inline constexpr int kPaperFrames = 200;

struct FoundScenes {
  std::vector<PaperScene> scenes;
  std::vector<std::string> missing;  ///< one line for each scene that cannot be used: why
};

/// Looks for every scene in ROOT/SCENE and ROOT/scans/SCENE: its frames, its truth with classes
/// and, where `masks` is a folder of folders or "gt", its masks (FOLDER/SCENE or
/// FOLDER/SCENE/cropformer). Throws Error when ROOT is no folder.
FoundScenes find_paper_scenes(const PaperDataset& dataset, const std::filesystem::path& root,
                              const std::string& masks, const FrameSourceConfig& config);

/// True where `masks` names a folder that holds a folder of PNGs for each scene.
bool masks_by_scene(const std::string& masks);

}  // namespace ovimap::apps
