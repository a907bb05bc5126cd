// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>

#include "apps/command/kept_settings.h"
#include "apps/mapping/mapping_run.h"
#include "apps/mapping/run_report.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/text/ascii.h"
#include "ovimap/base/version.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/report/map_pictures.h"
#include "reproduce_report.h"

namespace ovimap::apps {

namespace {

namespace fs = std::filesystem;

struct ReproduceOptions {
  fs::path replica, scannet, out;
  std::vector<std::string> presets = {"reference"};
  std::string views;  ///< empty: as the preset goes
  MappingOptions mapping;
  bool json = false;
};

/// Settings that go before the user's. The paper's main rows look at every frame that they take;
/// its view coverage has bins of eight by eight pixels.
std::vector<std::string> paper_settings(const PaperDataset& dataset, const std::string& preset,
                                        const std::string& views) {
  std::vector<std::string> settings = {"mask_interval=1", "view_interval=1"};
  if (preset == "reference" && views == "viewcov")
    settings.insert(settings.end(), dataset.settings.begin(), dataset.settings.end());
  return settings;
}

/// What one preset makes of a scene. The paper's row of Replica is that of coverage alone
/// (`viewcov`).
MappingOptions mapping_of(const ReproduceOptions& options, const PaperDataset& dataset,
                          const std::string& preset, const PaperScene& scene) {
  MappingOptions mapping = options.mapping;
  mapping.source = scene.source.string();
  mapping.masks = scene.masks;
  mapping.recognizer = "none";  // the paper has none
  mapping.frames = scene.frames;
  mapping.preset = preset;
  mapping.views = !options.views.empty()  ? options.views
                  : preset == "reference" ? "viewcov"
                                          : "default";
  const auto before = paper_settings(dataset, preset, mapping.views);
  mapping.settings.insert(mapping.settings.begin(), before.begin(), before.end());
  return mapping;
}

void map_scene(const MappingOptions& mapping, const std::string& title, const fs::path& map) {
  const MappingRun mapped = map_recording(mapping, title, {}, RunTarget{map, true});
  if (interrupted()) throw Error("interrupted; the same command goes on where this one stopped");
  report_faults(mapped);
  save_map(map, mapped.document);
  mapped.checkpoints->remove();
}

/// Maps the scenes that have no map yet; returns the maps of all.
std::vector<MapAndTruth> map_scenes(const ReproduceOptions& options, const Reproduction& made,
                                    const std::string& preset) {
  const fs::path folder = options.out / "maps" / preset;
  make_folder(folder);
  std::vector<MapAndTruth> pairs;
  for (const PaperScene& scene : made.found.scenes) {
    pairs.push_back({folder / (scene.name + ".ovimap"), scene.source});
    if (fs::exists(pairs.back().map)) continue;
    try {
      map_scene(mapping_of(options, made.dataset, preset, scene),
                concat(scene.name, ", preset ", preset), pairs.back().map);
    } catch (const Error& fault) {
      throw Error(interrupted() ? fault.what() : concat(scene.name, ": ", fault.what()));
    }
  }
  return pairs;
}

EvalFigures measure(const ReproduceOptions& options, const PaperDataset& dataset,
                    const std::vector<MapAndTruth>& pairs) {
  EvaluationOptions evaluation_options;
  evaluation_options.classes = dataset.classes;
  evaluation_options.encoder = options.mapping.encoder;
  evaluation_options.model_dirs = options.mapping.model_dirs;
  evaluation_options.runtime.threads = options.mapping.threads;
  const EvaluationConfig config;
  const Evaluation evaluation = evaluate_maps(pairs, evaluation_options, config);
  for (const std::string& notice : evaluation.notices) warn(notice);
  return figures_of(evaluation, config, {});
}

void reproduce_dataset(const ReproduceOptions& options, Reproduction& made) {
  std::string encoder;
  for (const std::string& preset : options.presets) {
    const auto pairs = map_scenes(options, made, preset);
    encoder = read_map_info(pairs.front().map).encoder.name;
    AblationVariant variant;
    variant.name = concat("ovimap, ", preset, " settings");
    made.results.push_back({variant, measure(options, made.dataset, pairs)});
  }
  made.notes = differences_from_paper(made, options.mapping.masks, encoder);
}

/// Looks for all scenes before anything slow, and says which are missing.
std::vector<Reproduction> find_scenes(const ReproduceOptions& options) {
  const FrameSourceConfig config = read_program_config(options.mapping).source;
  std::vector<Reproduction> all;
  const auto look = [&](const PaperDataset& dataset, const fs::path& root) {
    if (root.empty()) return;
    Reproduction made{
        dataset, find_paper_scenes(dataset, root, options.mapping.masks, config), {}, {}};
    for (const std::string& line : made.found.missing) warn(concat(dataset.name, " ", line));
    if (!made.found.scenes.empty()) all.push_back(std::move(made));
  };
  if (options.replica.empty() && options.scannet.empty())
    throw Error("say where your copy of the data is: --replica FOLDER, --scannet FOLDER or both");
  look(paper_replica(), options.replica);
  look(paper_scannet(), options.scannet);
  if (all.empty())
    throw Error("none of the paper's scenes can be used; the lines above say what each lacks");
  return all;
}

/// A model that is missing or damaged is said now, not when its turn comes.
void require_models(const MappingOptions& mapping) {
  const ProgramConfig config = read_program_config(mapping);
  if (mapping.masks != "gt" && !masks_by_scene(mapping.masks))
    make_mask_source(mapping.masks, config.masks, {nullptr, mapping.model_dirs});
  make_encoder(mapping, config);
}

std::string heading(const ReproduceOptions& options, const Reproduction& made) {
  return concat("`ovimap reproduce`, masks ", options.mapping.masks, ", encoder ",
                options.mapping.encoder, ", percent, scenes pooled: ", made.found.scenes.size(),
                " of ", made.dataset.scenes.size(), ". ", version(), " (", commit(),
                "). Published figures are the paper's and its rivals', as the paper prints them.");
}

/// Writes what was measured on a data set; returns its table.
std::string write_tables(const ReproduceOptions& options, const Reproduction& made) {
  const std::string name = lower_case(made.dataset.name);
  const std::string table = reproduction_markdown(made, heading(options, made));
  write_text(options.out / (name + ".md"), table);
  write_text(options.out / (name + ".csv"), reproduction_csv(made));
  return table;
}

int reproduce(const ReproduceOptions& options) {
  const ThreadLimit limit(options.mapping.threads);
  std::vector<Reproduction> all = find_scenes(options);
  require_models(options.mapping);
  make_folder(options.out);
  require_same_settings(options.out,
                        concat(settings_text(options.mapping), "views ", options.views, "\n"));
  watch_for_interrupt();
  nlohmann::json json = nlohmann::json::object();
  for (Reproduction& made : all) {
    reproduce_dataset(options, made);
    const std::string table = write_tables(options, made);
    json[made.dataset.name] = reproduction_json(made);
    if (!options.json) std::printf("%s\n", table.c_str());
  }
  write_text(options.out / "reproduce.json", json_text(json));
  if (options.json) print_json(json);
  return kDone;
}

void add_data(CLI::App& command, ReproduceOptions& options) {
  command.add_option("--replica", options.replica,
                     "folder of NICE-SLAM's Replica pack: office0 to office4, room0 to room2");
  command.add_option("--scannet", options.scannet,
                     "folder of ScanNet: its 18 scenes, here or in scans/");
  command
      .add_option("-o,--output", options.out,
                  "folder for the tables (replica.md, scannet.md, .csv, reproduce.json) and maps; "
                  "maps that are there already are not made again")
      ->required();
  command
      .add_option("--masks", options.mapping.masks,
                  "2D masks: FOLDER that holds SCENE/FRAME.png, a model, sam, gt or none")
      ->capture_default_str();
  command
      .add_option("--encoder", options.mapping.encoder,
                  "what names objects: none, default, a model, or auto (default where there are "
                  "2D masks)")
      ->capture_default_str();
}

}  // namespace

Action add_reproduce(CLI::App& command) {
  auto options = std::make_shared<ReproduceOptions>();
  options->mapping.masks = "sam";
  add_data(command, *options);
  one_value(command.add_option("--preset", options->presets,
                               "reference (thresholds as the paper's code ships them) or default "
                               "(ours); a row each, may be repeated"))
      ->check(CLI::IsMember({"reference", "default"}))
      ->capture_default_str();
  command.add_option("--views", options->views,
                     "which views are embedded; viewcov with the preset reference, else default");
  one_value(command.add_option("--set", options->mapping.settings,
                               "one setting of all maps, a.b=c; may be repeated"));
  add_model_dirs(command, options->mapping.model_dirs);
  command.add_option("--threads", options->mapping.threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  command.footer(
      "Example, with masks and encoder of the paper:\n"
      "  ovimap reproduce --replica Replica --scannet ScanNet --masks cropformer \\\n"
      "    --encoder siglip-l --preset reference --preset default -o tables");
  return [options] { return reproduce(*options); };
}

}  // namespace ovimap::apps
