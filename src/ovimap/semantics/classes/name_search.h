// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/semantics/query/query_engine.h"

namespace ovimap {

/// The answer by names alone, for maps whose objects have no embeddings: what people called so, or
/// with more words ("tea pot" for "pot"), the shortest name first.
QueryAnswer find_by_name(const SearchIndex& index, const Query& query);

}  // namespace ovimap
