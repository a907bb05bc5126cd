// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "apps/command/save_again.h"
#include "ovimap/base/parallel.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/pipeline/revise/reembed.h"

namespace ovimap::apps {

namespace {

struct ReembedOptions {
  std::filesystem::path map, out;
  std::string encoder = "default";
  std::vector<std::filesystem::path> model_dirs;
  int threads = 0;
  bool json = false;
};

int reembed_map(const ReembedOptions& options) {
  const ThreadLimit limit(options.threads);
  const std::filesystem::path out = options.out.empty() ? options.map : options.out;
  if (options.encoder.empty() || options.encoder == "none")
    throw Error("--encoder names none, and without one nothing is embedded; name an encoder");
  MapDocument document = load_map(options.map);
  check_map_target(out);
  RuntimeConfig runtime;
  runtime.threads = options.threads;
  const auto encoder =
      make_image_text_encoder(options.encoder, runtime, options.model_dirs, EncoderUse::kImages);
  ReembedSummary summary;
  {
    Progress progress("embedding");
    summary = reembed(document.semantics, *encoder,
                      [&](std::size_t done, std::size_t total) { progress.show(done, total); });
  }
  save_again(options.map, out, document);
  if (options.json)
    print_json({{"map", out.string()},
                {"encoder", encoder->identity().name},
                {"dimension", encoder->identity().dimension},
                {"instances", summary.super_points},
                {"views", summary.views},
                {"views_dropped", summary.dropped}});
  else
    std::printf("%s: %zu super-points have embeddings of %s, from %zu kept crops\n", out.c_str(),
                summary.super_points, encoder->identity().name.c_str(), summary.views);
  return kDone;
}

}  // namespace

Action add_reembed(CLI::App& command) {
  auto options = std::make_shared<ReembedOptions>();
  command.add_option("MAP", options->map, "map file")->required();
  command.add_option("--encoder", options->encoder, "default, a model folder or a model's name")
      ->capture_default_str();
  command.add_option("-o,--output", options->out, "map file to write; without it MAP is replaced");
  add_model_dirs(command, options->model_dirs);
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return reembed_map(*options); };
}

}  // namespace ovimap::apps
