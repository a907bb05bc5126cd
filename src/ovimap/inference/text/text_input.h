// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ovimap/inference/models/onnx_session.h"
#include "ovimap/inference/text/text_rules.h"
#include "ovimap/inference/text/tokenizer.h"

namespace ovimap {

/// How a text becomes the ids its network was trained on.
struct TextSpec {
  std::string tokenizer;  ///< "sentencepiece", "clip_bpe" or "wordpiece"
  TextRule rule = TextRule::kNone;
  bool lowercase = false;       ///< by the tokenizer; the rules but kNone include it
  int context_length = 0;       ///< longest sequence of ids, begin and end included
  bool pad_to_context = false;  ///< every sequence gets this length
  bool pad_left = false;        ///< else padded on the right
  std::int64_t pad_id = 0;
  std::optional<std::int64_t> begin_id, end_id;  ///< put around each text; kept when it is cut
};

/// The ids of `text` with begin and end around them, cut to the context length, not padded.
std::vector<std::int64_t> text_ids(std::string_view text, const TextSpec& spec,
                                   const Tokenizer& tokenizer);

/// What a text network takes: rows of ids, one a text, padded to one length.
struct IdBatch {
  TensorShape shape;  ///< [texts, length]
  std::vector<std::int64_t> ids;
  std::vector<std::int64_t> mask;   ///< 1 where an id is of the text, 0 where it pads
  std::vector<std::int64_t> types;  ///< all 0: there is one sentence a row
};
IdBatch make_id_batch(std::span<const std::string> texts, const TextSpec& spec,
                      const Tokenizer& tokenizer);

}  // namespace ovimap
