// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ovimap::apps {

/// Memory that is freed stays with the program, for what it allocates next. Opening a network takes
/// and returns large buffers, and having each of them cleared anew by the system is a fifth of a
/// short program's time. For programs that end soon.
void keep_freed_memory();

}  // namespace ovimap::apps
