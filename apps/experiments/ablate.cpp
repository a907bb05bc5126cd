// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <set>

#include "ablation.h"
#include "ablation_schedule.h"
#include "apps/command/file_slug.h"
#include "apps/command/kept_settings.h"
#include "apps/mapping/mapping_run.h"
#include "ovimap/base/listed.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/version.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/truth/truth.h"
#include "ovimap/pipeline/report/map_pictures.h"
#include "ovimap/pipeline/sequence/geometry_embedding.h"

namespace ovimap::apps {

namespace {

namespace fs = std::filesystem;

struct AblateOptions {
  std::string name;
  std::vector<std::string> scenes;
  fs::path out;
  MappingOptions mapping;
  AblationChoice choice;
  std::string classes = "auto";
  bool json = false;
};

std::string scene_name(const std::string& scene) {
  const fs::path path = fs::absolute(scene).lexically_normal();
  return file_slug((path.has_filename() ? path : path.parent_path()).filename().string());
}

double rate_of(const MappingOptions& mapping) {
  const auto source = open_frame_source(mapping.source, read_program_config(mapping).source);
  const auto range = positions(parse_frame_range(mapping.frames), source->size());
  return video_rate(*source, range, mapping.source);
}

/// The schedule in frames of this recording.
std::vector<std::string> settings_of(const AblationSchedule& schedule,
                                     const MappingOptions& mapping) {
  const double rate = rate_of(mapping);
  return {concat("mask_interval=", frames_between(schedule.masks_s, rate)),
          concat("view_interval=", frames_between(schedule.views_s, rate))};
}

MappingOptions options_of(const AblateOptions& options, const AblationVariant& variant,
                          const std::string& scene) {
  MappingOptions mapping = options.mapping;
  mapping.source = scene;
  mapping.recognizer = "none";  // the paper has none
  if (!variant.masks.empty()) mapping.masks = variant.masks;
  if (!variant.encoder.empty()) mapping.encoder = variant.encoder;
  if (!variant.views.empty()) mapping.views = variant.views;
  if (variant.frames != ":") mapping.frames = variant.frames;
  // What is compared without 2D masks is compared in words as well.
  if (variant.masks == "none" && mapping.encoder == "auto") mapping.encoder = "default";
  mapping.settings.insert(mapping.settings.end(), variant.settings.begin(), variant.settings.end());
  if (variant.schedule)
    for (std::string& setting : settings_of(*variant.schedule, mapping))
      mapping.settings.push_back(std::move(setting));
  return mapping;
}

/// The truth's own objects with the embeddings that the variant gives them.
MapDocument embed_truth(const MappingOptions& mapping, const std::string& title) {
  const ProgramConfig program = read_program_config(mapping);
  Truth truth = load_truth(mapping.source);
  truth.mesh.labels.clear();
  for (const std::int32_t id : truth.instances)
    truth.mesh.labels.push_back(id > 0 ? static_cast<std::uint32_t>(id) : 0);
  const auto source = open_frame_source(mapping.source, program.source);
  const auto range = positions(parse_frame_range(mapping.frames), source->size());
  GeometryEmbeddingConfig config;
  config.semantics = program.mapper.semantics;
  SequenceResult sequence;
  Progress progress(title);
  MapDocument document =
      embed_geometry(truth.mesh, *source, range, config, make_encoder(mapping, program), sequence,
                     [&](std::size_t done, std::size_t total, const FrameReport*) {
                       progress.show(done, total);
                       return !interrupted();
                     });
  document.source = source->kind() + ":" + mapping.source;
  return document;
}

/// Masks depend on the network and on what it is prompted by; both are in the folder's name or
/// the same for all variants of an ablation. What is timed is not taken from a folder.
fs::path mask_folder(const AblateOptions& options, const MappingOptions& mapping) {
  if (mapping.masks == "none" || mapping.masks == "gt" || options.name == kTiming) return {};
  return options.out / "masks" / (scene_name(mapping.source) + "-" + file_slug(mapping.masks));
}

void stop_if_interrupted() {
  if (interrupted())
    throw Error("interrupted; maps that were finished are kept, the same command goes on there");
}

/// Makes the variant's map of a scene unless an earlier run left it.
fs::path map_of(const AblateOptions& options, const AblationVariant& variant,
                const std::string& scene) {
  const fs::path folder = options.out / "maps" / options.name;
  make_folder(folder);
  const fs::path map = folder / (scene_name(scene) + "-" + file_slug(variant.name) + ".ovimap");
  if (fs::exists(map)) return map;
  const MappingOptions mapping = options_of(options, variant, scene);
  const std::string title = concat(options.name, " '", variant.name, "', ", scene_name(scene));
  MapDocument document =
      variant.true_objects
          ? embed_truth(mapping, title)
          : std::move(map_recording(mapping, title, mask_folder(options, mapping)).document);
  stop_if_interrupted();
  save_map(map, document);
  return map;
}

AblationResult measure(const AblateOptions& options, const Ablation& ablation,
                       const AblationVariant& variant) {
  std::vector<MapAndTruth> pairs;
  for (const std::string& scene : options.scenes)
    pairs.push_back({map_of(options, variant, scene), scene});
  const bool classes =
      std::any_of(ablation.columns.begin(), ablation.columns.end(),
                  [](const AblationColumn& column) { return column.name.rfind("inst", 0) != 0; });
  EvaluationOptions evaluation_options;
  evaluation_options.classes = options.classes;
  evaluation_options.encoder = classes ? "auto" : "none";
  evaluation_options.model_dirs = options.mapping.model_dirs;
  evaluation_options.runtime.threads = options.mapping.threads;
  const EvaluationConfig config;
  const Evaluation evaluation = evaluate_maps(pairs, evaluation_options, config);
  return {variant, figures_of(evaluation, config, {})};
}

std::string heading(const AblateOptions& options) {
  return concat("`ovimap ablate ", options.name, "`, masks ", options.mapping.masks,
                ", percent, scenes pooled: ", listed(options.scenes, scene_name), ". ", version(),
                " (", commit(),
                "). Published figures are the paper's, with its own networks on its own data.");
}

/// What the heading says of the recordings' frame rates, where they matter.
std::string rates_text(const AblateOptions& options, const Ablation& ablation) {
  if (std::none_of(ablation.variants.begin(), ablation.variants.end(),
                   [](const AblationVariant& variant) { return variant.schedule.has_value(); }))
    return {};
  std::string text = " Frames a second that are mapped:";
  for (const std::string& scene : options.scenes) {
    MappingOptions mapping = options.mapping;
    mapping.source = scene;
    char rate[32];
    std::snprintf(rate, sizeof rate, " %.1f", rate_of(mapping));
    text += (&scene == &options.scenes.front() ? "" : ",") + std::string(rate);
  }
  return text + ".";
}

/// A model that is missing or damaged is said now, not when its turn comes.
void require_models(const AblateOptions& options, const Ablation& ablation) {
  std::set<std::pair<std::string, std::string>> tried;
  for (const AblationVariant& variant : ablation.variants) {
    MappingOptions mapping = options_of(options, variant, options.scenes.front());
    if (!tried.emplace(mapping.masks, mapping.encoder).second) continue;
    const ProgramConfig config = read_program_config(mapping);
    make_encoder(mapping, config);
    if (variant.true_objects || mapping.masks == "gt") continue;
    make_mask_source(mapping.masks, config.masks, {nullptr, mapping.model_dirs});
  }
}

/// Nothing is varied: one map of each scene says what its stages took.
int time_stages(const AblateOptions& options) {
  std::vector<fs::path> maps;
  AblationVariant as_given;
  as_given.name = "default";
  for (const std::string& scene : options.scenes) maps.push_back(map_of(options, as_given, scene));
  const std::string table = timing_markdown(maps, heading(options));
  write_text(options.out / "timing.md", table);
  if (options.json)
    print_json({{"table", (options.out / "timing.md").string()}});
  else
    std::printf("%s", table.c_str());
  return kDone;
}

int ablate(const AblateOptions& options) {
  const ThreadLimit limit(options.mapping.threads);
  const bool timing = options.name == kTiming;
  const Ablation ablation = timing ? Ablation{} : make_ablation(options.name, options.choice);
  for (const std::string& scene : options.scenes)  // before anything slow
    if (!timing) load_truth(scene);
  require_models(options, ablation);
  const std::string rates = rates_text(options, ablation);
  make_folder(options.out);
  require_same_settings(options.out, settings_text(options.mapping));
  watch_for_interrupt();
  if (timing) return time_stages(options);
  std::vector<AblationResult> results;
  for (const AblationVariant& variant : ablation.variants)
    results.push_back(measure(options, ablation, variant));
  const std::string table = ablation_markdown(ablation, results, heading(options) + rates);
  write_text(options.out / (options.name + ".md"), table);
  write_text(options.out / (options.name + ".csv"), ablation_csv(ablation, results));
  write_text(options.out / (options.name + ".svg"), ablation.along_frames
                                                        ? ablation_curves(ablation, results)
                                                        : ablation_bars(ablation, results));
  if (options.json)
    print_json({{"table", (options.out / (options.name + ".csv")).string()},
                {"picture", (options.out / (options.name + ".svg")).string()}});
  else
    std::printf("%s", table.c_str());
  return kDone;
}

}  // namespace

Action add_ablate(CLI::App& command) {
  auto options = std::make_shared<AblateOptions>();
  options->mapping.masks = "sam";
  std::string names;
  for (const std::string& name : ablation_names()) names += name + ", ";
  names += kTiming;
  command.add_option("NAME", options->name, "what is varied: " + names)->required();
  command.add_option("SCENE", options->scenes, "recordings with truth; figures are pooled")
      ->required();
  command
      .add_option("-o,--output", options->out,
                  "folder for the table (NAME.md, NAME.csv), its picture (NAME.svg), masks and "
                  "maps; maps that are there already are not made again")
      ->required();
  command.add_option("--masks", options->mapping.masks, "2D masks, where they are not varied")
      ->capture_default_str();
  command.add_option("--encoder", options->mapping.encoder, "encoder, where it is not varied")
      ->capture_default_str();
  one_value(command.add_option("--with-encoder", options->choice.encoders,
                               "of encoder: an encoder to compare; may be repeated"));
  one_value(command.add_option("--with-masks", options->choice.models,
                               "of masks: a further model to compare; may be repeated"));
  command.add_option("--classes", options->classes, "as `ovimap eval` takes it")
      ->capture_default_str();
  one_value(command.add_option("--set", options->mapping.settings,
                               "one setting of all variants, a.b=c; may be repeated"));
  add_model_dirs(command, options->mapping.model_dirs);
  add_frame_range(command, options->mapping.frames);
  command.add_option("--threads", options->mapping.threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return ablate(*options); };
}

}  // namespace ovimap::apps
