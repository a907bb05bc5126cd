// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/text/text_input.h"

#include <algorithm>

namespace ovimap {

std::vector<std::int64_t> text_ids(std::string_view text, const TextSpec& spec,
                                   const Tokenizer& tokenizer) {
  std::vector<std::int64_t> ids = tokenizer.encode(apply_text_rule(spec.rule, text));
  const std::size_t around = spec.begin_id.has_value() + spec.end_id.has_value();
  const std::size_t room = static_cast<std::size_t>(spec.context_length) - around;
  ids.resize(std::min(ids.size(), room));
  if (spec.begin_id) ids.insert(ids.begin(), *spec.begin_id);
  if (spec.end_id) ids.push_back(*spec.end_id);
  return ids;
}

IdBatch make_id_batch(std::span<const std::string> texts, const TextSpec& spec,
                      const Tokenizer& tokenizer) {
  std::vector<std::vector<std::int64_t>> rows;
  std::size_t length = spec.pad_to_context ? static_cast<std::size_t>(spec.context_length) : 1;
  for (const std::string& text : texts) {
    rows.push_back(text_ids(text, spec, tokenizer));
    length = std::max(length, rows.back().size());
  }
  const std::size_t count = rows.size() * length;
  IdBatch batch{{static_cast<std::int64_t>(rows.size()), static_cast<std::int64_t>(length)},
                std::vector<std::int64_t>(count, spec.pad_id),
                std::vector<std::int64_t>(count, 0),
                std::vector<std::int64_t>(count, 0)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t start = i * length + (spec.pad_left ? length - rows[i].size() : 0);
    const auto at = static_cast<std::ptrdiff_t>(start);
    std::copy(rows[i].begin(), rows[i].end(), batch.ids.begin() + at);
    std::fill_n(batch.mask.begin() + at, rows[i].size(), 1);
  }
  return batch;
}

}  // namespace ovimap
