// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/entity_finder.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr const char* kNetwork = "finder";
constexpr float kSameBoxIou = 0.6f;  // the usual threshold of suppressing lesser detections
constexpr float kMostLogCells = 6;   // e^6 cells are more than any image has

enum Map { kDepth, kLeft, kUpper, kRight, kLower, kFilled };

float logistic(float logit) { return 1 / (1 + std::exp(-logit)); }

class CellView {
 public:
  CellView(const FinderMaps& maps) : maps_(maps) {}
  float at(Map map, int x, int y) const {
    return maps_.values[static_cast<std::size_t>((map * maps_.rows + y) * maps_.columns + x)];
  }
  bool is_peak(int x, int y) const {
    const float here = at(kDepth, x, y);
    for (int v = std::max(0, y - 1); v <= std::min(maps_.rows - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(maps_.columns - 1, x + 1); ++u)
        if (at(kDepth, u, v) > here) return false;
    return true;
  }

 private:
  const FinderMaps& maps_;
};

struct Middle {
  float depth = 0;
  int x = 0, y = 0;
};

/// The deepest first; among equals in raster order.
std::vector<Middle> middles_of(const FinderMaps& maps, float min_depth) {
  const CellView cells(maps);
  std::vector<Middle> middles;
  for (int y = 0; y < maps.rows; ++y)
    for (int x = 0; x < maps.columns; ++x) {
      const float depth = logistic(cells.at(kDepth, x, y));
      if (depth >= min_depth && cells.is_peak(x, y)) middles.push_back({depth, x, y});
    }
  std::stable_sort(middles.begin(), middles.end(),
                   [](const Middle& a, const Middle& b) { return a.depth > b.depth; });
  return middles;
}

MaskPrompt prompt_at(const FinderMaps& maps, const Middle& middle,
                     const Eigen::AlignedBox2f& image) {
  const CellView cells(maps);
  const auto reach = [&](Map side) {
    return std::exp(std::min(cells.at(side, middle.x, middle.y), kMostLogCells));
  };
  const Eigen::Vector2f cell = maps.image_from_cell;
  const Eigen::Vector2f at = {(static_cast<float>(middle.x) + 0.5f) * cell.x() - 0.5f,
                              (static_cast<float>(middle.y) + 0.5f) * cell.y() - 0.5f};
  const Eigen::Vector2f before(reach(kLeft), reach(kUpper)), after(reach(kRight), reach(kLower));
  const Eigen::AlignedBox2f box(at - before.cwiseProduct(cell), at + after.cwiseProduct(cell));
  const Eigen::AlignedBox2f shown = box.intersection(image);
  const float filled = logistic(cells.at(kFilled, middle.x, middle.y));
  return {at, shown, static_cast<int>(std::lround(filled * shown.volume())), true};
}

float iou(const Eigen::AlignedBox2f& a, const Eigen::AlignedBox2f& b) {
  const Eigen::AlignedBox2f both = a.intersection(b);
  if (both.isEmpty()) return 0;
  return both.volume() / (a.volume() + b.volume() - both.volume());
}

}  // namespace

std::vector<MaskPrompt> things_in(const FinderMaps& maps, int width_px, int height_px,
                                  const FinderConfig& config) {
  const Eigen::AlignedBox2f image(
      Eigen::Vector2f(0, 0),
      Eigen::Vector2f(static_cast<float>(width_px - 1), static_cast<float>(height_px - 1)));
  std::vector<MaskPrompt> things;
  for (const Middle& middle : middles_of(maps, config.min_depth)) {
    if (static_cast<int>(things.size()) == config.max_prompts) break;
    const MaskPrompt thing = prompt_at(maps, middle, image);
    const bool is_new = std::none_of(things.begin(), things.end(), [&](const MaskPrompt& other) {
      return iou(thing.extent_px, other.extent_px) > kSameBoxIou;
    });
    if (image.contains(thing.interior_px) && is_new) things.push_back(thing);
  }
  return things;
}

EntityFinder::EntityFinder(const ModelFolder& model, const RuntimeConfig& runtime)
    : file_((model.folder / model.network(kNetwork).file).string()),
      input_(model.input_of(kNetwork, "embedding")),
      output_(model.output_of(kNetwork, "things")),
      input_size_px_(model.input.size_px),
      session_(file_, runtime) {
  session_.input(input_);
  const TensorShape& shape = session_.output(output_).shape;
  if (shape.size() != 4 || shape[1] != FinderMaps::kMaps)
    throw Error(concat("model file ", file_, ": tensor '", output_, "' has shape ", to_text(shape),
                       ", expected [1,", FinderMaps::kMaps, ",rows,columns]"));
}

namespace {

/// The upper left part of [1, channels, rows, columns], which the image fills.
FloatTensor filled_part(const FloatTensor& whole, std::int64_t rows, std::int64_t columns) {
  const std::int64_t channels = whole.shape[1], stride = whole.shape[3];
  FloatTensor part{{1, channels, rows, columns}, {}};
  part.values.reserve(static_cast<std::size_t>(channels * rows * columns));
  for (std::int64_t c = 0; c < channels; ++c)
    for (std::int64_t y = 0; y < rows; ++y) {
      const auto row = whole.values.begin() + (c * whole.shape[2] + y) * stride;
      part.values.insert(part.values.end(), row, row + columns);
    }
  return part;
}

}  // namespace

FinderMaps EntityFinder::look(const FloatTensor& embedding, const InputFrame& frame) const {
  if (embedding.shape.size() != 4)
    throw Error(concat("model file ", file_, ": an embedding of shape ", to_text(embedding.shape),
                       ", expected [1,channels,rows,columns]"));
  const auto cells = [&](int filled_px, std::int64_t all) {
    return (filled_px * all + input_size_px_ - 1) / input_size_px_;
  };
  const FloatTensor seen = filled_part(embedding, cells(frame.height_px, embedding.shape[2]),
                                       cells(frame.width_px, embedding.shape[3]));
  const std::vector<TensorInput> inputs = {
      {input_, seen.shape, std::span<const float>(seen.values)}};
  FloatTensor maps = session_.run(inputs, {&output_, 1}).front();
  if (maps.shape.size() != 4 || maps.shape[1] != FinderMaps::kMaps)
    throw Error(concat("model file ", file_, ": ", to_text(maps.shape), " came out, expected [1,",
                       FinderMaps::kMaps, ",rows,columns]"));
  const auto rows = static_cast<int>(maps.shape[2]), columns = static_cast<int>(maps.shape[3]);
  // As many cells to a side of the embedding's, whatever part of it was looked at.
  const auto cell_px = static_cast<float>(input_size_px_) * static_cast<float>(seen.shape[3]) /
                       static_cast<float>(embedding.shape[3] * columns);
  return {rows, columns, std::move(maps.values),
          Eigen::Vector2f::Constant(cell_px).cwiseQuotient(frame.scale)};
}

}  // namespace ovimap
