// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/sam_mask_source.h"

#include <algorithm>

#include "ovimap/inference/sam/mask_pool.h"
#include "ovimap/inference/sam/prompt_planner.h"

namespace ovimap {

SamMaskSource::SamMaskSource(const ModelFolder& model, const SamConfig& config,
                             const RuntimeConfig& runtime)
    : network_(model, runtime), config_(config) {
  if (EntityFinder::is_in(model) && config.finder.max_prompts > 0) finder_.emplace(model, runtime);
}

std::optional<Entities> SamMaskSource::entities(const Frame& frame,
                                                std::span<const MaskPrompt> prompts) {
  const ImageFeatures features = network_.encode(frame.color);
  const LogitGrid grid = logit_grid(features.frame, network_.input_size_px(), network_.grid_size(),
                                    frame.color.width(), frame.color.height());
  FinderMaps maps;
  std::optional<ThingCells> cells;
  if (finder_) {
    maps = finder_->look(network_.embedding(features), features.frame, frame);
    cells.emplace(maps, frame.color.width(), frame.color.height());
  }
  const ThingMasks masks(std::move(maps), grid.size);
  MaskPool pool(config_, grid, cells);
  if (config_.prompting == Prompting::kGrid)
    ask_on_grid(features, pool);
  else
    ask_where_expected(features, cells ? things_in(*cells, config_.finder) : std::vector<Thing>(),
                       masks, prompts, pool);
  return pool.entities();
}

std::vector<MaskPrompt> SamMaskSource::things_to_ask(const std::vector<Thing>& things,
                                                     const ThingMasks& masks,
                                                     MaskPool& pool) const {
  std::vector<MaskPrompt> open;
  for (const Thing& thing : things)
    if (masks.empty() || !pool.offer_unasked(masks.mask_at(thing.cell, pool.grid()), thing.prompt))
      open.push_back(thing.prompt);
  return open;
}

void SamMaskSource::ask_where_expected(const ImageFeatures& features,
                                       const std::vector<Thing>& things, const ThingMasks& masks,
                                       std::span<const MaskPrompt> prompts, MaskPool& pool) const {
  std::vector<MaskPrompt> open = things_to_ask(things, masks, pool);
  const auto spared = static_cast<int>(things.size() - open.size());
  // What a finder saw has as many prompts of its own: what it missed is to be found beside that.
  const auto objects = static_cast<int>(std::count_if(
      prompts.begin(), prompts.end(), [](const MaskPrompt& prompt) { return prompt.known; }));
  const int allowed =
      config_.max_decoder_prompts - spared + std::min(objects, config_.max_decoder_prompts);
  open.insert(open.end(), prompts.begin(), prompts.end());
  ask_where_unexplained(features, open, allowed, pool);
}

void SamMaskSource::ask_where_unexplained(const ImageFeatures& features,
                                          std::span<const MaskPrompt> regions, int prompts_allowed,
                                          MaskPool& pool) const {
  PromptPlanner planner(config_, pool.grid(), regions);
  for (int budget = prompts_allowed; budget > 0;) {
    const std::vector<PlannedPrompt> batch =
        planner.next(pool, std::min(budget, config_.decoder_batch));
    if (batch.empty()) break;
    budget -= static_cast<int>(batch.size());
    std::vector<PromptPoints> points;
    for (const PlannedPrompt& prompt : batch) points.push_back(prompt.points);
    const std::vector<MaskProposals> answers = network_.decode(features, points);
    for (std::size_t i = 0; i < batch.size(); ++i)
      if (!pool.offer(answers[i], planner.region_of(batch[i]), batch[i].boxed))
        planner.failed(batch[i]);
  }
}

void SamMaskSource::ask_on_grid(const ImageFeatures& features, MaskPool& pool) const {
  const std::vector<PromptPoints> points =
      grid_prompts(pool.grid().image_width_px, pool.grid().image_height_px, config_.grid_side);
  const auto batch = static_cast<std::size_t>(config_.decoder_batch);
  for (std::size_t first = 0; first < points.size(); first += batch) {
    const auto chosen = std::span(points).subspan(first, std::min(batch, points.size() - first));
    for (const MaskProposals& answer : network_.decode(features, chosen)) pool.offer(answer);
  }
}

}  // namespace ovimap
