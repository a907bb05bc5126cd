// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

namespace ovimap {

/// Cuts a text into the tokens a text network was trained on. Calls are thread-safe.
class Tokenizer {
 public:
  virtual ~Tokenizer() = default;
  /// Ids of the text alone: nothing is put around it, nothing cut off. Any bytes are accepted; a
  /// special token spelled out in the text is text like any other.
  virtual std::vector<std::int64_t> encode(std::string_view utf8) const = 0;
};

struct SentencePieceOptions {
  /// The text begins with its own U+2581 (TextRule::kSiglip); else the model's own rule for spaces
  /// at the start holds.
  bool keep_start = false;
  bool lowercase = false;  ///< character by character, but for pieces the model has as they are
};

/// A SentencePiece model (unigram or byte-pair), run by its own library. Throws Error when `model`
/// is none.
std::unique_ptr<Tokenizer> make_sentencepiece_tokenizer(const std::filesystem::path& model,
                                                        const SentencePieceOptions& options);

/// CLIP's byte-level byte-pair encoding (Radford et al. 2021): `vocabulary` maps tokens to ids
/// (JSON), `merges` lists the pairs that are joined, most frequent first. Takes text after
/// TextRule::kClip. Throws Error when a file is missing or the two do not fit together.
std::unique_ptr<Tokenizer> make_clip_tokenizer(const std::filesystem::path& vocabulary,
                                               const std::filesystem::path& merges);

/// BERT's WordPiece (Devlin et al. 2019): the longest known beginning of each word, then of its
/// rest. `vocabulary` has one token a line. Takes text after TextRule::kBert. Throws Error when the
/// file is missing or lacks [UNK].
std::unique_ptr<Tokenizer> make_wordpiece_tokenizer(const std::filesystem::path& vocabulary);

}  // namespace ovimap
