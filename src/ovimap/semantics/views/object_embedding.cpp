// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/object_embedding.h"

#include <iterator>

namespace ovimap {

namespace {

/// Rows of zeros, which stand for failed crops, add nothing.
Eigen::VectorXf direction_of_sum(const Eigen::Ref<const Embeddings>& rows) {
  const Eigen::VectorXf sum = rows.colwise().sum().transpose();
  const float length = sum.norm();
  if (!(length > 0.f) || !sum.allFinite()) return {};
  return sum / length;
}

}  // namespace

std::vector<Eigen::VectorXf> embed_objects(ImageTextEncoder& encoder,
                                           std::span<const ObjectCrop* const> objects,
                                           const CropConfig& config) {
  std::vector<RgbImage> images;
  std::vector<Eigen::Index> first;
  for (const ObjectCrop* object : objects) {
    first.push_back(static_cast<Eigen::Index>(images.size()));
    std::vector<RgbImage> variants = crop_variants(*object, config);
    std::move(variants.begin(), variants.end(), std::back_inserter(images));
  }
  first.push_back(static_cast<Eigen::Index>(images.size()));
  if (images.empty()) return {};
  const Embeddings rows = encoder.encode_images(images);
  std::vector<Eigen::VectorXf> result;
  for (std::size_t i = 0; i < objects.size(); ++i)
    result.push_back(direction_of_sum(rows.middleRows(first[i], first[i + 1] - first[i])));
  return result;
}

}  // namespace ovimap
