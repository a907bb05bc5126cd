// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/connected_regions.h"

#include <algorithm>
#include <vector>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

struct Run {
  int begin, end;  ///< columns [begin, end)
};

std::vector<Run> runs_of_row(const std::uint8_t* mask, int width) {
  std::vector<Run> runs;
  for (int x = 0; x < width;) {
    while (x < width && !mask[x]) ++x;
    const int begin = x;
    while (x < width && mask[x]) ++x;
    if (begin < x) runs.push_back({begin, x});
  }
  return runs;
}

/// Union-find whose root is always the smallest member, so ids follow raster order.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    for (std::size_t i = 0; i < count; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }
  std::uint32_t find(std::uint32_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

Image<std::uint32_t> connected_regions(const Image<std::uint8_t>& mask) {
  const auto rows = static_cast<std::size_t>(mask.height());
  std::vector<std::vector<Run>> runs(rows);
  parallel_for(rows, 32, [&](std::size_t y) {
    runs[y] = runs_of_row(mask.row(static_cast<int>(y)), mask.width());
  });
  std::vector<std::uint32_t> first(rows + 1, 0);
  for (std::size_t y = 0; y < rows; ++y)
    first[y + 1] = first[y] + static_cast<std::uint32_t>(runs[y].size());

  Sets sets(first[rows]);
  for (std::size_t y = 1; y < rows; ++y) {
    for (std::size_t i = 0, j = 0; i < runs[y].size() && j < runs[y - 1].size();) {
      const Run &below = runs[y][i], &above = runs[y - 1][j];
      if (below.begin < above.end && above.begin < below.end)
        sets.unite(first[y] + static_cast<std::uint32_t>(i),
                   first[y - 1] + static_cast<std::uint32_t>(j));
      (below.end < above.end ? i : j) += 1;
    }
  }
  std::vector<std::uint32_t> id(first[rows]);
  std::uint32_t last_id = 0;
  for (std::uint32_t run = 0; run < id.size(); ++run)
    id[run] = sets.find(run) == run ? ++last_id : id[sets.find(run)];

  auto ids = Image<std::uint32_t>::unset(mask.width(), mask.height());
  parallel_for(rows, 32, [&](std::size_t y) {
    std::uint32_t* out = ids.row(static_cast<int>(y));
    std::fill_n(out, mask.width(), 0u);
    for (std::size_t i = 0; i < runs[y].size(); ++i)
      std::fill(out + runs[y][i].begin, out + runs[y][i].end, id[first[y] + i]);
  });
  return ids;
}

}  // namespace ovimap
