// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/entity_finder.h"

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr const char* kNetwork = "finder";
}  // namespace

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
