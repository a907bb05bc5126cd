// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace ovimap {

/// Bytes that this process may use, as it was when first asked: those of the machine or, where they
/// are less, what its control group (version 2) or its own limit of addresses allows.
std::size_t usable_memory();

}  // namespace ovimap
