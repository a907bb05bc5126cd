// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>

#include "ovimap/inference/encoders/image_text_encoder.h"

namespace ovimap::python {

namespace nb = nanobind;

/// Whether it is an encoder object of ours or of Python's making, not a name.
bool is_encoder_object(nb::handle encoder);

/// The encoder that Python named: None, a spec as make_image_text_encoder takes it, an
/// ImageTextEncoder, or an object with name, dimension and encode_images (and encode_texts). Throws
/// TypeError for anything else.
std::shared_ptr<ImageTextEncoder> to_encoder(nb::handle encoder);

}  // namespace ovimap::python
