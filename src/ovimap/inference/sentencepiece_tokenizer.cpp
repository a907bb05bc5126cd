// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <sentencepiece_processor.h>

#include "ovimap/base/error.h"
#include "ovimap/inference/tokenizer.h"
#include "ovimap/inference/unicode.h"

namespace ovimap {

namespace {

class SentencePieceTokenizer : public Tokenizer {
 public:
  SentencePieceTokenizer(const std::filesystem::path& model, SentencePieceStart start) {
    // The library complains on stderr about a missing file; it is not its place.
    const bool exists = std::filesystem::is_regular_file(model);
    const auto status = exists ? processor_.Load(model.string()) : sentencepiece::util::Status();
    if (!exists || !status.ok())
      throw Error(concat("tokenizer file ", model.string(), " ",
                         exists ? "is no SentencePiece model" : "does not exist",
                         "; fetch or export the model again"));
    if (start == SentencePieceStart::kAsGiven) {
      lead_ = processor_.IdToPiece(processor_.unk_id());
      lead_size_ = pieces(lead_).size();
    }
  }

  std::vector<std::int64_t> encode(std::string_view utf8) const override {
    std::vector<int> ids = pieces(lead_ + encode_utf8(decode_utf8(utf8)));
    // The library drops or adds spaces at the start of a text. Something that is cut off again
    // stands there instead, so that the text keeps those it has.
    const std::size_t skip = ids.size() >= lead_size_ ? lead_size_ : 0;
    return {ids.begin() + static_cast<std::ptrdiff_t>(skip), ids.end()};
  }

 private:
  std::vector<int> pieces(const std::string& text) const {
    std::vector<int> ids;
    const auto status = processor_.Encode(text, &ids);
    if (!status.ok()) throw Error(concat("a text cannot be tokenized (", status.message(), ")"));
    return ids;
  }

  sentencepiece::SentencePieceProcessor processor_;
  std::string lead_;
  std::size_t lead_size_ = 0;
};

}  // namespace

std::unique_ptr<Tokenizer> make_sentencepiece_tokenizer(const std::filesystem::path& model,
                                                        SentencePieceStart start) {
  return std::make_unique<SentencePieceTokenizer>(model, start);
}

}  // namespace ovimap
