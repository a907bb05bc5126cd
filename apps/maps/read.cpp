// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "apps/command/save_again.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/revise/read_writing.h"

namespace ovimap::apps {

namespace {

struct ReadOptions {
  std::filesystem::path map, out;
  std::string reader = kDefaultReader;
  std::vector<std::filesystem::path> model_dirs;
  std::vector<std::string> settings;
  int threads = 0;
  bool json = false;
};

ReadWritingConfig reading_config(const ReadOptions& options) {
  ReadWritingConfig config;
  ConfigFields fields;
  fields.group("writing", [&](ConfigFields& inner) { list_fields(config, inner); });
  apply_settings(options.settings, fields);
  return config;
}

nlohmann::json lines_json(const std::vector<WrittenLine>& lines) {
  nlohmann::json list = nlohmann::json::array();
  for (const WrittenLine& line : lines)
    list.push_back({{"text", line.text}, {"confidence", line.confidence}});
  return list;
}

void print_objects(const MapInfo& info) {
  for (const auto& [id, lines] : info.writing) {
    std::printf("  #%-5u", id);
    for (const WrittenLine& line : lines)
      std::printf("  \"%s\" %.0f %%", line.text.c_str(), 100.0 * double{line.confidence});
    std::printf("\n");
  }
}

int read_map(const ReadOptions& options) {
  const ThreadLimit limit(options.threads);
  const std::filesystem::path out = options.out.empty() ? options.map : options.out;
  MapDocument document = load_map(options.map);
  check_map_target(out);
  RuntimeConfig runtime;
  runtime.threads = options.threads;
  const auto reader = make_writing_reader(options.reader, runtime, options.model_dirs);
  ReadWritingSummary summary;
  {
    Progress progress("reading");
    summary =
        read_writing(document.semantics, *reader, reading_config(options),
                     [&](std::size_t done, std::size_t total) { progress.show(done, total); });
  }
  save_again(options.map, out, document);
  const MapInfo info = read_map_info(out);
  if (options.json) {
    nlohmann::json objects = nlohmann::json::array();
    for (const auto& [id, lines] : info.writing)
      objects.push_back({{"id", id}, {"writing", lines_json(lines)}});
    print_json({{"map", out.string()},
                {"reader", reader->name()},
                {"crops", summary.crops},
                {"lines", summary.lines},
                {"instances", objects}});
    return kDone;
  }
  std::printf("%s: %zu lines in %zu crops, on %zu objects\n", out.c_str(), summary.lines,
              summary.crops, info.writing.size());
  print_objects(info);
  return kDone;
}

}  // namespace

Action add_read(CLI::App& command) {
  auto options = std::make_shared<ReadOptions>();
  command.add_option("MAP", options->map, "map file")->required();
  command.add_option("--reader", options->reader, "a model of kind writing: a folder or a name")
      ->capture_default_str();
  command.add_option("-o,--output", options->out, "map file to write; without it MAP is replaced");
  one_value(command.add_option("--set", options->settings,
                               "one setting, writing.NAME=VALUE; may be repeated"));
  add_model_dirs(command, options->model_dirs);
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return read_map(*options); };
}

}  // namespace ovimap::apps
