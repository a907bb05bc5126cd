// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/description/tokenizer_files.h"

#include <sentencepiece_processor.h>

#include <map>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/hub/description/piece_model.h"
#include "ovimap/hub/description/refusal.h"
#include "ovimap/image/codec.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;

constexpr const char* kPieces = "spiece.model";
constexpr const char* kVocabulary = "vocab.json";
constexpr const char* kMerges = "merges.txt";

/// A token as settings name it: "</s>" or {"content": "</s>", ...}.
std::string token_text(const Json& settings, const char* key) {
  if (!settings.contains(key)) return "";
  const Json& token = settings[key];
  if (token.is_object()) return token.at("content").get<std::string>();
  return token.is_string() ? token.get<std::string>() : "";
}

/// tokenizer.json, and the ids of its tokens.
struct Backend {
  fs::path file;
  Json all;
  std::map<std::string, std::int64_t> added;  ///< tokens beside the model's own

  const Json& model() const { return all.at("model"); }
  std::int64_t id_of(const std::string& token) const {
    if (const auto found = added.find(token); found != added.end()) return found->second;
    const Json& vocabulary = model().at("vocab");
    if (vocabulary.is_object() && vocabulary.contains(token)) return vocabulary[token].get<int>();
    if (vocabulary.is_array())
      for (std::size_t i = 0; i < vocabulary.size(); ++i)
        if (vocabulary[i].at(0) == token) return static_cast<std::int64_t>(i);
    refuse_model(file, concat("it has no token '", token, "', which the settings name"));
  }
};

Backend read_backend(const fs::path& file) {
  Backend backend{file, read_json(file, kLargeDocument), {}};
  for (const Json& token : backend.all.value("added_tokens", Json::array()))
    backend.added[token.at("content").get<std::string>()] = token.at("id").get<std::int64_t>();
  return backend;
}

/// The ids that a post-processor puts before and after a text.
void read_post_processor(const Json& processor, const fs::path& file, TokenizerFiles& tokens) {
  if (processor.is_null()) return;
  const std::string type = processor.at("type").get<std::string>();
  if (type == "Sequence") {
    for (const Json& part : processor.at("processors")) read_post_processor(part, file, tokens);
  } else if (type == "RobertaProcessing" || type == "BertProcessing") {
    tokens.begin_id = processor.at("cls").at(1).get<std::int64_t>();
    tokens.end_id = processor.at("sep").at(1).get<std::int64_t>();
  } else if (type == "TemplateProcessing") {
    bool before = true;
    for (const Json& part : processor.at("single")) {
      if (part.contains("Sequence")) {
        before = false;
        continue;
      }
      const std::string name = part.at("SpecialToken").at("id").get<std::string>();
      auto& id = before ? tokens.begin_id : tokens.end_id;
      if (id) refuse_model(file, "it puts more than one token before or after a text");
      id = processor.at("special_tokens").at(name).at("ids").at(0).get<std::int64_t>();
    }
  }
}

/// Gemma's tokenizer goes by its settings, whatever tokenizer.json has.
void read_gemma_ends(const Json& settings, const Backend& backend, TokenizerFiles& tokens) {
  const auto end = [&](const char* key, const char* token, std::optional<std::int64_t>& id) {
    if (!settings.contains(key) || !settings[key].is_boolean()) return;
    id.reset();
    if (settings[key].get<bool>()) id = backend.id_of(token_text(settings, token));
  };
  end("add_bos_token", "bos_token", tokens.begin_id);
  end("add_eos_token", "eos_token", tokens.end_id);
}

void write_clip(const fs::path& folder, const Backend& backend) {
  std::string merges = "#version: 0.2\n";
  for (const Json& pair : backend.model().at("merges"))
    merges +=
        (pair.is_string() ? pair.get<std::string>()
                          : pair.at(0).get<std::string>() + " " + pair.at(1).get<std::string>()) +
        "\n";
  write_text(folder / kMerges, merges);
  write_text(folder / kVocabulary, backend.model().at("vocab").dump());
}

/// SigLIP's SentencePiece model is used as it is; that it is the one of tokenizer.json is checked.
void check_unigram(const fs::path& folder, const Backend& backend) {
  const fs::path file = folder / kPieces;
  if (!fs::is_regular_file(file)) refuse_model(file, "it is missing in the repository");
  sentencepiece::SentencePieceProcessor pieces;
  if (!pieces.Load(file.string()).ok()) refuse_model(file, "it is no SentencePiece model");
  const Json& vocabulary = backend.model().at("vocab");
  for (int id = 0; id < pieces.GetPieceSize(); ++id)
    if (!pieces.IsControl(id) && !pieces.IsUnknown(id) &&
        (static_cast<std::size_t>(id) >= vocabulary.size() ||
         vocabulary[static_cast<std::size_t>(id)].at(0) != pieces.IdToPiece(id)))
      refuse_model(file, concat("its piece ", id, " is '", pieces.IdToPiece(id),
                                "', while tokenizer.json has another"));
}

void read_kind(const fs::path& folder, const Backend& backend, const Json& settings,
               TokenizerFiles& tokens) {
  const Json& model = backend.model();
  const std::string type = model.at("type").get<std::string>();
  if (type == "Unigram") {
    tokens.kind = "sentencepiece", tokens.text_rule = "siglip", tokens.files = {kPieces};
    check_unigram(folder, backend);
  } else if (type == "BPE" && model.value("byte_fallback", false)) {
    tokens.kind = "sentencepiece", tokens.text_rule = "none", tokens.files = {kPieces};
    read_gemma_ends(settings, backend, tokens);
    write_text(folder / kPieces, piece_model(backend.all));
  } else if (type == "BPE" && model.contains("end_of_word_suffix") &&
             model["end_of_word_suffix"] == "</w>") {
    tokens.kind = "clip_bpe", tokens.text_rule = "clip", tokens.files = {kVocabulary, kMerges};
    write_clip(folder, backend);
  } else {
    refuse_model(backend.file, concat("its tokenizer, ", type,
                                      ", is none of SigLIP's, SigLIP 2's and "
                                      "CLIP's"));
  }
}

}  // namespace

TokenizerFiles prepare_tokenizer(const fs::path& folder) {
  const fs::path file = folder / "tokenizer.json", config = folder / "tokenizer_config.json";
  try {
    const Backend backend = read_backend(file);
    const Json settings = read_json(config, kLargeDocument);
    TokenizerFiles tokens;
    read_post_processor(backend.all.value("post_processor", Json()), file, tokens);
    read_kind(folder, backend, settings, tokens);
    const std::string pad = token_text(settings, "pad_token");
    if (pad.empty()) refuse_model(config, "it names no 'pad_token'");
    tokens.pad_id = backend.id_of(pad);
    return tokens;
  } catch (const Json::exception& error) {
    refuse_model(file, concat("it is not what transformers writes (", error.what(), ")"));
  }
}

}  // namespace ovimap
