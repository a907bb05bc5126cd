// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ovimap {

/// What a model made of pictures that were drawn for it.
struct SelfTest {
  bool batch_agrees = true;           ///< several items at once give what each gives alone
  int right = 0, asked = 0;           ///< drawn things told right
  std::string summary;                ///< one line for people
  std::vector<std::string> warnings;  ///< why it may not be what it says it is

  bool passed() const { return warnings.empty(); }
};

/// Runs the model in `folder`. An encoder gets plain colours and simple shapes with their names, of
/// which most must find each other; a sam network is asked for a drawn disc by a point in it.
/// Throws Error when the networks do not run or give what is not finite.
SelfTest self_test(const std::filesystem::path& folder);

}  // namespace ovimap
