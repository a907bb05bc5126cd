// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ovimap/hub/catalogue/catalogue.h"
#include "ovimap/hub/description/model_description.h"
#include "ovimap/hub/transfer/hub.h"
#include "ovimap/hub/trial/self_test.h"

namespace ovimap {

/// What is to be fetched of `entry` in that variant, as the hub lists it now. Throws Error naming
/// the variants there are where it has no such one, and where a file is missing that says how the
/// model is used.
FetchTarget find_target(const Hub& hub, const CatalogueEntry& entry, const std::string& variant);

/// Bytes of all that `target` fetches.
std::uint64_t bytes_of(const FetchTarget& target);

/// Where a fetched model goes: the first of `model_dirs`, else of $OVIMAP_MODELS, else of the
/// folders that are searched anyway but for what a package installed, else the user's data folder.
std::filesystem::path fetch_place(const std::vector<std::filesystem::path>& model_dirs);

struct FetchedModel {
  std::filesystem::path folder;
  bool was_there = false;  ///< nothing was fetched
  SelfTest test;
};

/// Called with all bytes that there are by now. False stops the fetch.
using TotalProgress = std::function<bool(std::uint64_t bytes, const std::string& file)>;

/// Fetches `target` into `place`/`name`. Files are gathered in `place`/.partial, where no model is
/// looked for; only when all have their digests, the model is described and its networks have run,
/// the whole is moved to its name at once. An older fetch of that name is replaced; a folder that
/// was not fetched is not. Throws Error, one line; what has come by then is gone on with.
FetchedModel fetch_model(const Hub& hub, const FetchTarget& target,
                         const std::filesystem::path& place, const std::string& name,
                         const TotalProgress& progress);

}  // namespace ovimap
