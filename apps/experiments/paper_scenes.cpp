// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "paper_scenes.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/inference/mask_source_factory.h"
#include "ovimap/io/truth/truth.h"

namespace ovimap::apps {

namespace {

namespace fs = std::filesystem;

fs::path scene_folder(const fs::path& root, const std::string& scene) {
  for (const fs::path& folder : {root / scene, root / "scans" / scene})
    if (fs::is_directory(folder)) return folder;
  throw Error(concat("there is no folder ", (root / scene).string()));
}

std::string masks_of(const std::string& masks, const std::string& scene) {
  if (!masks_by_scene(masks)) return masks;
  const fs::path folder = fs::path(masks) / scene;
  for (const fs::path& place : {folder / "cropformer", folder})
    if (fs::is_directory(place)) return place.string();
  throw Error(concat("there is no folder of masks ", folder.string()));
}

void require_classes(const fs::path& source) {
  const Truth truth = load_truth(source);
  if (truth.classes.empty())
    throw Error(concat("the truth of ", source.string(), " has no classes; semantic_labels_",
                       source.filename().string(), ".txt is missing"));
}

/// Every n-th frame, as the released code counts them: n is the whole part of size / 200.
std::string evenly_spaced(std::int64_t size) {
  return concat("::", std::max<std::int64_t>(1, size / kPaperFrames));
}

PaperScene find_scene(const fs::path& root, const std::string& scene, const std::string& masks,
                      const FrameSourceConfig& config) {
  PaperScene found{scene, scene_folder(root, scene), {}, {}};
  const auto source = open_frame_source(found.source, config);
  require_classes(found.source);
  found.masks = masks_of(masks, scene);
  if (found.masks == "gt" || masks_by_scene(masks))
    make_mask_source(found.masks, {}, {source.get(), {}});
  found.frames = evenly_spaced(source->size());
  return found;
}

}  // namespace

PaperDataset paper_replica() {
  return {"Replica",
          "replica51",
          {"office0", "office1", "office2", "office3", "office4", "room0", "room1", "room2"},
          {"views.grid_rows=85", "views.grid_columns=150"}};
}

PaperDataset paper_scannet() {
  return {"ScanNet",
          "scannet200",
          {"scene0011_00", "scene0011_01", "scene0050_00", "scene0050_01", "scene0050_02",
           "scene0084_00", "scene0084_01", "scene0084_02", "scene0168_00", "scene0168_01",
           "scene0168_02", "scene0231_00", "scene0231_01", "scene0231_02", "scene0378_00",
           "scene0378_01", "scene0378_02", "scene0518_00"},
          {"views.grid_rows=60", "views.grid_columns=80"}};
}

bool masks_by_scene(const std::string& masks) {
  return fs::is_directory(masks) && !fs::exists(fs::path(masks) / "model.yaml");
}

FoundScenes find_paper_scenes(const PaperDataset& dataset, const fs::path& root,
                              const std::string& masks, const FrameSourceConfig& config) {
  if (!fs::is_directory(root))
    throw Error(concat("there is no folder '", root.string(), "' to take ", dataset.name,
                       " from; give the one that holds ", dataset.scenes.front(),
                       " and the other scenes"));
  FoundScenes found;
  for (const std::string& scene : dataset.scenes) {
    try {
      found.scenes.push_back(find_scene(root, scene, masks, config));
    } catch (const Error& fault) {
      found.missing.push_back(concat(scene, ": ", fault.what()));
    }
  }
  return found;
}

}  // namespace ovimap::apps
