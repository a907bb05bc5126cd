// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "query_asking.h"

#include <algorithm>
#include <future>

#include "ovimap/image/codec.h"
#include "ovimap/pipeline/search/teaching.h"
#include "ovimap/semantics/classes/name_search.h"
#include "ovimap/semantics/classes/object_names.h"
#include "ovimap/semantics/query/query_grammar.h"
#include "ovimap/semantics/query/query_text.h"

namespace ovimap::apps {

namespace {

/// What each object is called: as a person named it, else a word that is clear, else "object".
std::vector<std::string> titles_of(const SearchIndex& index, const QueryEngine* engine) {
  std::vector<std::string> titles;
  for (const SearchObject& object : index.objects()) titles.push_back(object.name);
  if (!engine || !engine->matcher() || !engine->matcher()->evidence()) return titles;
  const std::vector<ObjectName> names = name_objects(*engine->matcher()->evidence());
  for (std::size_t i = 0; i < titles.size(); ++i)
    if (titles[i].empty() && index.has_embedding(i)) titles[i] = names[i].word;
  return titles;
}

/// "TEXT near THIS". A text with a place of its own would tie `near` to that place.
std::string near_to(const std::string& text, const std::string& near) {
  if (near.empty()) return text;
  if (parse_query(text).relation)
    throw Error(concat("'", text, "' says where to look already; leave --near '", near,
                       "' out, or ask for the thing alone"));
  return text + " near " + near;
}

}  // namespace

std::vector<AskedText> asked_texts(const QueryOptions& options, const QueryConfig& config) {
  const bool timed = !options.at.empty() || !options.since.empty();
  std::vector<std::string> texts;
  for (const std::string& text : options.texts)
    texts.push_back(near_to(checked_query_text(text, config.max_text_chars), options.near));
  if (texts.empty() && timed) texts = {""};  // all of that time
  std::vector<AskedText> asked;
  for (const std::string& text : texts) {
    AskedText& next = asked.emplace_back(AskedText{text, std::nullopt});
    if (config.grammar || timed)
      next.past = history_of_question(text, options.at, options.since, seconds_now());
  }
  return asked;
}

std::vector<Answered> QueryAsker::ask(const std::vector<AskedText>& texts) {
  open(texts);
  std::vector<Answered> answers;
  for (const AskedText& asked : texts) {
    if (asked.past)
      answers.push_back(ask_past(asked));
    else if (search_.index.embedded() == 0)
      answers.push_back(ask_names(asked.text));
    else
      answers.push_back(in_present(present().find({asked.text, options_.negatives, relevance()})));
  }
  for (const std::filesystem::path& image : options_.images)
    answers.push_back(
        in_present(present().find_like(read_rgb(image), image.string(), relevance())));
  for (const InstanceId id : options_.like)
    answers.push_back(in_present(present().find_like(id, relevance())));
  return answers;
}

MapSearch QueryAsker::open_map() const {
  MapSearch search = open_map_search(options_.map);
  search.scene.taught = taught_elsewhere(options_.teach.file(), options_.map, search.info.encoder);
  return search;
}

/// The map and its encoder take about as long, so both are opened at once. Of a map without
/// embeddings one can ask what changed, and what people gave names to.
void QueryAsker::open(const std::vector<AskedText>& texts) {
  const auto is_listing = [&](const AskedText& asked) {
    return asked.past && asked.past->text == "anything" && options_.negatives.empty();
  };
  const bool listing = !texts.empty() && std::all_of(texts.begin(), texts.end(), is_listing);
  const bool in_words = !(texts.empty() && options_.images.empty());
  auto opening = std::async(std::launch::async, [this] { return open_map(); });
  std::exception_ptr fault;
  try {
    if (in_words) open_encoder();
  } catch (const std::exception&) {
    fault = std::current_exception();
  }
  search_ = opening.get();  // what is wrong with the map comes first
  if (listing) return;      // things are told without guessed names, if need be
  if (search_.index.embedded() == 0 && options_.images.empty()) return;
  require_embeddings(search_.index);
  if (fault) std::rethrow_exception(fault);
}

void QueryAsker::open_encoder() {
  const EncoderIdentity of_map = read_map_identity(options_.map).encoder;
  if (of_map.name.empty()) return;  // there is nothing to compare with
  RuntimeConfig runtime;
  runtime.threads = options_.threads;
  encoder_ = encoder_of_map(of_map, options_.encoder, runtime, options_.model_dirs);
}

const QueryEngine& QueryAsker::present() {
  if (!engine_) {
    engine_ = std::make_unique<QueryEngine>(search_.index, encoder_.get(), config_, Embeddings{},
                                            search_.scene);
    titles_ = std::make_shared<std::vector<std::string>>(titles_of(search_.index, engine_.get()));
  }
  return *engine_;
}

Answered QueryAsker::ask_names(const std::string& text) {
  QueryAnswer answer = find_by_name(
      search_.index,
      {checked_query_text(text, config_.max_text_chars), options_.negatives, relevance()});
  if (answer.matches.empty()) require_embeddings(search_.index);
  if (!titles_)
    titles_ = std::make_shared<std::vector<std::string>>(titles_of(search_.index, nullptr));
  return in_present(std::move(answer));
}

Answered QueryAsker::in_present(QueryAnswer answer) const {
  return {std::move(answer), &search_.index, titles_};
}

Answered QueryAsker::ask_past(const AskedText& asked) {
  if (!record_) record_ = read_corrected_record(options_.map);
  const auto past =
      std::make_shared<HistorySearch>(search_history(*record_, search_.info, *asked.past));
  past->search.scene.taught = search_.scene.taught;
  const SearchIndex& index = past->search.index;
  std::unique_ptr<QueryEngine> engine;
  if (index.embedded() > 0)
    engine = std::make_unique<QueryEngine>(index, encoder_.get(), config_, Embeddings{},
                                           past->search.scene);
  else if (!past->for_anything())
    require_embeddings(index);
  QueryAnswer answer = ask_history(*past, engine.get(), {"", options_.negatives, relevance()});
  answer.query = asked.text.empty() ? asked.past->text : asked.text;
  return {std::move(answer), &index,
          std::make_shared<std::vector<std::string>>(titles_of(index, engine.get())), past};
}

}  // namespace ovimap::apps
