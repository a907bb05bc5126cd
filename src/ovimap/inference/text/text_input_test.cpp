// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/text/text_input.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

/// One id a byte.
class ByteTokenizer : public Tokenizer {
 public:
  std::vector<std::int64_t> encode(std::string_view utf8) const override {
    return {utf8.begin(), utf8.end()};
  }
};

using Ids = std::vector<std::int64_t>;

TextSpec framed() {
  TextSpec spec;
  spec.context_length = 5;
  spec.begin_id = 1;
  spec.end_id = 2;
  spec.pad_id = 9;
  return spec;
}

TEST(TextIds, CutsBetweenBeginAndEnd) {
  EXPECT_EQ(text_ids("ab", framed(), ByteTokenizer()), (Ids{1, 'a', 'b', 2}));
  EXPECT_EQ(text_ids("abcdef", framed(), ByteTokenizer()), (Ids{1, 'a', 'b', 'c', 2}));
  EXPECT_EQ(text_ids("", framed(), ByteTokenizer()), (Ids{1, 2}));
  TextSpec bare;
  bare.context_length = 2;
  EXPECT_EQ(text_ids("abc", bare, ByteTokenizer()), (Ids{'a', 'b'}));
}

TEST(TextIds, AppliesTheRuleFirst) {
  TextSpec spec = framed();
  spec.rule = TextRule::kClip;
  EXPECT_EQ(text_ids("A\t\tB", spec, ByteTokenizer()), (Ids{1, 'a', ' ', 'b', 2}));
}

TEST(IdBatch, PadsToTheLongest) {
  const std::vector<std::string> texts = {"a", "bcd", ""};
  const IdBatch batch = make_id_batch(texts, framed(), ByteTokenizer());
  EXPECT_EQ(batch.shape, (TensorShape{3, 5}));
  EXPECT_EQ(batch.ids, (Ids{1, 'a', 2, 9, 9, 1, 'b', 'c', 'd', 2, 1, 2, 9, 9, 9}));
  EXPECT_EQ(batch.mask, (Ids{1, 1, 1, 0, 0, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(batch.types, Ids(15, 0));
}

TEST(IdBatch, PadsToTheContextOnEitherSide) {
  TextSpec spec = framed();
  spec.pad_to_context = true;
  const std::vector<std::string> texts = {"a"};
  EXPECT_EQ(make_id_batch(texts, spec, ByteTokenizer()).ids, (Ids{1, 'a', 2, 9, 9}));
  spec.pad_left = true;
  const IdBatch left = make_id_batch(texts, spec, ByteTokenizer());
  EXPECT_EQ(left.ids, (Ids{9, 9, 1, 'a', 2}));
  EXPECT_EQ(left.mask, (Ids{0, 0, 1, 1, 1}));
}

TEST(IdBatch, AnEmptyRowStillHasALength) {
  TextSpec bare;
  bare.context_length = 4;
  const std::vector<std::string> texts = {""};
  const IdBatch batch = make_id_batch(texts, bare, ByteTokenizer());
  EXPECT_EQ(batch.shape, (TensorShape{1, 1}));
  EXPECT_EQ(batch.mask, Ids{0});
}

}  // namespace
}  // namespace ovimap
