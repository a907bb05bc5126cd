// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/entity_finder.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/inference/sam/depth_view.h"

namespace ovimap {

namespace {

constexpr const char* kFinder = "finder";
constexpr const char* kGeometry = "geometry";
constexpr const char* kBasis = "basis";
constexpr int kGridPxPerEmbedded = 4;  ///< of the grid on which depth is shown

}  // namespace

EntityFinder::EntityFinder(const ModelFolder& model, const RuntimeConfig& runtime)
    : file_((model.folder / model.network(kFinder).file).string()),
      input_(model.input_of(kFinder, "embedding")),
      outputs_{model.output_of(kFinder, "things")},
      input_size_px_(model.input.size_px),
      session_(model, kFinder, runtime) {
  session_.input(input_);
  const auto require = [this](const TensorInfo& tensor, std::int64_t channels) {
    if (tensor.shape.size() != 4 || tensor.shape[1] != channels)
      throw Error(concat("model file ", file_, ": tensor '", tensor.name, "' has shape ",
                         to_text(tensor.shape), ", expected [1,", channels, ",rows,columns]"));
  };
  const auto expect = [&](const std::string& output, std::int64_t channels) {
    require(session_.output(output), channels);
  };
  if (model.network(kFinder).inputs.contains(kGeometry)) {
    depth_input_ = model.input_of(kFinder, kGeometry);
    require(session_.input(depth_input_), kDepthMaps);
  }
  expect(outputs_.front(), FinderMaps::kMaps);
  if (!model.network(kFinder).outputs.contains(kBasis)) return;
  const std::string kernels = model.output_of(kFinder, "kernels"),
                    basis = model.output_of(kFinder, kBasis);
  expect(kernels, channels_of(basis) + FinderMaps::kPlaceTerms + 1);
  outputs_.insert(outputs_.end(), {kernels, basis});
}

/// 0 of what is no image.
std::int64_t EntityFinder::channels_of(const std::string& output) const {
  const TensorShape& shape = session_.output(output).shape;
  return shape.size() == 4 ? shape[1] : 0;
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

FinderMaps EntityFinder::look(const FloatTensor& embedding, const InputFrame& frame,
                              const Frame& source) const {
  if (embedding.shape.size() != 4)
    throw Error(concat("model file ", file_, ": an embedding of shape ", to_text(embedding.shape),
                       ", expected [1,channels,rows,columns]"));
  const auto cells = [&](int filled_px) {
    return (filled_px * embedding.shape[3] + input_size_px_ - 1) / input_size_px_;
  };
  const FloatTensor seen = filled_part(
      embedding, std::min(cells(frame.height_px), embedding.shape[2]), cells(frame.width_px));
  std::vector<TensorInput> inputs = {{input_, seen.shape, std::span<const float>(seen.values)}};
  FloatTensor depth;
  if (!depth_input_.empty()) {
    const auto grid_px = static_cast<float>(kGridPxPerEmbedded * embedding.shape[3]) /
                         static_cast<float>(input_size_px_);
    depth = depth_view(source, frame.scale * grid_px,
                       kGridPxPerEmbedded * static_cast<int>(seen.shape[2]),
                       kGridPxPerEmbedded * static_cast<int>(seen.shape[3]));
    inputs.push_back({depth_input_, depth.shape, std::span<const float>(depth.values)});
  }
  std::vector<FloatTensor> found = session_.run(inputs, outputs_);
  FloatTensor& maps = found.front();
  const auto expect = [this](const FloatTensor& tensor, const TensorShape& shape) {
    if (tensor.shape != shape)
      throw Error(concat("model file ", file_, ": ", to_text(tensor.shape), " came out, expected ",
                         to_text(shape)));
  };
  if (maps.shape.size() != 4 || maps.shape[1] != FinderMaps::kMaps)
    throw Error(concat("model file ", file_, ": ", to_text(maps.shape), " came out, expected [1,",
                       FinderMaps::kMaps, ",rows,columns]"));
  const auto rows = static_cast<int>(maps.shape[2]), columns = static_cast<int>(maps.shape[3]);
  // As many cells to a side of the embedding's, whatever part of it was looked at.
  const auto cell_px = static_cast<float>(input_size_px_) * static_cast<float>(seen.shape[3]) /
                       static_cast<float>(embedding.shape[3] * columns);
  FinderMaps said;
  said.rows = rows, said.columns = columns;
  said.values = std::move(maps.values);
  said.image_from_cell = Eigen::Vector2f::Constant(cell_px).cwiseQuotient(frame.scale);
  if (found.size() == 1) return said;
  const std::int64_t images = channels_of(outputs_[2]);
  expect(found[1], {1, images + FinderMaps::kPlaceTerms + 1, rows, columns});
  expect(found[2], {1, images, 2 * rows, 2 * columns});
  said.kernels = std::move(found[1].values);
  said.basis = std::move(found[2].values);
  said.whole_columns =
      static_cast<int>(columns * embedding.shape[3] / std::max<std::int64_t>(1, seen.shape[3]));
  return said;
}

}  // namespace ovimap
