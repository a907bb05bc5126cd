// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace ovimap {

class ConfigFields;

/// What becomes of people in frames.
enum class PeopleMode {
  kKeep,  ///< they are seen as everything else
  kDrop,  ///< they are taken out of each frame before anything else looks at it
};

/// Whom a detector finds, and which pixels are theirs.
struct PeopleConfig {
  PeopleMode mode = PeopleMode::kKeep;
  std::string detector = "nanodet";
  float min_score = 0.2f;  ///< of a detector's box
  bool mask_network =
      true;  ///< a network of --masks is asked for their outline, where it takes boxes
  float least_fill = 0.5f;  ///< such a mask must fill so much of the box's height and width, else
                            ///< depth is asked
  float margin_share = 0.03f;  ///< pixels around them that go as well, of the box's height
  float seed_m = 0.3f;         ///< by depth: the body is so near to the middle of the box,
  float reach_m = 0.8f;        ///< what is theirs reaches so far from that
  float step_share = 0.04f;    ///< over steps of at most so much of the depth
};
void list_fields(PeopleConfig& config, ConfigFields& fields);

}  // namespace ovimap
