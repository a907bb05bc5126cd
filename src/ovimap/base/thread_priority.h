// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ovimap {

/// Lets other threads of the machine go first from now on. Threads that this one starts inherit it.
/// Without effect where the system has no priorities for threads.
void lower_thread_priority();

}  // namespace ovimap
