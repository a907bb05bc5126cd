// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "ovimap/base/parallel.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/pipeline/report/map_pictures.h"
#include "ovimap/pipeline/report/map_report.h"
#include "ovimap/pipeline/search/map_search.h"

namespace ovimap::apps {

namespace {

struct ReportOptions {
  std::filesystem::path map, out;
  std::string title;  ///< empty: the map file's name
  std::string classes = "scannet200";
  int names = 3;
  std::string encoder = "auto";
  MapReportConfig config;
  std::vector<std::filesystem::path> model_dirs;
  int threads = 0;
  bool json = false;
};

/// Guesses names, or writes down why that cannot be. What the user asked for by name must work;
/// what was only tried must not spoil the report.
void add_names(const MapDocument& document, const LabelSet& classes, const ReportOptions& options,
               MapReport& report) {
  if (options.encoder == "none" || !has_embeddings(document)) return;
  RuntimeConfig runtime;
  runtime.threads = options.threads;
  try {
    const auto encoder = needed_encoder_of_map(document.semantics.encoder, options.encoder, runtime,
                                               options.model_dirs);
    report.names = {classes.name, guess_names(document, *encoder, classes,
                                              static_cast<std::size_t>(options.names))};
  } catch (const Error& error) {
    if (options.encoder != "auto") throw;
    report.why_no_names = concat(error.what(), ".");
  }
}

MapReport make_report(const MapDocument& document, const LabelSet& classes,
                      const ReportOptions& options) {
  MapReport report;
  report.title = options.title.empty() ? options.map.stem().string() : options.title;
  report.voxel_size_m = document.map.config().voxel_size_m;
  if (document.map.block_count() > 0) {
    const TopDownPictures above = top_down_pictures(document);
    report.instances_picture = encode_png(above.instances);
    report.colors_picture = encode_png(above.colors);
  }
  add_names(document, classes, options, report);
  return report;
}

int write_report(const ReportOptions& options) {
  const ThreadLimit limit(options.threads);
  if (options.out.extension() != ".html")
    throw Error(concat("cannot write a report to '", options.out.string(),
                       "'; the name must end in .html"));
  check_file_target(options.out);
  const LabelSet classes = read_label_set(options.classes);
  const MapDocument document = load_corrected_map(options.map);
  const MapReport report = make_report(document, classes, options);
  const std::string html = map_report_html(document, report, options.config);
  write_text(options.out, html);
  const std::size_t named = report.names ? report.names->guesses.size() : 0;
  if (options.json)
    print_json({{"map", options.map.string()},
                {"out", options.out.string()},
                {"instances", document.instances.size()},
                {"named", named},
                {"bytes", html.size()}});
  else
    std::printf("%s: %zu objects, %zu with guessed names, %.1f MB\n", options.out.c_str(),
                document.instances.size(), named, static_cast<double>(html.size()) / 1e6);
  return kDone;
}

}  // namespace

Action add_report(CLI::App& command) {
  auto options = std::make_shared<ReportOptions>();
  command.add_option("MAP", options->map, "map file")->required();
  command.add_option("OUT", options->out, "page to write, .html")->required();
  command.add_option("--title", options->title, "headline; the map file's name without it");
  command
      .add_option("--classes", options->classes,
                  "names to guess from: replica51, scannet200, scannet20 or a text file with one a "
                  "line")
      ->capture_default_str();
  command.add_option("--names", options->names, "names an object is given")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  command.add_option("--crops", options->config.crops, "pictures an object is shown by")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  command
      .add_option("--encoder", options->encoder,
                  "what guesses names: auto (the map's own), none, default, or a model")
      ->capture_default_str();
  add_model_dirs(command, options->model_dirs);
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return write_report(*options); };
}

}  // namespace ovimap::apps
