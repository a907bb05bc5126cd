// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/search_index.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/text/ascii.h"
#include "ovimap/base/vectorize.h"

namespace ovimap {

namespace {

constexpr float kOne = 32767.f;                   // 1 in fixed point
constexpr std::size_t kNumbersPerTask = 1 << 18;  // half a MiB: worth handing to a thread

/// products[i] = rows[i] . query, in fixed point. No sum leaves 32 bits: all vectors have length 1,
/// so that no partial sum exceeds kOne * kOne (Cauchy-Schwarz) by more than rounding.
OVIMAP_VECTORIZE
void dot_products(const std::int16_t* rows, std::size_t count, std::size_t length,
                  const std::int16_t* query, float* products) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::int16_t* row = rows + i * length;
    std::int32_t sum = 0;
    for (std::size_t k = 0; k < length; ++k) sum += std::int32_t{row[k]} * std::int32_t{query[k]};
    products[i] = static_cast<float>(sum) / (kOne * kOne);
  }
}

/// Numbers in [-1, 1] -> fixed point.
template <class Numbers>
void to_fixed_point(const Numbers& numbers, std::int16_t* fixed) {
  for (Eigen::Index k = 0; k < numbers.size(); ++k)
    fixed[k] = static_cast<std::int16_t>(std::lround(numbers[k] * kOne));
}

}  // namespace

SearchIndex::SearchIndex(std::vector<SearchObject> objects, Embeddings embeddings)
    : objects_(std::move(objects)),
      embeddings_(std::move(embeddings)),
      has_embedding_(objects_.size(), false) {
  if (static_cast<std::size_t>(embeddings_.rows()) != objects_.size())
    throw Error(concat("the map has ", objects_.size(), " objects but ", embeddings_.rows(),
                       " embeddings; run `ovimap reembed` on it"));
  fixed_point_.assign(static_cast<std::size_t>(embeddings_.size()), 0);
  for (Eigen::Index row = 0; row < embeddings_.rows(); ++row) {
    const float length = embeddings_.row(row).norm();
    if (!std::isfinite(length))
      throw Error(concat("the embedding of object ", objects_[static_cast<std::size_t>(row)].id,
                         " is not finite; run `ovimap reembed` on the map"));
    if (length == 0.f) continue;
    embeddings_.row(row) /= length;
    to_fixed_point(embeddings_.row(row), fixed_point_.data() + row * embeddings_.cols());
    has_embedding_[static_cast<std::size_t>(row)] = true;
    ++embedded_;
  }
}

bool SearchIndex::is_name(std::string_view text) const {
  const std::string wanted = lower_case(text);
  return std::any_of(objects_.begin(), objects_.end(), [&](const SearchObject& object) {
    return object.name.size() == wanted.size() && lower_case(object.name) == wanted;
  });
}

std::optional<std::size_t> SearchIndex::find(InstanceId id) const {
  const auto at = std::find_if(objects_.begin(), objects_.end(),
                               [id](const SearchObject& object) { return object.id == id; });
  if (at == objects_.end()) return std::nullopt;
  return static_cast<std::size_t>(at - objects_.begin());
}

Eigen::VectorXf SearchIndex::cosines(const Eigen::VectorXf& query) const {
  OVIMAP_ASSERT(query.size() == embeddings_.cols());
  std::vector<std::int16_t> unit(static_cast<std::size_t>(query.size()));
  to_fixed_point(query.normalized().eval(), unit.data());
  Eigen::VectorXf scores(embeddings_.rows());
  const std::size_t length = unit.size();
  const std::size_t grain = kNumbersPerTask / std::max<std::size_t>(length, 1) + 1;
  parallel_for_ranges(size(), grain, [&](std::size_t begin, std::size_t end) {
    dot_products(fixed_point_.data() + begin * length, end - begin, length, unit.data(),
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
