// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ovimap/base/error.h"

namespace ovimap::python {

namespace {

using nb::dlpack::dtype_code;

std::string type_name(nb::dlpack::dtype type) {
  const char* kind = "opaque";
  switch (static_cast<dtype_code>(type.code)) {
    case dtype_code::Int:
      kind = "int";
      break;
    case dtype_code::UInt:
      kind = "uint";
      break;
    case dtype_code::Float:
      kind = "float";
      break;
    case dtype_code::Bfloat:
      kind = "bfloat";
      break;
    case dtype_code::Complex:
      kind = "complex";
      break;
    case dtype_code::Bool:
      return "bool";
    default:
      break;
  }
  return concat(kind, int{type.bits});
}

/// "uint8 [480, 640, 3]".
std::string array_text(const AnyArray& array) {
  std::string sizes;
  for (std::size_t i = 0; i < array.ndim(); ++i) sizes += concat(i > 0 ? ", " : "", array.shape(i));
  return type_name(array.dtype()) + " [" + sizes + "]";
}

[[noreturn]] void refuse_type(const std::string& name, const char* expected,
                              const std::string& came) {
  throw nb::type_error(concat(name, " must be ", expected, "; came ", came).c_str());
}

[[noreturn]] void refuse_value(const std::string& name, const std::string& expected,
                               const std::string& came) {
  throw nb::value_error(concat(name, " must be ", expected, "; came ", came).c_str());
}

bool on_processor(nb::handle object) {
  if (!nb::hasattr(object, "__dlpack_device__")) return true;
  const nb::object device = object.attr("__dlpack_device__")();
  return nb::cast<int>(nb::int_(device[0])) == nb::device::cpu::value;
}

/// " of >f4".
std::string type_of_elements(nb::handle object) {
  if (!nb::hasattr(object, "dtype")) return {};
  const nb::object type = object.attr("dtype");
  const nb::object name = nb::hasattr(type, "str") ? type.attr("str") : type;
  return concat(" of ", nb::cast<std::string>(nb::str(name)));
}

AnyArray array_of(nb::handle object, const std::string& name, const char* expected) {
  const std::string type = nb::cast<std::string>(nb::handle(object.type()).attr("__name__"));
  if (!on_processor(object))
    refuse_type(name, expected, "a " + type + " on another device; call .cpu() on it first");
  AnyArray array;
  if (object.is_none() || !nb::try_cast(object, array))
    refuse_type(name, expected,
                object.is_none()
                    ? "None"
                    : concat("a ", type, type_of_elements(object),
                             " that cannot be read as an array; give a NumPy array of plain "
                             "numbers in this machine's byte order, or a tensor that speaks "
                             "DLPack"));
  if (array.device_type() != nb::device::cpu::value)
    refuse_type(name, expected, "a " + type + " on another device; call .cpu() on it first");
  return array;
}

/// Calls `visit` with every element in row-major order, as From.
template <class From, class Visit>
void visit_elements(const AnyArray& array, const Visit& visit) {
  const auto* data = static_cast<const From*>(array.data());
  std::int64_t sizes[3] = {1, 1, 1}, strides[3] = {0, 0, 0};
  for (std::size_t i = 0; i < array.ndim(); ++i) {
    sizes[i] = static_cast<std::int64_t>(array.shape(i));
    strides[i] = array.stride(i);
  }
  for (std::int64_t i = 0; i < sizes[0]; ++i)
    for (std::int64_t j = 0; j < sizes[1]; ++j)
      for (std::int64_t k = 0; k < sizes[2]; ++k)
        visit(data[i * strides[0] + j * strides[1] + k * strides[2]]);
}

/// Whether the elements are of one of the types; if so, all are visited.
template <class... From, class Visit>
bool visit_if_any_of(const AnyArray& array, const Visit& visit) {
  return ((array.dtype() == nb::dtype<From>() && (visit_elements<From>(array, visit), true)) ||
          ...);
}

template <class Visit>
bool visit_integers(const AnyArray& array, const Visit& visit) {
  return visit_if_any_of<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t, std::int8_t,
                         std::int16_t, std::int32_t, std::int64_t>(array, visit);
}

template <class Visit>
bool visit_floats(const AnyArray& array, const Visit& visit) {
  return visit_if_any_of<float, double>(array, visit);
}

float valid_depth(double depth_m, float min_depth_m, float max_depth_m) {
  const auto depth = static_cast<float>(depth_m);
  return depth > 0 && depth >= min_depth_m && depth <= max_depth_m ? depth : 0.f;  // NaN: 0
}

}  // namespace

RgbImage read_color(nb::handle object, const char* name) {
  constexpr const char* kExpected = "uint8 [height, width, 3], red first";
  const AnyArray array = array_of(object, name, kExpected);
  if (array.dtype() != nb::dtype<std::uint8_t>()) refuse_type(name, kExpected, array_text(array));
  if (array.ndim() != 3 || array.shape(2) != 3) refuse_value(name, kExpected, array_text(array));
  RgbImage image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
  auto* out = reinterpret_cast<std::uint8_t*>(image.data());
  const auto* data = static_cast<const std::uint8_t*>(array.data());
  if (array.stride(2) == 1 && array.stride(1) == 3 &&
      array.stride(0) == 3 * static_cast<std::int64_t>(array.shape(1)))
    std::copy_n(data, array.size(), out);
  else
    visit_elements<std::uint8_t>(array, [&out](std::uint8_t value) { *out++ = value; });
  return image;
}

DepthImage read_depth(nb::handle object, std::optional<double> depth_scale, float min_depth_m,
                      float max_depth_m) {
  constexpr const char* kExpected =
      "float32 or float64 [height, width] in metres, or integers with depth_scale (how many are "
      "a metre)";
  const AnyArray array = array_of(object, "depth", kExpected);
  if (array.ndim() != 2) refuse_value("depth", kExpected, array_text(array));
  if (depth_scale && !(*depth_scale > 0 && std::isfinite(*depth_scale)))
    refuse_value("depth_scale", "above 0: stored values per metre", concat(*depth_scale));
  if (!(min_depth_m >= 0 && min_depth_m < max_depth_m))
    refuse_value("min_depth_m", "from 0 on and below max_depth_m",
                 concat(min_depth_m, " with max_depth_m ", max_depth_m));
  const double scale = depth_scale.value_or(1);
  DepthImage image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
  float* out = image.data();
  const auto store = [&](auto value) {
    *out++ = valid_depth(static_cast<double>(value) / scale, min_depth_m, max_depth_m);
  };
  if (visit_floats(array, store)) return image;
  if (!depth_scale || !visit_integers(array, store))
    refuse_type("depth", kExpected,
                array_text(array) + (depth_scale ? "" : " without depth_scale"));
  return image;
}

IdImage read_ids(nb::handle object, const std::string& name, int width, int height) {
  constexpr const char* kExpected = "integers or bool [height, width], 0 = no entity";
  const AnyArray array = array_of(object, name, kExpected);
  const std::string size = concat(" [", height, ", ", width, "], the size of the colour image");
  if (array.ndim() != 2 || static_cast<int>(array.shape(0)) != height ||
      static_cast<int>(array.shape(1)) != width)
    refuse_value(name, "integers or bool" + size, array_text(array));
  IdImage ids(width, height);
  std::uint16_t* out = ids.data();
  const auto store = [&](auto value) {
    if (value < 0 || static_cast<std::uint64_t>(value) > 65535)
      refuse_value(name, "ids from 0 to 65535", concat("the id ", +value));
    *out++ = static_cast<std::uint16_t>(value);
  };
  const auto store_bool = [&out](bool value) { *out++ = value ? 1 : 0; };
  if (!visit_integers(array, store) && !visit_if_any_of<bool>(array, store_bool))
    refuse_type(name, kExpected, array_text(array));
  return ids;
}

Picture read_picture(nb::handle object, const char* name) {
  constexpr const char* kExpected =
      "uint8 [height, width, 3], red first, or uint16 [height, width]";
  const AnyArray array = array_of(object, name, kExpected);
  if (array.ndim() == 3) return read_color(object, name);
  if (array.ndim() != 2) refuse_value(name, kExpected, array_text(array));
  Image<std::uint16_t> image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
  std::uint16_t* out = image.data();
  if (!visit_if_any_of<std::uint16_t>(array, [&out](std::uint16_t value) { *out++ = value; }))
    refuse_type(name, kExpected, array_text(array));
  return image;
}

Pose read_pose(nb::handle object, const char* name) {
  constexpr const char* kExpected = "float32 or float64 [4, 4], a rigid transform";
  const AnyArray array = array_of(object, name, kExpected);
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
    refuse_value(name, kExpected, array_text(array));
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix;
  double* out = matrix.data();
  const auto store = [&out](auto value) { *out++ = static_cast<double>(value); };
  if (!visit_floats(array, store) && !visit_integers(array, store))
    refuse_type(name, kExpected, array_text(array));
  if (const std::string fault = pose_fault(matrix); !fault.empty())
    refuse_value(name, kExpected, "a matrix that is none: " + fault);
  return rigid_pose(matrix);
}

Embeddings read_embeddings(nb::handle object, const std::string& name, std::size_t rows,
                           int dimension) {
  constexpr const char* kExpected = "float32 or float64 [rows, dimension]";
  const AnyArray array = array_of(object, name, kExpected);
  if (array.ndim() != 2 || array.shape(0) != rows ||
      array.shape(1) != static_cast<std::size_t>(dimension))
    refuse_value(name, concat("float32 or float64 [", rows, ", ", dimension, "]"),
                 array_text(array));
  Embeddings values(static_cast<Eigen::Index>(rows), dimension);
  float* out = values.data();
  if (!visit_floats(array, [&out](auto value) { *out++ = static_cast<float>(value); }))
    refuse_type(name, kExpected, array_text(array));
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const float length = values.row(i).norm();
    if (std::isfinite(length) && length > 0)
      values.row(i) /= length;
    else
      values.row(i).setZero();
  }
  return values;
}

std::optional<std::int64_t> read_integer(nb::handle object) {
  if (!PyIndex_Check(object.ptr())) return std::nullopt;
  const nb::object number = nb::steal(PyNumber_Index(object.ptr()));
  if (!number.is_valid()) {  // an array of more than one
    PyErr_Clear();
    return std::nullopt;
  }
  int overflow = 0;
  const std::int64_t value = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
  using Limits = std::numeric_limits<std::int64_t>;
  return overflow == 0 ? value : overflow > 0 ? Limits::max() : Limits::min();
}

EmbeddingArray to_array(Embeddings rows) {
  return own<EmbeddingArray>(std::move(rows), {static_cast<std::size_t>(rows.rows()),
                                               static_cast<std::size_t>(rows.cols())});
}

Matrix4 to_matrix(const Pose& pose) {
  using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  return own<Matrix4>(RowMajor(pose.matrix()), {4, 4});
}

}  // namespace ovimap::python
