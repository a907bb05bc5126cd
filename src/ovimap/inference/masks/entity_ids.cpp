// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/masks/entity_ids.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace ovimap {

std::uint16_t last_id(const IdImage& ids) {
  return ids.size() > 0 ? *std::max_element(ids.begin(), ids.end()) : std::uint16_t{0};
}

Entities entities_of_ids(const IdImage& ids) {
  return keep_visible({ids, std::vector<float>(last_id(ids), 1.f)}, 0);
}

Entities keep_visible(Entities entities, int min_px) {
  std::vector<int> pixels(entities.scores.size() + 1, 0);
  for (const std::uint16_t id : entities.ids) ++pixels[id];
  std::vector<std::uint16_t> new_id(pixels.size(), 0);
  std::vector<float> scores;
  for (std::size_t id = 1; id < pixels.size(); ++id) {
    if (pixels[id] < std::max(min_px, 1)) continue;
    scores.push_back(entities.scores[id - 1]);
    new_id[id] = static_cast<std::uint16_t>(scores.size());
  }
  for (std::uint16_t& id : entities.ids) id = new_id[id];
  return {std::move(entities.ids), std::move(scores)};
}

}  // namespace ovimap
