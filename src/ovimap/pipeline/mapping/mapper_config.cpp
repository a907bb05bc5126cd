// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/mapper_config.h"

#include <sstream>

namespace ovimap {

namespace {

constexpr int kNeverSoMany = 100000000;  // pixels; no image has them

}  // namespace

void list_fields(MapperConfig& config, ConfigFields& fields) {
  fields.group("segment", [&](ConfigFields& f) { list_fields(config.segment, f); });
  fields.group("depth", [&](ConfigFields& f) { list_fields(config.depth, f); });
  fields.group("mask_fusion", [&](ConfigFields& f) { list_fields(config.mask_fusion, f); });
  fields.group("association", [&](ConfigFields& f) { list_fields(config.association, f); });
  fields.group("instance", [&](ConfigFields& f) { list_fields(config.instance, f); });
  fields.group("summary", [&](ConfigFields& f) { list_fields(config.summary, f); });
  fields.group("map", [&](ConfigFields& f) { list_fields(config.map, f); });
  fields.group("free_space", [&](ConfigFields& f) { list_fields(config.free_space, f); });
  fields.group("motion", [&](ConfigFields& f) { list_fields(config.motion, f); });
  list_fields(config.semantics, fields);
  fields.group("frame_store", [&](ConfigFields& f) { list_fields(config.frame_store, f); });
  fields.add("view_interval", config.view_interval, 0, 1000000,
             "objects are looked at in every n-th frame; 0: every frame with an encoder, by "
             "stored_view_interval without");
  fields.add("stored_view_interval", config.stored_view_interval, 1, 1000000,
             "what view_interval 0 means when crops are only kept, frames");
  fields.add("mask_interval", config.mask_interval, 0, 1000000,
             "2D masks every n-th frame; 0: by mask_motion for networks, every frame otherwise");
  fields.add("mask_motion", config.mask_motion, 0.f, 1.f,
             "networks are asked again when what is in view moved by this share of the picture; "
             "0: every frame");
  fields.add("occlusion_margin_m", config.occlusion_margin_m, 0.f, 10.f,
             "how much nearer a surface hides a point from the colour camera, metres");
  fields.add("allow_still_camera", config.allow_still_camera,
             "a recording in which every pose is the same is no mistake");
  fields.add("max_range_m", config.max_range_m, 0.1f, 1000.f,
             "how far the map is projected back, metres");
}

// docs/reference-preset.md holds this against the released code, line by line.
MapperConfig mapper_preset(const std::string& name) {
  MapperConfig config;
  if (name == "default") return config;
  if (name != "reference")
    throw Error(concat("there is no preset '", name, "'; accepted is default or reference"));
  config.segment = reference_segment_depth_config();
  config.association.association = AssociationRule::kOneToOne;
  config.association.assoc_min_share = 0.f;
  config.instance.instances = InstanceReading::kEntityVotes;
  config.instance.merging.merge_max_dissent = 1e6f;  // the paper counts no dissent
  config.depth.enabled = false;
  config.free_space.enabled = false;
  config.motion.mode = DynamicMode::kOff;
  config.map.max_weight = 1e4f;
  config.map.min_mesh_weight = 1e-4f;
  config.map.label_band_voxels = static_cast<float>(config.map.truncation_voxels);
  config.map.pixel_votes = false;
  config.mask_fusion.min_entity_px = kNeverSoMany;
  config.mask_fusion.split_core_px = kNeverSoMany;
  config.summary.min_instance_voxels = 1;
  config.summary.min_instance_views = 1;
  config.summary.min_confidence = 0.f;
  config.mask_motion = 0.f;
  config.view_interval = 1;
  config.semantics.views = view_preset("combine");
  config.semantics.views.fusion.largest_views = 8;
  config.semantics.telling.sharp_edge_px = 0.f;
  config.semantics.crops.background_level = 0;
  return config;
}

MapperConfig config_of_map(const std::string& config_text) {
  MapperConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  std::istringstream stream(config_text);
  for (std::string line; std::getline(stream, line);)
    for (const ConfigField& field : fields.fields())
      if (line.starts_with(field.name + ": ")) field.set(line.substr(field.name.size() + 2));
  return config;
}

}  // namespace ovimap
