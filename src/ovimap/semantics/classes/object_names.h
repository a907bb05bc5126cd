// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "ovimap/semantics/words/text_evidence.h"

namespace ovimap {

/// What to call an object: a household word, one for more kinds of things where several are near
/// ("seat"), or "object" where nothing is clear.
struct ObjectName {
  std::string word = kUnclear;
  float share = 0;  ///< of all that speaks for any household word, in [0, 1]

  static constexpr const char* kUnclear = "object";
  bool clear() const { return share > 0.f; }
};

/// A name for each object: the narrowest household word whose kinds together have at least
/// EvidenceConfig::name_share, or wide_name_share where they are many; or the name that a person
/// gave to what it resembles (taught_name_ratio).
std::vector<ObjectName> name_objects(const TextEvidence& evidence);

}  // namespace ovimap
