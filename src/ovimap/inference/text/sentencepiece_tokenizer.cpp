// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <sentencepiece_processor.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "ovimap/base/error.h"
#include "ovimap/inference/text/tokenizer.h"
#include "ovimap/inference/text/unicode.h"

namespace ovimap {

namespace {

/// Reads the fields of a protocol buffer message one after another.
class ProtoReader {
 public:
  explicit ProtoReader(std::string_view message) : rest_(message) {}

  /// Moves to the next field; false at the end or where the message is damaged.
  bool next() {
    if (rest_.empty()) return false;
    const std::uint64_t tag = varint();
    field_ = tag >> 3;
    const std::uint64_t wire = tag & 7;
    if (wire == 0) {
      value_ = varint();
      return true;
    }
    const std::uint64_t size = wire == 1   ? 8
                               : wire == 5 ? 4
                               : wire == 2 ? varint()
                                           : rest_.size() + 1;
    if (size > rest_.size()) return false;
    bytes_ = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return true;
  }

  std::uint64_t field() const { return field_; }
  std::uint64_t value() const { return value_; }
  std::string_view bytes() const { return bytes_; }

 private:
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const auto byte = static_cast<std::uint8_t>(rest_.front());
      rest_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7F) << shift;
      if (byte < 0x80) break;
    }
    return value;
  }

  std::string_view rest_, bytes_;
  std::uint64_t field_ = 0, value_ = 0;
};

/// The pieces that are taken as they stand wherever they occur, longest first. The library has no
/// call for them; in its published format a model's field 1 is a piece, whose field 1 is the text
/// and field 3 the type, 4 for these.
std::vector<std::u32string> fixed_pieces(std::string_view model) {
  constexpr std::uint64_t kPiece = 1, kText = 1, kType = 3, kUserDefined = 4;
  std::vector<std::u32string> pieces;
  for (ProtoReader at(model); at.next();) {
    if (at.field() != kPiece) continue;
    std::string_view text;
    std::uint64_t type = 0;
    for (ProtoReader piece(at.bytes()); piece.next();) {
      if (piece.field() == kText) text = piece.bytes();
      if (piece.field() == kType) type = piece.value();
    }
    if (type == kUserDefined && !text.empty()) pieces.push_back(decode_utf8(text));
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return pieces;
}

class SentencePieceTokenizer : public Tokenizer {
 public:
  SentencePieceTokenizer(const std::filesystem::path& model, const SentencePieceOptions& options)
      : lowercase_(options.lowercase) {
    // The library complains on stderr about a missing file; it is not its place.
    const bool exists = std::filesystem::is_regular_file(model);
    const auto status = exists ? processor_.Load(model.string()) : sentencepiece::util::Status();
    if (!exists || !status.ok())
      throw Error(concat("tokenizer file ", model.string(), " ",
                         exists ? "is no SentencePiece model" : "does not exist",
                         "; fetch or export the model again"));
    if (options.keep_start) {
      lead_ = processor_.IdToPiece(processor_.unk_id());
      append_pieces(lead_, lead_ids_);
    }
    if (lowercase_) fixed_ = fixed_pieces(processor_.serialized_model_proto());
  }

  std::vector<std::int64_t> encode(std::string_view utf8) const override {
    const std::u32string text = decode_utf8(utf8);
    std::vector<std::int64_t> ids;
    if (lowercase_) {
      for (const std::u32string& stretch : lowered_stretches(text))
        append_pieces(encode_utf8(stretch), ids);
      return ids;
    }
    append_pieces(lead_ + encode_utf8(text), ids);
    // The library drops or adds spaces at the start of a text. Something that is cut off again
    // stands there instead, so that the text keeps those it has.
    const std::size_t skip = ids.size() >= lead_ids_.size() ? lead_ids_.size() : 0;
    return {ids.begin() + static_cast<std::ptrdiff_t>(skip), ids.end()};
  }

 private:
  void append_pieces(const std::string& text, std::vector<std::int64_t>& ids) const {
    std::vector<int> found;
    const auto status = processor_.Encode(text, &found);
    if (!status.ok()) throw Error(concat("a text cannot be tokenized (", status.message(), ")"));
    ids.insert(ids.end(), found.begin(), found.end());
  }

  /// The length of the fixed piece that `text` begins with; 0 when there is none.
  std::size_t fixed_length(std::u32string_view text) const {
    for (const std::u32string& piece : fixed_)
      if (text.starts_with(piece)) return piece.size();
    return 0;
  }

  /// The text in lower case, cut around fixed pieces, which are found before it is lowered, and
  /// where the library would take for one what only looks like it afterwards.
  std::vector<std::u32string> lowered_stretches(std::u32string_view text) const {
    const std::size_t longest = fixed_.empty() ? 0 : fixed_.front().size();
    std::vector<std::u32string> stretches(1);
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t length = fixed_length(text.substr(at));
      if (length > 0) {
        stretches.emplace_back(text.substr(at, length));
        stretches.emplace_back();
      } else {
        stretches.back() += lowered(text.substr(at, 1));
        if (fixed_length(lowered(text.substr(at, longest))) > 0) stretches.emplace_back();
      }
      at += std::max<std::size_t>(length, 1);
    }
    return stretches;
  }

  sentencepiece::SentencePieceProcessor processor_;
  bool lowercase_ = false;
  std::vector<std::u32string> fixed_;
  std::string lead_;
  std::vector<std::int64_t> lead_ids_;
};

}  // namespace

std::unique_ptr<Tokenizer> make_sentencepiece_tokenizer(const std::filesystem::path& model,
                                                        const SentencePieceOptions& options) {
  return std::make_unique<SentencePieceTokenizer>(model, options);
}

}  // namespace ovimap
