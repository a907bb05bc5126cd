// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace ovimap {

/// A tokenizer.json of byte-pair encoding with byte fallback (Gemma's) as a SentencePiece model
/// (sentencepiece_model.proto): a piece's score is the rank of the first merge that makes it, so
/// that the best-scored pair is the next merge in the list. Throws Error when its ids have gaps,
/// and nlohmann::json::exception when it has another form.
std::string piece_model(const nlohmann::json& tokenizer);

}  // namespace ovimap
