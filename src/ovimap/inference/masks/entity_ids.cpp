// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/masks/entity_ids.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace ovimap {

Entities entities_of_ids(const IdImage& ids) {
  constexpr std::size_t kIds = std::numeric_limits<std::uint16_t>::max() + std::size_t{1};
  std::vector<std::uint16_t> new_id(kIds, 0);
  for (const std::uint16_t id : ids) new_id[id] = 1;
  new_id[0] = 0;
  std::uint16_t count = 0;
  for (std::uint16_t& id : new_id)
    if (id != 0) id = ++count;
  Entities entities{ids, std::vector<float>(count, 1.f)};
  for (std::uint16_t& id : entities.ids) id = new_id[id];
  return entities;
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
