// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ovimap {

/// Version of the library, "0.2.0".
const char* version();

/// Commit it was built from, with "-dirty" when files differed; "unknown" outside a checkout.
const char* commit();

}  // namespace ovimap
