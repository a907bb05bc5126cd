// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/mask_source_factory.h"

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/inference/masks/entity_mask_source.h"
#include "ovimap/inference/masks/id_mask_sources.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/inference/sam/sam_mask_source.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

std::unique_ptr<MaskSource> open_model(const fs::path& folder, const MaskSourceConfig& config) {
  const ModelFolder model = read_model_folder(folder);
  if (model.kind == "sam")
    return std::make_unique<SamMaskSource>(model, config.sam, config.runtime);
  if (model.kind == "entity")
    return std::make_unique<EntityMaskSource>(model, config.entity, config.runtime);
  throw Error(concat("model ", folder.string(), " is of kind '", model.kind,
                     "'; as a source of masks sam and entity are accepted"));
}

}  // namespace

void list_fields(MaskSourceConfig& config, ConfigFields& fields) {
  fields.group("runtime", [&](ConfigFields& group) { list_fields(config.runtime, group); });
  fields.group("sam", [&](ConfigFields& group) { list_fields(config.sam, group); });
  fields.group("entity", [&](ConfigFields& group) { list_fields(config.entity, group); });
}

std::shared_ptr<const SamNetwork> make_box_network(const std::string& spec,
                                                   const RuntimeConfig& runtime,
                                                   const std::vector<fs::path>& model_dirs) {
  if (spec.empty() || spec == "none" || spec == "gt") return nullptr;
  if (fs::is_directory(spec) && !fs::is_regular_file(fs::path(spec) / "model.yaml")) return nullptr;
  const ModelFolder model = read_model_folder(
      named_model(spec == "sam" ? kDefaultSamModel : spec, model_search_path(model_dirs)));
  return model.kind == "sam" ? std::make_shared<const SamNetwork>(model, runtime) : nullptr;
}

std::unique_ptr<MaskSource> make_mask_source(const std::string& spec,
                                             const MaskSourceConfig& config,
                                             const MaskSourceContext& context) {
  if (spec.empty() || spec == "none") return nullptr;
  if (spec == "gt") {
    if (!context.frames) throw Error("masks 'gt' need a recorded source of frames; name one");
    return std::make_unique<GtMaskSource>(*context.frames);
  }
  const std::vector<fs::path> search_path = model_search_path(context.model_dirs);
  if (spec == "sam") return open_model(find_model(kDefaultSamModel, search_path), config);
  const fs::path path(spec);
  if (fs::is_regular_file(path / "model.yaml")) return open_model(path, config);
  if (fs::is_directory(path)) return std::make_unique<DirMaskSource>(path, context.frames);
  return open_model(find_model(spec, search_path, {"none", "gt", "sam"}), config);
}

}  // namespace ovimap
