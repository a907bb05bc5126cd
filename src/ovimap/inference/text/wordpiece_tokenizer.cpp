// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <functional>
#include <string>
#include <unordered_map>

#include "ovimap/base/error.h"
#include "ovimap/inference/text/tokenizer.h"
#include "ovimap/inference/text/unicode.h"

namespace ovimap {

namespace {

constexpr std::size_t kMaxWordLength = 100;  // characters; the definition's limit
constexpr const char* kUnknown = "[UNK]";
constexpr std::string_view kContinuation = "##";

struct TextHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const {
    return std::hash<std::string_view>()(text);
  }
};
using TokenIds = std::unordered_map<std::string, std::int64_t, TextHash, std::equal_to<>>;

class WordPieceTokenizer : public Tokenizer {
 public:
  explicit WordPieceTokenizer(const std::filesystem::path& vocabulary) {
    std::ifstream file(vocabulary);
    if (!file)
      throw Error(concat("tokenizer file ", vocabulary.string(),
                         " cannot be read; fetch or export the model again"));
    std::int64_t id = 0;
    for (std::string line; std::getline(file, line); ++id) {
      if (line.ends_with('\r')) line.pop_back();
      if (line.starts_with(kContinuation))
        inner_[line.substr(kContinuation.size())] = id;
      else
        first_[line] = id;
    }
    const auto unknown = first_.find(kUnknown);
    if (unknown == first_.end())
      throw Error(concat("tokenizer file ", vocabulary.string(), " has no line ", kUnknown,
                         "; a WordPiece vocabulary has one token a line"));
    unknown_ = unknown->second;
  }

  std::vector<std::int64_t> encode(std::string_view utf8) const override {
    std::vector<std::int64_t> ids;
    std::u32string word;
    for (const char32_t c : decode_utf8(utf8)) {
      const bool alone = is_punctuation(c);
      if (!alone && !is_space(c)) {
        word += c;
        continue;
      }
      append_word(word, ids);
      word.clear();
      if (alone) append_word({&c, 1}, ids);
    }
    append_word(word, ids);
    return ids;
  }

 private:
  void append_word(std::u32string_view word, std::vector<std::int64_t>& ids) const {
    if (word.empty()) return;
    const std::size_t size_before = ids.size();
    bool known = word.size() <= kMaxWordLength;
    const std::string utf8 = known ? encode_utf8(word) : std::string();
    for (std::string_view rest = utf8; known && !rest.empty();) {
      const std::size_t length =
          append_longest_piece(rest, rest.size() == utf8.size() ? first_ : inner_, ids);
      known = length > 0;
      rest.remove_prefix(length);
    }
    if (known) return;
    ids.resize(size_before);
    ids.push_back(unknown_);
  }

  /// How many bytes of `rest` the piece covers; 0 when no piece fits. Tokens are whole characters,
  /// so a cut within one matches nothing.
  static std::size_t append_longest_piece(std::string_view rest, const TokenIds& pieces,
                                          std::vector<std::int64_t>& ids) {
    for (std::size_t length = rest.size(); length > 0; --length) {
      const auto found = pieces.find(rest.substr(0, length));
      if (found == pieces.end()) continue;
      ids.push_back(found->second);
      return length;
    }
    return 0;
  }

  TokenIds first_, inner_;  ///< of a word's beginning; of its rest, without the ##
  std::int64_t unknown_ = 0;
};

}  // namespace

std::unique_ptr<Tokenizer> make_wordpiece_tokenizer(const std::filesystem::path& vocabulary) {
  return std::make_unique<WordPieceTokenizer>(vocabulary);
}

}  // namespace ovimap
