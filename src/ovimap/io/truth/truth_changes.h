// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace ovimap {

/// What really became of a thing between two visits.
struct TrueChange {
  int visit = 2;             ///< the one that finds it so, from 1
  std::int32_t object = 0;   ///< instance of the truth, the same in all visits
  std::string kind;          ///< "moved", "removed" or "added"
  Eigen::AlignedBox3f from;  ///< where it was; empty: nowhere
  Eigen::AlignedBox3f to;    ///< where it is
};

/// Something that moves while a visit films it, as somebody who walks through.
struct TrueMover {
  int visit = 1;            ///< from 1
  std::int32_t object = 0;  ///< instance of the truth
};

/// The visits to a place (recordings in `folder`, in order) and what changed between them.
struct TrueChanges {
  std::vector<std::filesystem::path> visits;
  std::vector<TrueChange> changes;
  std::vector<TrueMover> moving;  ///< mostly nothing
};

/// Reads FOLDER/changes.json, as `ovimap synth --visits` writes it (docs/changes.md). Throws Error
/// naming the file and what is wrong with it.
TrueChanges load_true_changes(const std::filesystem::path& folder);

}  // namespace ovimap
