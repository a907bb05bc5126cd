// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ovimap {

/// A tokenizer as ovimap's own ones take it, and how model.yaml describes it.
struct TokenizerFiles {
  std::string kind;                ///< "sentencepiece" or "clip_bpe"
  std::string text_rule;           ///< "siglip", "none" or "clip"
  std::vector<std::string> files;  ///< names in the folder: the model, or vocabulary and merges
  std::int64_t pad_id = 0;
  std::optional<std::int64_t> begin_id, end_id;
};

/// Reads tokenizer.json and tokenizer_config.json in `folder`, as transformers writes them, and
/// writes beside them what ovimap reads: vocab.json and merges.txt for CLIP, spiece.model for
/// Gemma's tokenizer, which SigLIP 2 has. SigLIP's spiece.model must be there and hold the same
/// pieces as tokenizer.json. Throws Error when it is another tokenizer or a file is damaged.
TokenizerFiles prepare_tokenizer(const std::filesystem::path& folder);

}  // namespace ovimap
