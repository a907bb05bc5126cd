// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ovimap/inference/masks/entity_config.h"
#include "ovimap/inference/masks/mask_source.h"
#include "ovimap/inference/models/onnx_session.h"
#include "ovimap/inference/sam/sam_config.h"

namespace ovimap {

class FrameSource;
class SamNetwork;

/// Settings of every kind of mask source; each reads its own.
struct MaskSourceConfig {
  RuntimeConfig runtime;
  SamConfig sam;
  EntityConfig entity;
};
void list_fields(MaskSourceConfig& config, ConfigFields& fields);

/// The name of the model that `sam` stands for; tools/setup.sh puts it on the search path.
inline constexpr const char* kDefaultSamModel = "mobilesam";

/// What a mask source may need beside its settings.
struct MaskSourceContext {
  const FrameSource* frames = nullptr;  ///< for "gt" and for checking a folder's file names
  std::vector<std::filesystem::path> model_dirs;  ///< searched before the usual places
};

/// The network of that mask source that answers boxes with masks; null where it has none. Throws as
/// make_mask_source.
std::shared_ptr<const SamNetwork> make_box_network(
    const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs = {});

/// The mask source that `spec` names: "none" (nullptr), "sam" (the default promptable model), "gt"
/// (the frames' truth), a model folder, a folder of PNGs, or the name of a model on the search
/// path. The frames of `context` must outlive the source. Throws Error when there is no such thing
/// or it does not load.
std::unique_ptr<MaskSource> make_mask_source(const std::string& spec,
                                             const MaskSourceConfig& config,
                                             const MaskSourceContext& context = {});

}  // namespace ovimap
