// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ovimap {

class ConfigFields;

/// Settings of reading a query-based network's answer (method section 2).
struct EntityConfig {
  float min_score = 0.5f;  ///< class probability times mean mask probability; lower is dropped
  float mask_probability = 0.5f;  ///< a pixel belongs to a query's mask above this
  int min_mask_px = 150;          ///< entities that show fewer colour pixels are dropped
};
void list_fields(EntityConfig& config, ConfigFields& fields);

}  // namespace ovimap
