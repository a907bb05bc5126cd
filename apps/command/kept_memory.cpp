// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "kept_memory.h"

#include <limits>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace ovimap::apps {

void keep_freed_memory() {
#ifdef __GLIBC__
  ::mallopt(M_MMAP_MAX, 0);  // nothing that freeing would unmap
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

}  // namespace ovimap::apps
