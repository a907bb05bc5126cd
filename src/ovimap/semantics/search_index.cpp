// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/search_index.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"

namespace ovimap {

namespace {

constexpr std::size_t kLanes = 32;  // partial sums: enough to hide the latency of additions
constexpr std::size_t kFloatsPerTask = 1 << 18;  // 1 MiB: a task worth handing to a thread

/// sums[i] = rows[i] . query. Eigen's product runs on the baseline instruction set only, and on one
/// thread: 1.8 times slower at 10,000 x 768. The partial sums fix the order of additions, so that
/// every instruction set gives the same bits.
OVIMAP_VECTORIZE
void dot_products(const float* rows, std::size_t count, std::size_t length, const float* query,
                  float* sums) {
  for (std::size_t i = 0; i < count; ++i) {
    const float* row = rows + i * length;
    float partial[kLanes] = {};
    std::size_t k = 0;
    for (; k + kLanes <= length; k += kLanes)
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        partial[lane] += row[k + lane] * query[k + lane];
    for (std::size_t width = kLanes / 2; width > 0; width /= 2)
      for (std::size_t lane = 0; lane < width; ++lane) partial[lane] += partial[lane + width];
    float sum = partial[0];
    for (; k < length; ++k) sum += row[k] * query[k];
    sums[i] = sum;
  }
}

}  // namespace

SearchIndex::SearchIndex(std::vector<SearchObject> objects, Embeddings embeddings)
    : objects_(std::move(objects)),
      embeddings_(std::move(embeddings)),
      has_embedding_(objects_.size(), false) {
  if (static_cast<std::size_t>(embeddings_.rows()) != objects_.size())
    throw Error(concat("the map has ", objects_.size(), " objects but ", embeddings_.rows(),
                       " embeddings; run `ovimap reembed` on it"));
  for (Eigen::Index row = 0; row < embeddings_.rows(); ++row) {
    const float length = embeddings_.row(row).norm();
    if (!std::isfinite(length))
      throw Error(concat("the embedding of object ", objects_[static_cast<std::size_t>(row)].id,
                         " is not finite; run `ovimap reembed` on the map"));
    if (length == 0.f) continue;
    embeddings_.row(row) /= length;
    has_embedding_[static_cast<std::size_t>(row)] = true;
    ++embedded_;
  }
}

std::optional<std::size_t> SearchIndex::find(InstanceId id) const {
  const auto at = std::find_if(objects_.begin(), objects_.end(),
                               [id](const SearchObject& object) { return object.id == id; });
  if (at == objects_.end()) return std::nullopt;
  return static_cast<std::size_t>(at - objects_.begin());
}

Eigen::VectorXf SearchIndex::cosines(const Eigen::VectorXf& query) const {
  OVIMAP_ASSERT(query.size() == embeddings_.cols());
  const Eigen::VectorXf unit = query.normalized();
  Eigen::VectorXf scores(embeddings_.rows());
  const auto length = static_cast<std::size_t>(embeddings_.cols());
  const std::size_t grain = kFloatsPerTask / std::max<std::size_t>(length, 1) + 1;
  parallel_for_ranges(size(), grain, [&](std::size_t begin, std::size_t end) {
    dot_products(embeddings_.data() + begin * length, end - begin, length, unit.data(),
                 scores.data() + begin);
  });
  return scores;
}

std::vector<std::size_t> SearchIndex::best(const Eigen::VectorXf& scores, std::size_t count) const {
  OVIMAP_ASSERT(static_cast<std::size_t>(scores.size()) == size());
  std::vector<std::size_t> positions;
  positions.reserve(embedded_);
  for (std::size_t i = 0; i < size(); ++i)
    if (has_embedding_[i]) positions.push_back(i);
  const auto better = [&](std::size_t a, std::size_t b) {
    const float score_a = scores[static_cast<Eigen::Index>(a)];
    const float score_b = scores[static_cast<Eigen::Index>(b)];
    return score_a != score_b ? score_a > score_b : objects_[a].id < objects_[b].id;
  };
  count = std::min(count, positions.size());
  const auto middle = positions.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(positions.begin(), middle, positions.end(), better);
  positions.erase(middle, positions.end());
  return positions;
}

}  // namespace ovimap
