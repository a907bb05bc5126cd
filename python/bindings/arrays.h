// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"
#include "ovimap/inference/encoders/image_text_encoder.h"

namespace ovimap::python {

namespace nb = nanobind;

/// Any array in the processor's memory, read through DLPack or the buffer protocol.
using AnyArray = nb::ndarray<nb::ro>;

// What Python gives, copied: the library owns its images. Arrays may have any strides. `name` is
// what messages call the argument. They throw TypeError for what is no array, is on a GPU or has
// another element type, and ValueError for another shape; both say what was expected and what came.

/// [height, width, 3] uint8.
RgbImage read_color(nb::handle object, const char* name = "color");
/// [height, width] float32 or float64 in metres, or any integers, `depth_scale` of which are a
/// metre. What is not between the limits (and NaN) becomes 0: no depth.
DepthImage read_depth(nb::handle object, std::optional<double> depth_scale, float min_depth_m,
                      float max_depth_m);
/// [height, width] integers or bool from 0 to 65535, of that size.
IdImage read_ids(nb::handle object, const std::string& name, int width, int height);
/// uint8 [height, width, 3] or uint16 [height, width].
using Picture = std::variant<RgbImage, Image<std::uint16_t>>;
Picture read_picture(nb::handle object, const char* name);
/// [4, 4] floats: a rigid transform. Throws ValueError with pose_fault.
Pose read_pose(nb::handle object, const char* name);
/// [rows, dimension] floats, scaled to rows of length 1; a row that is not finite becomes zeros.
Embeddings read_embeddings(nb::handle object, const std::string& name, std::size_t rows,
                           int dimension);

/// An integer of Python's or NumPy's, or the nearest one that fits; nullopt for anything else.
std::optional<std::int64_t> read_integer(nb::handle object);

/// Embeddings as an array of their own.
using EmbeddingArray = nb::ndarray<nb::numpy, const float, nb::ndim<2>>;
EmbeddingArray to_array(Embeddings rows);

/// A transform as an array of its own.
using Matrix4 = nb::ndarray<nb::numpy, const double, nb::shape<4, 4>>;
Matrix4 to_matrix(const Pose& pose);

/// An array over memory that `owner` keeps alive: no copy. Python can read it, not write.
template <class Array, class Element>
Array view(Element* data, std::initializer_list<std::size_t> shape, nb::handle owner) {
  return Array(data, shape.size(), shape.begin(), owner);
}

/// An array over the memory of a value that it takes over: no copy.
template <class Array, class Value>
Array own(Value&& value, std::initializer_list<std::size_t> shape) {
  auto* kept = new Value(std::move(value));
  const nb::capsule owner(kept,
                          [](void* pointer) noexcept { delete static_cast<Value*>(pointer); });
  return view<Array>(kept->data(), shape, owner);
}

/// [height, width]
template <class Array, class Pixel>
Array own_image(Image<Pixel>&& image) {
  return own<Array>(std::move(image), {static_cast<std::size_t>(image.height()),
                                       static_cast<std::size_t>(image.width())});
}

}  // namespace ovimap::python
