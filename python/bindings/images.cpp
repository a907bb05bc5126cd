// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/string.h>

#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "ovimap/image/codec.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

using GrayArray = nb::ndarray<nb::numpy, std::uint16_t, nb::ndim<2>>;

nb::bytes png_of(nb::handle image) {
  const Picture picture = read_picture(image, "image");
  Bytes png;
  {
    const WithoutGil release;
    png = std::visit([](const auto& pixels) { return encode_png(pixels); }, picture);
  }
  return nb::bytes(png.data(), png.size());
}

GrayArray values_of(const nb::bytes& png) {
  const auto* data = static_cast<const std::uint8_t*>(png.data());
  Image<std::uint16_t> values;
  {
    const WithoutGil release;
    values = decode_gray({data, png.size()}).values;
  }
  return own_image<GrayArray>(std::move(values));
}

}  // namespace

void bind_images(nb::module_& module) {
  module.def(
      "encode_png", &png_of, nb::arg("image").none(),
      nb::sig("def encode_png(image: object) -> bytes"),
      "The PNG of uint8 [height, width, 3], red first, or of uint16 [height, width] as stored "
      "(depth, ids): what readers of recordings take. Other threads run meanwhile.");
  module.def("decode_gray_png", &values_of, nb::arg("png"),
             "The values of a grey PNG of 8 or 16 bits as stored: uint16 [height, width]. Raises "
             "Error for a damaged one and one in colour.");
}

}  // namespace ovimap::python
