// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/description/piece_model.h"

#include <sentencepiece_processor.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

/// Bytes that have no piece are 256 pieces of their own, from the id 11 on.
nlohmann::json tokenizer() {
  nlohmann::json tokenizer = nlohmann::json::parse(R"({
    "added_tokens": [{"id": 0, "content": "<pad>", "special": true}, {"id": 1, "content": "<eos>", "special": true},
                     {"id": 2, "content": "<unk>", "special": true}, {"id": 3, "content": "<tag>", "special": false}],
    "model": {"type": "BPE", "unk_token": "<unk>", "byte_fallback": true,
      "vocab": {"<pad>": 0, "<eos>": 1, "<unk>": 2, "<tag>": 3, "x": 4, "a": 5, "b": 6, "c": 7, "ab": 8, "bc": 9,
                "y": 10},
      "merges": [["b", "c"], "a b"]}})");
  constexpr const char* kDigits = "0123456789ABCDEF";
  for (int byte = 0; byte < 256; ++byte)
    tokenizer["model"]["vocab"][concat("<0x", kDigits[byte / 16], kDigits[byte % 16], ">")] =
        11 + byte;
  return tokenizer;
}

TEST(PieceModel, MergesInTheOrderOfTheList) {
  sentencepiece::SentencePieceProcessor pieces;
  ASSERT_TRUE(pieces.LoadFromSerializedProto(piece_model(tokenizer())).ok());
  EXPECT_EQ(pieces.GetPieceSize(), 11 + 256);
  // "b c" is merged first, so that "ab" never comes to be.
  EXPECT_EQ(pieces.EncodeAsIds("abc"), (std::vector<int>{5, 9}));
  EXPECT_EQ(pieces.EncodeAsIds("ab"), (std::vector<int>{8}));
  EXPECT_EQ(pieces.EncodeAsIds("a<tag>A"),
            (std::vector<int>{5, 3, 11 + 'A'}));  // listed; by its byte
  EXPECT_EQ(pieces.PieceToId("<eos>"), 1);
  EXPECT_TRUE(pieces.IsControl(1));
  EXPECT_TRUE(pieces.IsUnknown(2));
}

TEST(PieceModel, RefusesGaps) {
  nlohmann::json gap = tokenizer();
  gap["model"]["vocab"]["y"] = 500;
  EXPECT_TRUE(contains(error_of([&] { piece_model(gap); }), "without a gap"));
}

}  // namespace
}  // namespace ovimap
