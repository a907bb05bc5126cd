// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <queue>
#include <sstream>
#include <string>
#include <tuple>
#include <unordered_map>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/inference/text/tokenizer.h"
#include "ovimap/inference/text/unicode.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

constexpr const char* kUnknownToken = "<|endoftext|>";  // CLIP has no token of its own for it
constexpr const char* kWordEnd = "</w>";
constexpr std::array<std::u32string_view, 7> kContractions = {U"'s", U"'t",  U"'re", U"'ve",
                                                              U"'m", U"'ll", U"'d"};

using Vocabulary = std::unordered_map<std::string, std::int64_t>;

[[noreturn]] void tokenizer_fault(const fs::path& file, const std::string& what) {
  throw Error(
      concat("tokenizer file ", file.string(), " ", what, "; fetch or export the model again"));
}

Vocabulary read_vocabulary(const fs::path& file) {
  if (!fs::is_regular_file(file)) tokenizer_fault(file, "cannot be read");
  const nlohmann::json document = read_json(file, kLargeDocument);
  try {
    return document.get<Vocabulary>();
  } catch (const nlohmann::json::exception&) {
    tokenizer_fault(file, "is no JSON object of tokens and ids");
  }
}

/// How byte-level encodings write each byte as a printable character: those of Latin-1 that print
/// stand for themselves, the others, in order, for U+0100 and up.
std::array<std::string, 256> byte_names() {
  std::array<std::string, 256> names;
  char32_t next = 0x100;
  for (char32_t byte = 0; byte < 256; ++byte) {
    const bool prints = (byte > 0x20 && byte < 0x7F) || (byte > 0xA0 && byte != 0xAD);
    const char32_t name = prints ? byte : next++;
    names[byte] = encode_utf8({&name, 1});
  }
  return names;
}

std::uint64_t pair_key(std::int64_t left, std::int64_t right) {
  return static_cast<std::uint64_t>(left) << 32 | static_cast<std::uint64_t>(right);
}

struct Merge {
  std::int64_t rank = 0;  ///< lower is joined first
  std::int64_t joined = 0;
};

/// The length of the piece that `text` begins with, by CLIP's pattern: a contraction, a run of
/// letters, one digit, or a run of anything else. `text` does not begin with a space.
std::size_t piece_length(std::u32string_view text) {
  for (const std::u32string_view contraction : kContractions)
    if (text.starts_with(contraction)) return contraction.size();
  if (is_number(text[0])) return 1;
  const bool letters = is_letter(text[0]);
  std::size_t length = 1;
  while (length < text.size() && is_letter(text[length]) == letters && !is_number(text[length]) &&
         !is_space(text[length]))
    ++length;
  return length;
}

class ClipTokenizer : public Tokenizer {
 public:
  ClipTokenizer(const fs::path& vocabulary_file, const fs::path& merges_file) {
    const Vocabulary vocabulary = read_vocabulary(vocabulary_file);
    if (!vocabulary.contains(kUnknownToken))
      tokenizer_fault(vocabulary_file, concat("has no token ", kUnknownToken));
    for (const auto& [token, id] : vocabulary)
      if (id < 0 || id > 0x7FFFFFFF) tokenizer_fault(vocabulary_file, concat("gives id ", id));
    read_bytes(vocabulary);
    read_merges(vocabulary, merges_file);
  }

  std::vector<std::int64_t> encode(std::string_view utf8) const override {
    const std::u32string text = decode_utf8(utf8);
    std::vector<std::int64_t> ids;
    for (std::size_t at = 0; at < text.size();) {
      if (is_space(text[at])) {
        ++at;
        continue;
      }
      const std::u32string_view rest = std::u32string_view(text).substr(at);
      const std::size_t length = piece_length(rest);
      append_piece(encode_utf8(rest.substr(0, length)), ids);
      at += length;
    }
    return ids;
  }

 private:
  /// A token of the piece being encoded; joined ones form a list.
  struct Symbol {
    std::int64_t id;
    std::ptrdiff_t previous, next;  ///< -1 at the ends
    bool alive = true;
  };
  /// A pair that may be joined: rank, position of its left symbol, id when joined.
  using Candidate = std::tuple<std::int64_t, std::ptrdiff_t, std::int64_t>;
  using Candidates = std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>>;

  void read_bytes(const Vocabulary& vocabulary) {
    const std::array<std::string, 256> names = byte_names();
    const std::int64_t unknown = vocabulary.at(kUnknownToken);
    const auto id_of = [&](const std::string& token) {
      const auto found = vocabulary.find(token);
      return found == vocabulary.end() ? unknown : found->second;
    };
    for (std::size_t byte = 0; byte < names.size(); ++byte) {
      inner_[byte] = id_of(names[byte]);
      last_[byte] = id_of(names[byte] + kWordEnd);
    }
  }

  void read_merges(const Vocabulary& vocabulary, const fs::path& file) {
    std::ifstream in(file);
    if (!in) tokenizer_fault(file, "cannot be read");
    std::int64_t rank = 0;
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("#version") || line.empty() || line == "\r") continue;
      std::istringstream words(line);
      std::string left, right;
      words >> left >> right;
      const auto l = vocabulary.find(left), r = vocabulary.find(right),
                 joined = vocabulary.find(left + right);
      if (l == vocabulary.end() || r == vocabulary.end() || joined == vocabulary.end())
        tokenizer_fault(file, concat("joins '", line, "', which the vocabulary does not know"));
      merges_.try_emplace(pair_key(l->second, r->second), Merge{rank++, joined->second});
    }
  }

  void push_pair(const std::vector<Symbol>& symbols, std::ptrdiff_t left,
                 Candidates& candidates) const {
    if (left < 0) return;
    const Symbol& symbol = symbols[static_cast<std::size_t>(left)];
    if (symbol.next < 0) return;
    const auto found =
        merges_.find(pair_key(symbol.id, symbols[static_cast<std::size_t>(symbol.next)].id));
    if (found != merges_.end()) candidates.emplace(found->second.rank, left, found->second.joined);
  }

  /// False when one of the pair has been joined to another symbol in the meantime.
  bool is_current(const std::vector<Symbol>& symbols, std::ptrdiff_t at,
                  std::int64_t joined) const {
    const Symbol& symbol = symbols[static_cast<std::size_t>(at)];
    if (!symbol.alive || symbol.next < 0) return false;
    const auto found =
        merges_.find(pair_key(symbol.id, symbols[static_cast<std::size_t>(symbol.next)].id));
    return found != merges_.end() && found->second.joined == joined;
  }

  void join(std::vector<Symbol>& symbols, std::ptrdiff_t at, std::int64_t joined,
            Candidates& candidates) const {
    Symbol& left = symbols[static_cast<std::size_t>(at)];
    Symbol& right = symbols[static_cast<std::size_t>(left.next)];
    right.alive = false;
    left.id = joined;
    left.next = right.next;
    if (left.next >= 0) symbols[static_cast<std::size_t>(left.next)].previous = at;
    push_pair(symbols, left.previous, candidates);
    push_pair(symbols, at, candidates);
  }

  /// Joins the pair with the lowest rank, leftmost first, until none is left.
  void append_piece(std::string_view bytes, std::vector<std::int64_t>& ids) const {
    std::vector<Symbol> symbols;
    const auto count = static_cast<std::ptrdiff_t>(bytes.size());
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const auto byte = static_cast<std::uint8_t>(bytes[static_cast<std::size_t>(i)]);
      const bool is_last = i + 1 == count;
      symbols.push_back({is_last ? last_[byte] : inner_[byte], i - 1, is_last ? -1 : i + 1});
    }
    Candidates candidates;
    for (std::ptrdiff_t i = 0; i < count; ++i) push_pair(symbols, i, candidates);
    while (!candidates.empty()) {
      const auto [rank, at, joined] = candidates.top();
      candidates.pop();
      if (is_current(symbols, at, joined)) join(symbols, at, joined, candidates);
    }
    for (const Symbol& symbol : symbols)
      if (symbol.alive) ids.push_back(symbol.id);
  }

  std::array<std::int64_t, 256> inner_{}, last_{};  ///< ids of bytes within and at a word's end
  std::unordered_map<std::uint64_t, Merge> merges_;
};

}  // namespace

std::unique_ptr<Tokenizer> make_clip_tokenizer(const fs::path& vocabulary, const fs::path& merges) {
  return std::make_unique<ClipTokenizer>(vocabulary, merges);
}

}  // namespace ovimap
