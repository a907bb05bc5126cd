// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "ovimap/base/parallel.h"
#include "ovimap/eval/scores/standard_scores.h"
#include "ovimap/inference/masks/id_mask_sources.h"
#include "ovimap/pipeline/mapping/prepared_frame.h"

namespace ovimap::apps {

namespace {

struct MasksOptions {
  MappingOptions mapping;
  std::filesystem::path folder;
  bool score = false;
  bool json = false;
};

/// Remembers what another source answered last.
class RememberingMaskSource : public MaskSource {
 public:
  explicit RememberingMaskSource(std::unique_ptr<MaskSource> source) : source_(std::move(source)) {}
  std::string kind() const override { return source_->kind(); }
  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override {
    return last_ = source_->entities(frame, prompts);
  }
  const std::optional<Entities>& last() const { return last_; }

 private:
  std::unique_ptr<MaskSource> source_;
  std::optional<Entities> last_;
};

/// The pixels of a frame as what 3D protocols compare. True objects of which less is seen than a
/// mask must have are left out.
LabelledScene labelled_pixels(const Entities& truth, const Entities& found, int min_px) {
  std::vector<int> areas(truth.scores.size() + 1, 0);
  for (const std::uint16_t id : truth.ids) ++areas[id];
  LabelledScene scene;
  for (const std::uint16_t id : truth.ids) scene.truth.push_back(areas[id] < min_px ? 0 : id);
  scene.predicted.assign(found.ids.begin(), found.ids.end());
  for (std::size_t i = 0; i < found.scores.size(); ++i)
    scene.confidence[static_cast<std::uint32_t>(i + 1)] = found.scores[i];
  return scene;
}

std::unique_ptr<MaskSource> open_masks(const MasksOptions& options, ProgramConfig& config,
                                       const FrameSource& source) {
  config.masks.runtime.threads = network_threads(config, options.mapping);
  auto masks =
      make_mask_source(options.mapping.masks, config.masks, {&source, options.mapping.model_dirs});
  if (!masks)
    throw Error("--masks none has no 2D entities; choose sam, gt, a model or a folder of PNGs");
  if (options.folder.empty()) return masks;
  return std::make_unique<KeptMaskSource>(options.folder, std::move(masks));
}

nlohmann::json score_json(const StandardScores& scores) {
  return {{"miou", scores.miou},
          {"ap25", scores.ap25},
          {"ap50", scores.ap50},
          {"ap75", scores.ap75},
          {"ap", scores.ap},
          {"truth_entities", scores.truth_instances},
          {"found_entities", scores.predicted_instances}};
}

void print_scores(const StandardScores& scores) {
  std::printf("mIoU %.3f  AP %.3f  AP75 %.3f  AP50 %.3f  AP25 %.3f  (%d found, %d true)\n",
              scores.miou, scores.ap, scores.ap75, scores.ap50, scores.ap25,
              scores.predicted_instances, scores.truth_instances);
}

struct Findings {
  std::int64_t frames = 0, entities = 0;  ///< of frames with masks
  std::int64_t frames_without_masks = 0;
  std::vector<LabelledScene> scenes;  ///< of --score, one a frame that has masks and truth
  StageTimers timers;
};

/// `truth` may be null. Ctrl-C ends it early.
Findings find_masks(const FrameSource& source, const std::vector<std::int64_t>& range,
                    const ProgramConfig& config, RememberingMaskSource& masks,
                    GtMaskSource* truth) {
  Findings findings;
  Progress progress("masks");
  watch_for_interrupt();
  for (std::size_t i = 0; i < range.size() && !interrupted(); ++i) {
    FrameRead read = source.read(range[i]);
    progress.show(i + 1, range.size());
    if (!read.frame) continue;
    const auto frame = std::make_shared<const Frame>(std::move(*read.frame));
    cut_segments(prepare_frame(frame, config.mapper, findings.timers), &masks, config.mapper,
                 findings.timers);
    if (!masks.last()) {
      ++findings.frames_without_masks;
      continue;
    }
    const Entities& found = *masks.last();
    ++findings.frames;
    findings.entities += static_cast<std::int64_t>(found.scores.size());
    const auto true_ids = truth ? truth->entities(*frame, {}) : std::nullopt;
    if (true_ids)
      findings.scenes.push_back(labelled_pixels(*true_ids, found, config.masks.sam.min_mask_px));
  }
  if (findings.frames + findings.frames_without_masks == 0)
    throw Error("none of the frames is usable; `ovimap check` tells more");
  if (findings.frames == 0)
    throw Error(concat("none of the ", findings.frames_without_masks, " frames has masks of '",
                       masks.kind(), "'; name a source that has some (--masks), or other frames"));
  return findings;
}

void print(const MasksOptions& options, const Findings& findings) {
  std::printf("%lld frames, %.1f entities each, %.0f ms each\n",
              static_cast<long long>(findings.frames),
              static_cast<double>(findings.entities) / static_cast<double>(findings.frames),
              findings.timers.summary().at("masks").p50_ms);
  if (findings.frames_without_masks > 0)
    std::printf("%lld more frames have no masks\n",
                static_cast<long long>(findings.frames_without_masks));
  if (options.score) print_scores(standard_scores(findings.scenes));
  if (!options.folder.empty())
    std::printf("written to %s; map with --masks %s\n", options.folder.c_str(),
                options.folder.c_str());
}

nlohmann::json to_json(const MasksOptions& options, const Findings& findings) {
  nlohmann::json report = {{"frames", findings.frames},
                           {"frames_without_masks", findings.frames_without_masks},
                           {"entities", findings.entities},
                           {"stages", stages_json(findings.timers)}};
  if (!options.folder.empty()) report["folder"] = options.folder.string();
  if (options.score) report["standard"] = score_json(standard_scores(findings.scenes));
  return report;
}

int masks(const MasksOptions& options) {
  if (options.folder.empty() && !options.score)
    throw Error("nothing to do: give a folder to write to (-o FOLDER), or --score");
  const ThreadLimit limit(options.mapping.threads);
  ProgramConfig config = read_program_config(options.mapping);
  const auto source = open_frame_source(options.mapping.source, config.source);
  const auto range = positions(parse_frame_range(options.mapping.frames), source->size());
  RememberingMaskSource found(open_masks(options, config, *source));
  const auto truth = options.score ? std::make_unique<GtMaskSource>(*source) : nullptr;
  const Findings findings = find_masks(*source, range, config, found, truth.get());
  if (options.json)
    print_json(to_json(options, findings));
  else
    print(options, findings);
  return kDone;
}

}  // namespace

Action add_masks(CLI::App& command) {
  auto options = std::make_shared<MasksOptions>();
  options->mapping.masks = "sam";
  add_mapping_options(command, options->mapping);
  command.add_option("-o,--output", options->folder,
                     "folder of PNGs, one a frame; those that are there are kept");
  command.add_flag("--score", options->score,
                   "compare with the recording's true instance images, every pixel a point");
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return masks(*options); };
}

}  // namespace ovimap::apps
