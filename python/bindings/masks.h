// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>

#include "ovimap/inference/masks/mask_source.h"

namespace ovimap::python {

namespace nb = nanobind;

/// The mask source that Python named: None, a spec as make_mask_source takes it, a MaskSource, or a
/// callable of (frame, prompts). Throws TypeError for anything else.
std::shared_ptr<MaskSource> to_masks(nb::handle masks);

}  // namespace ovimap::python
