// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/description/piece_model.h"

#include <cstdint>
#include <map>
#include <unordered_map>

#include <nlohmann/json.hpp>

#include "ovimap/base/error.h"
#include "ovimap/inference/models/proto_writer.h"

namespace ovimap {

namespace {

using Json = nlohmann::json;

enum PieceType { kNormal = 1, kUnknown = 2, kControl = 3, kUserDefined = 4, kByte = 6 };

bool is_byte(const std::string& piece) {
  constexpr std::size_t kLength = 6;  // "<0x0A>"
  return piece.size() == kLength && piece.starts_with("<0x") && piece.ends_with(">");
}

std::unordered_map<std::string, std::size_t> merge_ranks(const Json& merges) {
  std::unordered_map<std::string, std::size_t> ranks;
  for (std::size_t rank = 0; rank < merges.size(); ++rank) {
    const Json& pair = merges[rank];
    std::string piece;
    if (pair.is_string()) {
      piece = pair.get<std::string>();
      if (const std::size_t blank = piece.find(' '); blank != std::string::npos)
        piece.erase(blank, 1);
    } else {
      piece = pair.at(0).get<std::string>() + pair.at(1).get<std::string>();
    }
    ranks.emplace(piece, rank);
  }
  return ranks;
}

/// Pieces by id; those that are listed apart with whether they are special.
struct Pieces {
  std::map<std::int64_t, std::string> by_id;
  std::map<std::int64_t, bool> special;
};

Pieces pieces_of(const Json& tokenizer) {
  Pieces pieces;
  for (const auto& [piece, id] : tokenizer.at("model").at("vocab").items())
    pieces.by_id[id.get<std::int64_t>()] = piece;
  for (const Json& token : tokenizer.at("added_tokens")) {
    const auto id = token.at("id").get<std::int64_t>();
    pieces.by_id[id] = token.at("content").get<std::string>();
    pieces.special[id] = token.at("special").get<bool>();
  }
  std::int64_t next = 0;
  for (const auto& [id, piece] : pieces.by_id)
    if (id != next++) throw Error("tokenizer.json: the ids are not 0, 1, 2, ... without a gap");
  return pieces;
}

PieceType type_of(const std::string& piece, std::int64_t id, const Pieces& pieces,
                  const std::string& unknown) {
  if (piece == unknown) return kUnknown;
  if (is_byte(piece)) return kByte;
  const auto listed = pieces.special.find(id);
  if (listed == pieces.special.end()) return kNormal;
  return listed->second ? kControl : kUserDefined;
}

}  // namespace

std::string piece_model(const Json& tokenizer) {
  const Json& model = tokenizer.at("model");
  const std::string unknown = model.at("unk_token").get<std::string>();
  const Json& vocabulary = model.at("vocab");
  const auto ranks = merge_ranks(model.at("merges"));
  const Pieces pieces = pieces_of(tokenizer);
  ProtoWriter whole;
  std::int64_t unknown_id = 0;
  for (const auto& [id, listed] : pieces.by_id) {
    // Gemma's conversion writes this byte as the character.
    const bool tab = listed == "\t" && !vocabulary.contains("<0x09>");
    const std::string piece = tab ? "<0x09>" : listed;
    const PieceType type = type_of(piece, id, pieces, unknown);
    if (type == kUnknown) unknown_id = id;
    const auto rank = ranks.find(piece);
    const float score =
        type == kUserDefined
            ? 0.f
            : -static_cast<float>(rank == ranks.end() ? ranks.size() : rank->second);
    whole.bytes(1, ProtoWriter().bytes(1, piece).real(2, score).number(3, type).text());
  }
  // Begin, end and padding are put around texts by model.yaml's ids: -1 here, none.
  constexpr int kModelType = 3, kVocabularySize = 4, kByteFallback = 35, kUnknownId = 40,
                kBeginId = 41, kEndId = 42, kPadId = 43, kBytePair = 2;
  const auto none = static_cast<std::uint64_t>(-1);
  whole.bytes(2, ProtoWriter()
                     .number(kModelType, kBytePair)
                     .number(kVocabularySize, pieces.by_id.size())
                     .number(kByteFallback, 1)
                     .number(kUnknownId, static_cast<std::uint64_t>(unknown_id))
                     .number(kBeginId, none)
                     .number(kEndId, none)
                     .number(kPadId, none)
                     .text());
  constexpr int kName = 1, kDummyPrefix = 3, kFewerBlanks = 4, kEscape = 5;
  whole.bytes(3, ProtoWriter()
                     .bytes(kName, "identity")
                     .number(kDummyPrefix, 0)
                     .number(kFewerBlanks, 0)
                     .number(kEscape, 1)
                     .text());
  return whole.text();
}

}  // namespace ovimap
