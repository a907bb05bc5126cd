// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "eval_report.h"
#include "ovimap/base/parallel.h"
#include "ovimap/image/codec.h"

namespace ovimap::apps {

namespace {

struct EvalOptions {
  std::vector<std::filesystem::path> maps, truths;
  std::vector<std::string> settings;
  std::string protocol = "both";
  std::filesystem::path markdown;
  EvaluationOptions evaluation;
  int threads = 0;
  bool json = false;
};

EvaluationConfig evaluation_config(const EvalOptions& options) {
  EvaluationConfig config;
  ConfigFields fields;
  fields.group("eval", [&](ConfigFields& inner) { list_fields(config, inner); });
  apply_settings(options.settings, fields);
  return config;
}

int eval(const EvalOptions& options) {
  if (options.maps.size() != options.truths.size())
    throw Error(concat(options.maps.size(), " maps but ", options.truths.size(),
                       " truths; give one --gt SOURCE for each map, in order"));
  const ThreadLimit limit(options.threads);
  const EvaluationConfig config = evaluation_config(options);
  EvaluationOptions evaluation_options = options.evaluation;
  evaluation_options.runtime.threads = options.threads;
  std::vector<MapAndTruth> pairs;
  for (std::size_t i = 0; i < options.maps.size(); ++i)
    pairs.push_back({options.maps[i], options.truths[i]});
  const Evaluation evaluation = evaluate_maps(pairs, evaluation_options, config);
  for (const std::string& notice : evaluation.notices) warn(notice);
  const ProtocolChoice protocols{options.protocol != "reference", options.protocol != "standard"};
  const EvalTable table = table_of(evaluation, config, protocols);
  const std::string tables = eval_markdown(evaluation, table, config.sizes);
  if (!options.markdown.empty()) write_text(options.markdown, tables);
  if (options.json)
    print_json(eval_json(evaluation, table));
  else
    std::printf("%s", tables.c_str());
  return kDone;
}

}  // namespace

Action add_eval(CLI::App& command) {
  auto options = std::make_shared<EvalOptions>();
  command
      .add_option(
          "MAP", options->maps,
          "map files, or surfaces of other programs (PLY, objects as `label`); several are pooled")
      ->required();
  command
      .add_option("--gt", options->truths, "scene with truth, one for each map in the same order")
      ->required();
  command
      .add_option("--classes", options->evaluation.classes,
                  "auto or truth: the truth's own names; replica51, scannet200, scannet20 or a "
                  "file of names")
      ->capture_default_str();
  command
      .add_option("--encoder", options->evaluation.encoder,
                  "default, a model, auto: the one that the map was made with, or none: no classes")
      ->capture_default_str();
  command.add_option("--protocol", options->protocol, "which figures to compute")
      ->check(CLI::IsMember({"both", "standard", "reference"}))
      ->capture_default_str();
  command.add_option("--markdown", options->markdown, "write the tables to this file as well");
  add_model_dirs(command, options->evaluation.model_dirs);
  command.add_option("--set", options->settings, "one setting, eval.a=b; may be repeated")
      ->type_size(1)
      ->allow_extra_args(false);
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return eval(*options); };
}

}  // namespace ovimap::apps
