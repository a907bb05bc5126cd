// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/masks/entity_mask_source.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/inference/masks/entity_ids.h"
#include "ovimap/inference/models/image_tensor.h"

namespace ovimap {

namespace {

constexpr const char* kNetwork = "network";
constexpr std::size_t kMaskRowsPerTask = 16;

struct Query {
  std::span<const float> logits;
  float class_probability = 0;
  float score = 0;
};

/// The largest softmax probability but for the last class, "no object".
float class_probability(std::span<const float> logits) {
  const float largest = *std::max_element(logits.begin(), logits.end());
  float sum = 0, best = 0;
  for (std::size_t i = 0; i < logits.size(); ++i) {
    const float weight = std::exp(logits[i] - largest);
    sum += weight;
    if (i + 1 < logits.size()) best = std::max(best, weight);
  }
  return best / sum;
}

float threshold_logit(const EntityConfig& config) {
  return std::log(config.mask_probability / (1.f - config.mask_probability));
}

/// Mean probability of the pixels inside the mask; 0 when there are none.
float mean_mask_probability(const Query& query, const LogitGrid& grid, float threshold) {
  double sum = 0;
  std::size_t count = 0;
  for (int y = 0; y < grid.image_height_px; ++y) {
    const LogitRow row(query.logits, grid, y);
    for (int x = 0; x < grid.image_width_px; ++x) {
      const float logit = row.at(x);
      if (logit <= threshold) continue;
      sum += logistic(logit);
      ++count;
    }
  }
  return count == 0 ? 0.f : static_cast<float>(sum / static_cast<double>(count));
}

std::vector<Query> good_queries(const FloatTensor& class_logits, const FloatTensor& mask_logits,
                                const LogitGrid& grid, const EntityConfig& config) {
  const auto count = static_cast<std::size_t>(class_logits.shape[1]);
  const auto classes = static_cast<std::size_t>(class_logits.shape[2]);
  const std::size_t pixels =
      static_cast<std::size_t>(grid.size) * static_cast<std::size_t>(grid.size);
  std::vector<Query> queries;
  for (std::size_t i = 0; i < count; ++i) {
    const float probability =
        class_probability(std::span(class_logits.values).subspan(i * classes, classes));
    // The score can only be lower, so most queries need no look at their masks.
    if (probability >= config.min_score)
      queries.push_back(
          {std::span(mask_logits.values).subspan(i * pixels, pixels), probability, 0});
  }
  const float threshold = threshold_logit(config);
  parallel_for(queries.size(), 1, [&](std::size_t i) {
    queries[i].score =
        queries[i].class_probability * mean_mask_probability(queries[i], grid, threshold);
  });
  std::erase_if(queries, [&config](const Query& query) { return query.score < config.min_score; });
  std::stable_sort(queries.begin(), queries.end(),
                   [](const Query& a, const Query& b) { return a.score < b.score; });
  return queries;
}

IdImage paint(const std::vector<Query>& queries, const LogitGrid& grid, float threshold) {
  IdImage ids(grid.image_width_px, grid.image_height_px);
  parallel_for(static_cast<std::size_t>(ids.height()), kMaskRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (std::size_t k = 0; k < queries.size(); ++k) {
      const LogitRow logits(queries[k].logits, grid, y);
      for (int x = 0; x < ids.width(); ++x)
        if (logits.at(x) > threshold) ids.at(x, y) = static_cast<std::uint16_t>(k + 1);
    }
  });
  return ids;
}

}  // namespace

void list_fields(EntityConfig& config, ConfigFields& fields) {
  fields.add("min_score", config.min_score, 0.f, 1.f,
             "entities whose class times mean mask probability is lower are dropped");
  fields.add("mask_probability", config.mask_probability, 0.01f, 0.99f,
             "a pixel belongs to an entity's mask above this probability");
  fields.add("min_mask_px", config.min_mask_px, 1, 100000000,
             "entities that show fewer colour pixels are dropped");
}

EntityMaskSource::EntityMaskSource(const ModelFolder& model, const EntityConfig& config,
                                   const RuntimeConfig& runtime)
    : model_(checked_model(model, "entity", "as a query-based network")),
      config_(config),
      session_(model, kNetwork, runtime) {
  session_.input(model.input_of(kNetwork, "image"));
  const TensorInfo& classes = session_.output(model.output_of(kNetwork, "classes"));
  const TensorInfo& masks = session_.output(model.output_of(kNetwork, "masks"));
  if (classes.shape.size() != 3 || masks.shape.size() != 4)
    throw Error(concat("model ", model.folder.string(), ": outputs have shapes ",
                       to_text(classes.shape), " and ", to_text(masks.shape),
                       ", expected [1,queries,classes] and ",
                       "[1,queries,height,width]; export the network again"));
}

std::optional<Entities> EntityMaskSource::entities(const Frame& frame,
                                                   std::span<const MaskPrompt>) {
  const FloatTensor image = image_tensor(frame.color, model_.input);
  const std::vector<TensorInput> inputs = {
      {model_.input_of(kNetwork, "image"), image.shape, std::span<const float>(image.values)}};
  const std::vector<std::string> names = {model_.output_of(kNetwork, "classes"),
                                          model_.output_of(kNetwork, "masks")};
  const std::vector<FloatTensor> outputs = session_.run(inputs, names);
  const TensorShape& masks = outputs[1].shape;
  if (masks[2] != masks[3] || masks[1] != outputs[0].shape[1])
    throw Error(concat("model ", model_.folder.string(), ": masks have shape ", to_text(masks),
                       ", expected square masks, one a query"));
  const InputFrame input = input_frame(frame.color.width(), frame.color.height(), model_.input);
  return entities_of_queries(outputs[0], outputs[1],
                             logit_grid(input, model_.input.size_px, static_cast<int>(masks[2]),
                                        frame.color.width(), frame.color.height()),
                             config_);
}

Entities entities_of_queries(const FloatTensor& class_logits, const FloatTensor& mask_logits,
                             const LogitGrid& grid, const EntityConfig& config) {
  const std::vector<Query> queries = good_queries(class_logits, mask_logits, grid, config);
  Entities painted{paint(queries, grid, threshold_logit(config)), {}};
  for (const Query& query : queries) painted.scores.push_back(query.score);
  return keep_visible(std::move(painted), config.min_mask_px);
}

}  // namespace ovimap
