// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "command.h"
#include "ovimap/io/settings/config_file.h"
#include "ovimap/pipeline/people/people_filter.h"

namespace ovimap::apps {

void add_mapping_options(CLI::App& command, MappingOptions& options) {
  command
      .add_option("SOURCE", options.source,
                  "recording: a folder of a known layout (see docs/sources.md)")
      ->required();
  add_mapping_settings(command, options);
}

void add_mapping_settings(CLI::App& command, MappingOptions& options) {
  command
      .add_option("--masks", options.masks, "2D masks: none, sam, gt, a folder of PNGs or a model")
      ->capture_default_str();
  command
      .add_option(
          "--encoder", options.encoder,
          "what makes objects searchable: none, default, a model, or auto (where there are 2D "
          "masks the best that is installed)")
      ->capture_default_str();
  command
      .add_option(
          "--recognizer", options.recognizer,
          "what tells things by name: none, models of kind detector separated by commas, or "
          "auto (where there is an encoder all that are installed)")
      ->capture_default_str();
  command
      .add_option("--preset", options.preset,
                  "default or reference (as the paper's code does it; docs/reference-preset.md)")
      ->capture_default_str();
  command.add_option(
      "--views", options.views,
      "which views of an object are embedded: default, paper, viewcov, combine, vis, "
      "random or all; not given: as the preset has them");
  command.add_option("--config", options.config_file, "YAML file of settings");
  one_value(command.add_option("--set", options.settings, "one setting, a.b=c; may be repeated"));
  command.add_option_function<std::string>(
      "--device",
      [&options](const std::string& device) {
        for (const char* networks : {"masks", "encoder"})
          options.settings.push_back(concat(networks, ".runtime.execution_provider=", device));
      },
      "what runs the networks: cpu, or cuda and others where ONNX Runtime was built with them");
  command
      .add_option_function<std::string>(
          "--dynamic",
          [&options](const std::string& mode) {
            options.settings.push_back("motion.mode=" + mode);
          },
          "things that move while they are seen: drop (leave them out), track (and follow them), "
          "or "
          "off (fuse them as everything else); without, as motion.mode says")
      ->check(CLI::IsMember({"off", "drop", "track"}));
  command
      .add_option_function<std::string>(
          "--people",
          [&options](const std::string& mode) {
            options.settings.push_back("people.mode=" + mode);
          },
          "people in the frames: keep, or drop (no surface, crop or picture shows them, seated "
          "ones "
          "neither, as far as a detector finds them; docs/changes.md); without, as people.mode "
          "says")
      ->check(CLI::IsMember({"keep", "drop"}));
  add_model_dirs(command, options.model_dirs);
  add_frame_range(command, options.frames);
  command.add_option("--threads", options.threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
}

void add_frame_range(CLI::App& command, std::string& frames) {
  one_value(
      command.add_option("--frames", frames, "which frames: FIRST:LAST:STEP, each part optional"));
}

void add_poses(CLI::App& command, MappingOptions& options) {
  options.poses = "auto";
  command
      .add_option("--poses", options.poses,
                  "given (by the recording), track (found from the images), refine (tracked, with "
                  "the given ones as a prediction), or auto: given where there are any")
      ->check(CLI::IsMember({"auto", "given", "track", "refine"}))
      ->capture_default_str();
}

void add_max_memory(CLI::App& command, MappingOptions& options) {
  command.add_option(
      "--max-memory", options.max_memory,
      "bound on the memory of the map's voxels, as 300M or 1.5G: those far away wait "
      "in the checkpoint beside the map");
}

void list_fields(ProgramConfig& config, ConfigFields& fields) {
  list_fields(config.mapper, fields);
  fields.group("source", [&](ConfigFields& f) { list_fields(config.source, f); });
  fields.group("track", [&](ConfigFields& f) { list_fields(config.track, f); });
  fields.group("loops", [&](ConfigFields& f) { list_fields(config.loops, f); });
  fields.group("visit", [&](ConfigFields& f) { list_fields(config.visit, f); });
  fields.group("people", [&](ConfigFields& f) { list_fields(config.people, f); });
  fields.group("masks", [&](ConfigFields& f) { list_fields(config.masks, f); });
  fields.group("encoder.runtime", [&](ConfigFields& f) { list_fields(config.encoder, f); });
  fields.group("live", [&](ConfigFields& f) { list_fields(config.live, f); });
  fields.group("checkpoint", [&](ConfigFields& f) { list_fields(config.checkpoint, f); });
  fields.group("memory", [&](ConfigFields& f) { list_fields(config.memory, f); });
}

void apply_settings(const std::vector<std::string>& settings, ConfigFields& fields) {
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
      throw Error("--set takes name=value, not '" + setting + "'; `ovimap config` lists the names");
    fields.set(setting.substr(0, equals), setting.substr(equals + 1));
  }
}

ProgramConfig read_program_config(const MappingOptions& options) {
  ProgramConfig config;
  config.mapper = mapper_preset(options.preset);
  if (!options.views.empty()) {
    config.mapper.semantics.views = view_preset(options.views);
    if (options.views != "default")  // as published
      config.mapper.semantics.telling.sharp_edge_px = 0.f;
  }
  ConfigFields fields;
  list_fields(config, fields);
  if (!options.config_file.empty()) load_config(options.config_file, fields);
  apply_settings(options.settings, fields);
  if (!options.max_memory.empty()) config.memory.max_mb = parse_megabytes(options.max_memory);
  return config;
}

CLI::Option* one_value(CLI::Option* option) {
  return option->type_size(1)->allow_extra_args(false);
}

void add_model_dirs(CLI::App& command, std::vector<std::filesystem::path>& model_dirs) {
  one_value(command.add_option("--model-dir", model_dirs, "folder to look for models in first"));
}

int network_threads(const ProgramConfig& config, const MappingOptions& options) {
  return config.masks.runtime.threads > 0 ? config.masks.runtime.threads : options.threads;
}

std::shared_ptr<ImageTextEncoder> make_encoder(const MappingOptions& options,
                                               const ProgramConfig& config) {
  const bool masks = options.masks != "none";
  const std::string spec = options.encoder != "auto" ? options.encoder
                           : masks                   ? preferred_encoder(options.model_dirs)
                                                     : "none";
  RuntimeConfig runtime = config.encoder;
  if (runtime.threads == 0) runtime.threads = options.threads;
  return make_image_text_encoder(spec, runtime, options.model_dirs, EncoderUse::kImages);
}

std::shared_ptr<const ThingRecognizer> make_recognizer(const MappingOptions& options,
                                                       const ProgramConfig& config, bool encoder) {
  RuntimeConfig runtime = config.encoder;
  if (runtime.threads == 0) runtime.threads = options.threads;
  const std::string spec = options.recognizer == "auto" && !encoder ? "none" : options.recognizer;
  return make_thing_recognizer(spec, runtime, options.model_dirs);
}

std::shared_ptr<const PeopleFilter> make_people_filter(const MappingOptions& options,
                                                       const ProgramConfig& config) {
  if (config.people.mode == PeopleMode::kKeep) return nullptr;
  RuntimeConfig runtime = config.masks.runtime;
  runtime.threads = network_threads(config, options);
  std::shared_ptr<const SamNetwork> outlines;
  if (config.people.mask_network)
    outlines = make_box_network(options.masks, runtime, options.model_dirs);
  return std::make_shared<PeopleFilter>(
      config.people, make_person_finder(config.people.detector, runtime, options.model_dirs),
      std::move(outlines));
}

int embedding_queries(const SemanticRecord& semantics) {
  int queries = 0;
  if (semantics.encoder.name.empty()) return 0;
  for (const auto& [label, look] : semantics.looks) queries += look.queries;
  return queries;
}

Action add_config(CLI::App& command) {
  auto markdown = std::make_shared<bool>(false);
  auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "print one JSON object");
  command.add_flag("--markdown", *markdown, "as the reference page");
  return [markdown, json] {
    ProgramConfig config;
    ConfigFields fields;
    list_fields(config, fields);
    if (*json) {
      nlohmann::json settings = nlohmann::json::array();
      for (const ConfigField& field : fields.fields())
        settings.push_back({{"name", field.name},
                            {"default", field.get()},
                            {"accepts", field.accepts},
                            {"help", field.help}});
      print_json({{"settings", settings}});
      return int{kDone};
    }
    if (!*markdown) {
      std::fputs(fields.dump().c_str(), stdout);
      return int{kDone};
    }
    std::puts("| setting | default | accepts | meaning |\n| --- | --- | --- | --- |");
    for (const ConfigField& field : fields.fields())
      std::printf("| `%s` | %s | %s | %s |\n", field.name.c_str(), field.get().c_str(),
                  field.accepts.c_str(), field.help.c_str());
    return int{kDone};
  };
}

}  // namespace ovimap::apps
