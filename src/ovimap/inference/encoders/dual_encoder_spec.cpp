// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/encoders/dual_encoder_spec.h"

#include <charconv>
#include <limits>
#include <utility>
#include <vector>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

[[noreturn]] void spec_fault(const ModelFolder& model, const std::string& what) {
  throw Error(concat("model file ", (model.folder / "model.yaml").string(), ": ", what));
}

const std::string* find_text(const ModelFolder& model, const std::string& key) {
  const auto found = model.extras.find(key);
  return found == model.extras.end() ? nullptr : &found->second;
}

const std::string& require_text(const ModelFolder& model, const std::string& key) {
  const std::string* text = find_text(model, key);
  if (!text)
    spec_fault(model, concat("'", key, "' is missing; a model of kind dual_encoder needs it"));
  return *text;
}

template <class Number>
std::optional<Number> find_number(const ModelFolder& model, const std::string& key) {
  const std::string* text = find_text(model, key);
  if (!text) return {};
  Number value{};
  const char* end = text->data() + text->size();
  const auto [stop, fail] = std::from_chars(text->data(), end, value);
  if (fail != std::errc() || stop != end)
    spec_fault(model, concat("'", key, "' is '", *text, "'; a number is accepted"));
  return value;
}

int require_count(const ModelFolder& model, const std::string& key) {
  require_text(model, key);
  const int count = *find_number<int>(model, key);
  if (count < 1) spec_fault(model, concat("'", key, "' is ", count, "; it must be at least 1"));
  return count;
}

std::optional<std::int64_t> find_id(const ModelFolder& model, const std::string& key) {
  const auto id = find_number<std::int64_t>(model, key);
  if (id && (*id < 0 || *id > std::numeric_limits<std::int32_t>::max()))
    spec_fault(model, concat("'", key, "' is ", *id, "; a token's id is accepted"));
  return id;
}

/// The value of a key that takes one of a few words; the first of them where it is absent.
template <class Value>
Value find_word(const ModelFolder& model, const std::string& key,
                const std::vector<std::pair<std::string, Value>>& words) {
  const std::string* given = find_text(model, key);
  if (!given) return words.front().second;
  std::string accepted;
  for (const auto& [word, value] : words) {
    if (word == *given) return value;
    accepted += (accepted.empty() ? "" : ", ") + word;
  }
  spec_fault(model, concat("'", key, "' is '", *given, "'; accepted is one of ", accepted));
}

bool find_flag(const ModelFolder& model, const std::string& key) {
  return find_word<bool>(model, key, {{"false", false}, {"true", true}});
}

TextSpec read_text_spec(const ModelFolder& model) {
  TextSpec spec;
  require_text(model, "tokenizer");
  spec.tokenizer = find_word<std::string>(
      model, "tokenizer",
      {{"sentencepiece", "sentencepiece"}, {"clip_bpe", "clip_bpe"}, {"wordpiece", "wordpiece"}});
  spec.rule = find_word<TextRule>(model, "text_rule",
                                  {{"none", TextRule::kNone},
                                   {"siglip", TextRule::kSiglip},
                                   {"clip", TextRule::kClip},
                                   {"bert", TextRule::kBert}});
  spec.lowercase = find_flag(model, "lowercase") && spec.rule == TextRule::kNone;
  if (spec.lowercase && spec.tokenizer != "sentencepiece")
    spec_fault(model, "'lowercase' without 'text_rule' is for the tokenizer sentencepiece only");
  spec.context_length = require_count(model, "context_length");
  spec.pad_to_context = find_flag(model, "pad_to_context");
  spec.pad_left = find_word<bool>(model, "pad_side", {{"right", false}, {"left", true}});
  spec.pad_id = find_id(model, "pad_id").value_or(0);
  spec.begin_id = find_id(model, "bos_id");
  spec.end_id = find_id(model, "eos_id");
  if (spec.context_length < spec.begin_id.has_value() + spec.end_id.has_value() + 1)
    spec_fault(model, "'context_length' leaves no room for a text between bos_id and eos_id");
  return spec;
}

/// A tokenizer's file, which must have a digest like the networks: ids decide what a text means.
std::filesystem::path tokenizer_file(const ModelFolder& model, const std::string& key) {
  const std::string& name = require_text(model, key);
  if (!model.sha256.contains(name))
    spec_fault(model,
               concat("'sha256' has no digest of ", name, ", which '", key, "' names; add it"));
  return model.folder / name;
}

}  // namespace

DualEncoderSpec read_dual_encoder_spec(const ModelFolder& model) {
  if (model.kind != "dual_encoder")
    throw Error(concat("model ", model.folder.string(), " is of kind '", model.kind,
                       "'; as an image-text encoder only kind dual_encoder is accepted"));
  if (model.input.size_px < 1)
    spec_fault(model, "'input' is missing; it says how images are prepared");
  DualEncoderSpec spec;
  spec.dimension = require_count(model, "embedding_dim");
  spec.text = read_text_spec(model);
  if (find_text(model, "items_at_once")) spec.items_at_once = require_count(model, "items_at_once");
  const auto scale = find_number<float>(model, "logit_scale");
  const auto bias = find_number<float>(model, "logit_bias");
  if (scale && bias) spec.calibration = MatchCalibration{*scale, *bias};
  if (const std::string* prompt = find_text(model, "prompt_template")) {
    if (prompt->find("{}") == std::string::npos)
      spec_fault(model,
                 concat("'prompt_template' is '", *prompt, "'; it needs {} where the name goes"));
    spec.prompt_template = *prompt;
  }
  return spec;
}

std::unique_ptr<Tokenizer> open_tokenizer(const ModelFolder& model, const TextSpec& spec) {
  if (spec.tokenizer == "sentencepiece")
    return make_sentencepiece_tokenizer(
        tokenizer_file(model, "tokenizer_model"),
        {.keep_start = spec.rule == TextRule::kSiglip, .lowercase = spec.lowercase});
  const std::filesystem::path vocabulary = tokenizer_file(model, "tokenizer_vocab");
  if (spec.tokenizer == "clip_bpe")
    return make_clip_tokenizer(vocabulary, tokenizer_file(model, "tokenizer_merges"));
  return make_wordpiece_tokenizer(vocabulary);
}

}  // namespace ovimap
