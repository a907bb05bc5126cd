// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/instance/instance_registry.h"

namespace ovimap {

/// What a search needs to know of an object beside its embedding. World frame, metres.
struct SearchObject {
  InstanceId id = 0;
  Eigen::AlignedBox3f box;
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();
  std::size_t points = 0;  ///< surface voxels
  std::string name;        ///< given by a person; empty otherwise
};

/// All objects of a map with their embeddings, searched exhaustively, so that nothing is missed; up
/// to some 100,000 objects no index would be felt to be faster (docs/query.md has the figures).
/// Objects are addressed by their position. Immutable, hence safe to share between threads.
class SearchIndex {
 public:
  SearchIndex() = default;

  /// One row of `embeddings` [objects, d] an object; rows are scaled to length 1. A zero row is an
  /// object without embedding, which no text ever finds. Throws Error when the row count differs or
  /// a number is not finite.
  SearchIndex(std::vector<SearchObject> objects, Embeddings embeddings);

  std::size_t size() const { return objects_.size(); }
  std::size_t embedded() const { return embedded_; }  ///< objects with an embedding
  int dimension() const { return static_cast<int>(embeddings_.cols()); }
  const SearchObject& object(std::size_t position) const { return objects_[position]; }
  const std::vector<SearchObject>& objects() const { return objects_; }
  const Embeddings& embeddings() const { return embeddings_; }  ///< rows of length 1 or 0
  bool has_embedding(std::size_t position) const { return has_embedding_[position]; }

  /// Whether people call an object so, in any letters: "the red mug on the table" may be a name.
  bool is_name(std::string_view text) const;

  /// Position of the object with that id, if there is one.
  std::optional<std::size_t> find(InstanceId id) const;

  /// Cosine of every object with `query` [d], of any length; 0 for objects without embedding. In
  /// fixed point of 16 bits, which is right to about 5e-5, takes half the memory traffic and is the
  /// same to the bit on every machine. The caller checks the dimension first.
  Eigen::VectorXf cosines(const Eigen::VectorXf& query) const;

  /// Positions of the `count` objects with the highest `scores` [objects], best first, ties by id;
  /// objects without embedding are left out.
  std::vector<std::size_t> best(const Eigen::VectorXf& scores, std::size_t count) const;

 private:
  std::vector<SearchObject> objects_;
  Embeddings embeddings_;
  std::vector<std::int16_t> fixed_point_;  ///< the same, row after row
  std::vector<bool> has_embedding_;
  std::size_t embedded_ = 0;
};

}  // namespace ovimap
