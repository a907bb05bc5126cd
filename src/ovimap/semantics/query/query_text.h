// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ovimap/inference/encoders/image_text_encoder.h"

namespace ovimap {

/// `text` without blanks around it, every run of blanks and line ends as one space. Throws Error
/// when nothing is left or more than `max_chars` characters (UTF-8) are.
std::string checked_query_text(std::string_view text, int max_chars);

/// "red chair, armchair" -> {"red chair", "armchair"}. Commas between double quotes do not
/// separate; the quotes are taken away. A quote that nothing closes is an inch mark. Empty terms
/// are left out.
std::vector<std::string> split_terms(std::string_view text);

/// The thing that a term asks for: "the chairs" and "all kitchen chairs" are "chair" and "kitchen
/// chair" (Concepts::singular_of), which is how things are known.
std::string thing_of_term(const std::string& term);

/// Whether a term asks for all things of a kind: "chairs", "all the mugs", "every book".
bool asks_for_all(const std::string& term);

/// Templates separated by |, each with one {} where the text goes: "a photo of a {}|a {}". Throws
/// Error when one has no {}.
std::vector<std::string> split_prompts(const std::string& templates);

/// What somebody asks, or a list that every program needs and may store.
enum class TextUse { kQuestion, kVocabulary };

/// [texts, dimension], rows of length 1: of each text, without its article where a template has
/// words of its own, the mean over all templates (Radford et al. 2021, section 3.1.4). A row is
/// zero where the network gave nothing finite.
Embeddings encode_prompted(ImageTextEncoder& encoder, std::span<const std::string> texts,
                           std::span<const std::string> templates,
                           TextUse use = TextUse::kQuestion);

}  // namespace ovimap
