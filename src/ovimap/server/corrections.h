// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ovimap/instance/instance_registry.h"

namespace ovimap {

enum class CorrectionKind { kRename, kMerge, kHide, kLock, kDelete };

/// "rename", "merge", "hide", "lock" or "delete".
const char* correction_name(CorrectionKind kind);
std::optional<CorrectionKind> correction_kind(const std::string& name);

/// What a person says of an object, against what mapping found.
struct Correction {
  CorrectionKind kind = CorrectionKind::kRename;
  InstanceId instance = 0;
  std::string name;     ///< rename: UTF-8; empty takes the name away
  InstanceId into = 0;  ///< merge: the object that stays
  bool on = true;       ///< hide, lock: false takes it back
};

/// Throws Error for a name that is too long or holds control characters.
void check_name(const std::string& name);

/// Where corrections are kept. Calls come one at a time.
class CorrectionStore {
 public:
  virtual ~CorrectionStore() = default;
  /// What it can keep; others are refused before they get here.
  virtual std::vector<CorrectionKind> kinds() const = 0;
  /// Returns when the correction is on disk. Throws Error when it could not be kept.
  virtual void append(const Correction& correction) = 0;
};

/// Keeps names, in the map file itself.
std::unique_ptr<CorrectionStore> corrections_in_map_file(const std::filesystem::path& map);

}  // namespace ovimap
