// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/text/tokenizer.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "ovimap/inference/models/test_support.h"
#include "ovimap/inference/text/text_rules.h"

namespace ovimap {
namespace {

using Ids = std::vector<std::int64_t>;

// ----------------------------------------------------------------------------------------
// WordPiece

std::unique_ptr<Tokenizer> wordpiece(const fixture::TemporaryFolder& scratch,
                                     const std::string& lines) {
  scratch.write("vocab.txt", lines);
  return make_wordpiece_tokenizer(scratch.path() / "vocab.txt");
}

TEST(WordPiece, TakesTheLongestBeginning) {
  const fixture::TemporaryFolder scratch;
  const auto tokenizer =
      wordpiece(scratch, "[UNK]\nun\nunaff\n##aff\n##able\n##ab\n##le\n!\nmug\n##s\né\n##漢\n");
  EXPECT_EQ(tokenizer->encode("unaffable"), (Ids{2, 4}));  // not un ##aff ##able
  EXPECT_EQ(tokenizer->encode("  mug mugs\tmug\u3000mug\n"), (Ids{8, 8, 9, 8, 8}));
  EXPECT_EQ(tokenizer->encode("mug!!mug"), (Ids{8, 7, 7, 8}));
  EXPECT_EQ(tokenizer->encode("mugx mug x"), (Ids{0, 8, 0}));  // a word is known as a whole or not
  EXPECT_EQ(tokenizer->encode("é漢 é"), (Ids{10, 11, 10}));
  EXPECT_EQ(tokenizer->encode("MUG"), Ids{0});  // lowering is the rule's work
  EXPECT_EQ(tokenizer->encode(""), Ids{});
}

TEST(WordPiece, WordsOver100CharactersAreUnknown) {
  const fixture::TemporaryFolder scratch;
  const auto tokenizer = wordpiece(scratch, "[UNK]\né\n##é\n");
  std::string word;
  for (int i = 0; i < 100; ++i) word += "é";
  EXPECT_EQ(tokenizer->encode(word).size(), 100u);
  EXPECT_EQ(tokenizer->encode(word + "é"), Ids{0});
}

TEST(WordPiece, RefusesBadFiles) {
  const fixture::TemporaryFolder scratch;
  EXPECT_TRUE(contains(error_of([&] { wordpiece(scratch, "a\nb\n"); }), "no line [UNK]"));
  EXPECT_TRUE(contains(error_of([&] { make_wordpiece_tokenizer(scratch.path() / "absent"); }),
                       "cannot be read"));
}

// ---------------------------------------------------------------------------------------------
// CLIP

std::unique_ptr<Tokenizer> clip(const fixture::TemporaryFolder& scratch,
                                const nlohmann::json& vocabulary, const std::string& merges) {
  scratch.write("vocab.json", vocabulary.dump());
  scratch.write("merges.txt", merges);
  return make_clip_tokenizer(scratch.path() / "vocab.json", scratch.path() / "merges.txt");
}

const nlohmann::json kWords = {{"<|endoftext|>", 0},
                               {"l", 1},
                               {"o", 2},
                               {"w", 3},
                               {"w</w>", 4},
                               {"lo", 5},
                               {"low</w>", 6},
                               {"e", 7},
                               {"r</w>", 8},
                               {"er</w>", 9},
                               {"!", 10},
                               {"!</w>", 11},
                               {"'", 12},
                               {"s</w>", 13},
                               {"'s</w>", 14},
                               {"1</w>", 15},
                               {"2</w>", 16},
                               {"Ã", 17},
                               {"©</w>", 18},
                               {"'</w>", 19},
                               {"Ġ", 20}};
constexpr const char* kMerges = "#version: 0.2\nl o\nlo w</w>\ne r</w>\n' s</w>\n";

TEST(Clip, JoinsPairsInTheirOrder) {
  const fixture::TemporaryFolder scratch;
  const auto tokenizer = clip(scratch, kWords, kMerges);
  EXPECT_EQ(tokenizer->encode("low"), Ids{6});
  EXPECT_EQ(tokenizer->encode("lower"), (Ids{5, 3, 9}));  // w and w</w> are different
  EXPECT_EQ(tokenizer->encode(""), Ids{});
  EXPECT_EQ(tokenizer->encode("  "), Ids{});
}

TEST(Clip, CutsTheTextIntoPieces) {
  const fixture::TemporaryFolder scratch;
  const auto tokenizer = clip(scratch, kWords, kMerges);
  EXPECT_EQ(tokenizer->encode("low's low"), (Ids{6, 14, 6}));
  EXPECT_EQ(tokenizer->encode("12low!!"), (Ids{15, 16, 6, 10, 11}));  // each digit alone
  EXPECT_EQ(tokenizer->encode("!'s"), (Ids{10, 19, 13}));  // the run of marks comes first
  EXPECT_EQ(tokenizer->encode("é"), (Ids{17, 18}));        // two bytes
  EXPECT_EQ(tokenizer->encode("q"), Ids{0});
}

/// The definition: the adjacent pair of lowest rank is joined, leftmost first, until none is left.
Ids naive_pairs(const std::string& word, const std::map<std::string, std::int64_t>& ids,
                const std::map<std::pair<std::string, std::string>, int>& ranks) {
  std::vector<std::string> parts;
  for (const char c : word) parts.emplace_back(1, c);
  parts.back() += "</w>";
  for (;;) {
    int best = static_cast<int>(ranks.size());
    std::size_t at = 0;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
      const auto found = ranks.find({parts[i], parts[i + 1]});
      if (found == ranks.end() || found->second >= best) continue;
      best = found->second;
      at = i;
    }
    if (best == static_cast<int>(ranks.size())) break;
    parts[at] += parts[at + 1];
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(at) + 1);
  }
  Ids result;
  for (const std::string& part : parts) result.push_back(ids.at(part));
  return result;
}

TEST(Clip, AgreesWithTheDefinitionOnRandomMerges) {
  std::mt19937 random(11);
  const fixture::TemporaryFolder scratch;
  for (int round = 0; round < 20; ++round) {
    std::map<std::string, std::int64_t> ids = {{"<|endoftext|>", 0}};
    std::vector<std::string> tokens;
    const auto add = [&](const std::string& token) {
      if (ids.try_emplace(token, static_cast<std::int64_t>(ids.size())).second)
        tokens.push_back(token);
    };
    for (const char* token : {"a", "b", "c", "a</w>", "b</w>", "c</w>"}) add(token);
    std::map<std::pair<std::string, std::string>, int> ranks;
    std::string merges;
    while (ranks.size() < 25) {
      const std::string left = tokens[random() % tokens.size()],
                        right = tokens[random() % tokens.size()];
      if (left.ends_with("</w>") ||
          !ranks.try_emplace({left, right}, static_cast<int>(ranks.size())).second)
        continue;
      add(left + right);
      merges += left + " " + right + "\n";
    }
    const auto tokenizer = clip(scratch, ids, merges);
    for (int i = 0; i < 20; ++i) {
      std::string word;
      for (std::size_t n = 1 + random() % 40; n > 0; --n) word += "abc"[random() % 3];
      ASSERT_EQ(tokenizer->encode(word), naive_pairs(word, ids, ranks)) << word;
    }
  }
}

TEST(Clip, OneWordOfManyCharactersIsJoinedToo) {
  const fixture::TemporaryFolder scratch;
  const auto tokenizer =
      clip(scratch, {{"<|endoftext|>", 0}, {"a", 1}, {"a</w>", 2}, {"aa", 3}, {"aaaa", 4}},
           "a a\naa aa\n");
  Ids expected(2499, 4);  // 9999 inner characters: 2499 fours, a pair, one left, and the last
  expected.insert(expected.end(), {3, 1, 2});
  EXPECT_EQ(tokenizer->encode(std::string(10000, 'a')), expected);
}

TEST(Clip, RefusesFilesThatDoNotFit) {
  const fixture::TemporaryFolder scratch;
  EXPECT_TRUE(contains(error_of([&] { clip(scratch, kWords, "l o\nx y\n"); }), "joins 'x y'"));
  EXPECT_TRUE(contains(error_of([&] { clip(scratch, {{"a", 1}}, ""); }), "no token <|endoftext|>"));
  EXPECT_TRUE(contains(error_of([&] { clip(scratch, {1, 2}, ""); }), "no JSON object"));
  EXPECT_TRUE(contains(
      error_of([&] { make_clip_tokenizer(scratch.path() / "absent", scratch.path() / "x"); }),
      "cannot be read"));
}

// ------------------------------------------------------------------------------------
// SentencePiece

const std::filesystem::path kUnigram = inference_testdata() / "golden_siglip/spiece.model";
const std::filesystem::path kBytePairs = inference_testdata() / "golden_siglip2/spiece.model";

TEST(SentencePiece, KeepsTheStartWhenAsked) {
  const auto plain = make_sentencepiece_tokenizer(kUnigram, {});
  const auto kept = make_sentencepiece_tokenizer(kUnigram, {.keep_start = true});
  const Ids cat = plain->encode("a red mug");
  EXPECT_EQ(plain->encode("   a red mug"), cat);  // the model drops spaces
  EXPECT_EQ(kept->encode("▁a red mug"), cat);
  EXPECT_EQ(kept->encode("▁ a red mug").size(), cat.size() + 1);  // a space of its own
  EXPECT_EQ(kept->encode("▁"), Ids{});
}

TEST(SentencePiece, FixedPiecesAreFoundBeforeLowering) {
  const auto tokenizer = make_sentencepiece_tokenizer(kBytePairs, {.lowercase = true});
  EXPECT_EQ(tokenizer->encode("A Red MUG"), tokenizer->encode("a red mug"));
  EXPECT_EQ(tokenizer->encode("<table>").size(), 1u);
  EXPECT_GT(tokenizer->encode("<TABLE>").size(), 1u);
  Ids both = tokenizer->encode("<TABLE>");
  both.push_back(tokenizer->encode("<table>").front());
  EXPECT_EQ(tokenizer->encode("<TABLE><table>"), both);
}

TEST(SentencePiece, RefusesBadFiles) {
  const fixture::TemporaryFolder scratch;
  scratch.write("model", "not a model");
  EXPECT_TRUE(contains(
      error_of([&] { make_sentencepiece_tokenizer(scratch.path() / "model", {}); }), "is no"));
  EXPECT_TRUE(
      contains(error_of([&] { make_sentencepiece_tokenizer(scratch.path() / "absent", {}); }),
               "does not exist"));
}

// ---------------------------------------------------------------------------------------- all
// kinds

TEST(Tokenizers, AnyBytesAreAccepted) {
  const fixture::TemporaryFolder scratch;
  std::vector<std::unique_ptr<Tokenizer>> tokenizers;
  tokenizers.push_back(make_sentencepiece_tokenizer(kUnigram, {.keep_start = true}));
  tokenizers.push_back(make_sentencepiece_tokenizer(kBytePairs, {.lowercase = true}));
  tokenizers.push_back(clip(scratch, kWords, kMerges));
  tokenizers.push_back(wordpiece(scratch, "[UNK]\na\n##b\n"));
  std::mt19937 random(17);
  for (int round = 0; round < 500; ++round) {
    std::string bytes;
    // Half of the texts are mostly ASCII, so that longer tokens occur as well.
    for (std::size_t n = random() % 200; n > 0; --n)
      bytes += static_cast<char>(round % 2       ? random() % 256
                                 : random() % 10 ? random() % 128
                                                 : 0xE2);
    for (const TextRule rule :
         {TextRule::kNone, TextRule::kSiglip, TextRule::kClip, TextRule::kBert})
      for (const auto& tokenizer : tokenizers) {
        const Ids raw = tokenizer->encode(bytes);
        EXPECT_TRUE(raw.empty() || *std::min_element(raw.begin(), raw.end()) >= 0);
        const std::string ruled = apply_text_rule(rule, bytes);
        EXPECT_EQ(apply_text_rule(TextRule::kNone, ruled), ruled);  // valid UTF-8
        EXPECT_LE(tokenizer->encode(ruled).size(), ruled.size() + 1);
      }
  }
}

}  // namespace
}  // namespace ovimap
