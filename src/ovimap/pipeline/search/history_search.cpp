// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/history_search.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/semantics/classes/object_names.h"
#include "ovimap/semantics/query/query_text.h"

namespace ovimap {

namespace {

/// Makes the objects and what is told of them.
class HistoryTeller {
 public:
  HistoryTeller(const MapRecord& corrected, const HistoryPhrase& phrase)
      : record_(corrected), phrase_(phrase), dates_(corrected.history, corrected.frames) {}

  PastStates objects() {
    if (phrase_.change) return changed_objects();
    if (phrase_.place_before) {
      reading_ = " where it was before";
      return states_before_last(record_);
    }
    const MapMoment then = phrase_.at ? end_of(*phrase_.at, dates_.visits())
                                      : beginning_of(*phrase_.before, dates_.visits());
    if (then == kBeginning)
      throw MomentUnknown("nothing is known of what was before the map's first visit");
    reading_ = " at " + last_moment(then);
    return states_at(record_, dates_, then);
  }

  /// What became of a state that is no more.
  std::string told(const PastState& state) const {
    if (const auto change = changes_.find(state.summary.id); change != changes_.end())
      return change_text(change->second, record_.history, dates_);
    if (state.event == 0) return phrase_.place_before ? "still there" : "";
    const ObjectEvent& event = record_.history.events[state.event - 1];
    const auto date = dates_.date_of(state.event - 1);
    return concat(event.kind == ObjectEventKind::kGone ? "gone" : "moved from here", " as visit ",
                  event.visit, date ? ", " + date_text(*date) + "," : std::string(), " found");
  }

  bool may_be_asked_for(InstanceId id) const { return !phrase_.change || changes_.contains(id); }
  const std::string& reading() const { return reading_; }

 private:
  /// What is there at the end of the time, and what went within it, as it was.
  PastStates changed_objects() {
    const int last = dates_.visits();
    MapMoment since = phrase_.since ? since_of(*phrase_.since, last) : kBeginning,
              until = phrase_.before ? beginning_of(*phrase_.before, last) : MapMoment{last, 0};
    if (phrase_.at) since = beginning_of(*phrase_.at, last), until = end_of(*phrase_.at, last);
    PastStates states = states_at(record_, dates_, until);
    for (const HistoryChange& change : changes_between(record_.history, dates_, since, until)) {
      if (!is_asked(change.kind)) continue;
      if (change.kind == ObjectEventKind::kGone) bring_back(change, since, states);
      if (states.contains(change.instance)) changes_.emplace(change.instance, change);
    }
    describe_time(since, until);
    return states;
  }

  void bring_back(const HistoryChange& change, const MapMoment& since, PastStates& states) {
    const ObjectEvent& event = record_.history.events[change.last];
    PastStates then =
        states_at(record_, dates_, event.visit > 1 ? MapMoment{event.visit - 1, 0} : since);
    if (auto found = then.extract(change.instance)) states.insert(std::move(found));
  }

  bool is_asked(ObjectEventKind kind) const {
    switch (*phrase_.change) {
      case AskedChange::kMoved:
        return kind == ObjectEventKind::kMoved;
      case AskedChange::kGone:
        return kind == ObjectEventKind::kGone;
      case AskedChange::kAppeared:
        return kind == ObjectEventKind::kAppeared;
      case AskedChange::kAny:
        return true;
    }
    return false;
  }

  void describe_time(const MapMoment& since, const MapMoment& until) {
    reading_ = concat(" that ", change_words(*phrase_.change));
    if (since != kBeginning) reading_ += " since " + dates_.text_of(since);
    if (phrase_.at || phrase_.before) reading_ += " until " + last_moment(until);
  }

  /// A day ends a minute before the next.
  std::string last_moment(MapMoment moment) const {
    constexpr double kMinute_s = 60;
    if (moment.visit == 0) moment.time_s -= kMinute_s;
    return dates_.text_of(moment);
  }

  const MapRecord& record_;
  const HistoryPhrase& phrase_;
  HistoryDates dates_;
  std::map<InstanceId, HistoryChange> changes_;  ///< those that are asked for
  std::string reading_;
};

/// Takes away what a thing is found to be.
void leave_out(const std::string& thing, const QueryEngine& engine, std::vector<bool>& among) {
  constexpr float kLikely = 0.5f;
  const QueryAnswer answer = engine.find({concat('"', thing, '"'), {}, true, among});  // no grammar
  if (answer.verdict != Verdict::kFound) return;
  for (std::size_t i = 0; i < among.size(); ++i)
    if (answer.relevance[static_cast<Eigen::Index>(i)] >= kLikely) among[i] = false;
}

/// All that may be the answer, in the order of their ids.
QueryAnswer list_all(const HistorySearch& history, const QueryEngine* engine, const Query& query) {
  QueryAnswer answer;
  const SearchIndex& index = history.search.index;
  std::vector<bool> among = history.among;
  if (among.empty()) among.assign(index.size(), true);
  for (const std::string& text : query.not_texts)
    for (const std::string& thing :
         split_terms(checked_query_text(text, QueryConfig().max_text_chars)))
      leave_out(thing, *engine, among);
  const bool relevance = query.relevance;
  answer.relevance = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(relevance ? index.size() : 0));
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (!among[i]) continue;
    QueryMatch& match = answer.matches.emplace_back();
    match.position = i;
    match.id = index.object(i).id;
    match.probability = 1;
    if (relevance) answer.relevance[static_cast<Eigen::Index>(i)] = 1.f;
  }
  if (!answer.matches.empty()) answer.verdict = Verdict::kFound;
  answer.reading = "[anything]";
  return answer;
}

}  // namespace

std::optional<HistoryPhrase> history_of_question(const std::string& text, const std::string& at,
                                                 const std::string& since, double now_s) {
  std::optional<HistoryPhrase> phrase = parse_history(text, now_s);
  if (at.empty() && since.empty()) return phrase;
  if (phrase && (phrase->at || phrase->since || phrase->before))
    throw Error(
        concat("'", text, "' says when already; leave the time out of it or of the options"));
  if (!phrase) phrase = HistoryPhrase{text.empty() ? "anything" : text, {}, false, {}, {}, {}};
  phrase->place_before = false;  // the option says when
  if (!at.empty()) phrase->at = time_of_text(at, now_s);
  if (!since.empty()) phrase->since = time_of_text(since, now_s);
  if (!since.empty() && !at.empty())
    throw Error("give either a time that it was at, or one since when");
  if (!since.empty() && !phrase->change) phrase->change = AskedChange::kAny;
  return phrase;
}

HistorySearch search_history(const MapRecord& corrected, const MapInfo& info,
                             const HistoryPhrase& phrase) {
  HistorySearch history;
  history.phrase = phrase;
  HistoryTeller teller(corrected, history.phrase);
  PastStates objects = teller.objects();
  MapRecord then = corrected;
  then.instances.clear();
  then.surfaces.clear();
  for (auto& [id, state] : objects) {
    history.events.push_back(state.event);
    history.told.push_back(teller.told(state));
    if (phrase.change) history.among.push_back(teller.may_be_asked_for(id));
    then.instances.push_back(std::move(state.summary));
    if (!state.surface.empty()) then.surfaces[id] = std::move(state.surface);
  }
  history.reading = teller.reading();
  history.search = make_map_search(then, info);
  return history;
}

MapRecord read_corrected_record(const std::filesystem::path& map) {
  MapRecord record = load_map_without_voxels(map);
  MapInfo now = read_map_info(map);
  record.instances = std::move(now.instances);
  record.hidden = std::move(now.hidden);
  record.locked = std::move(now.locked);
  record.names = std::move(now.names);
  record.surfaces = read_corrected_surfaces(map);
  return record;
}

QueryAnswer ask_history(const HistorySearch& history, const QueryEngine* engine, Query query) {
  query.text = history.phrase.text;
  query.among = history.among;
  OVIMAP_ASSERT(engine || (history.for_anything() && query.not_texts.empty()));
  QueryAnswer answer =
      history.for_anything() ? list_all(history, engine, query) : engine->find(query);
  const bool none =
      std::none_of(history.among.begin(), history.among.end(), [](bool may) { return may; });
  if (!history.among.empty() && none) answer.reason = "nothing" + history.reading.substr(5);
  if (answer.reading.empty()) answer.reading = concat("[", query.text, "]");
  answer.reading += history.reading;
  for (QueryMatch& match : answer.matches) {
    const std::string& told = history.told[match.position];
    if (!told.empty())
      match.evidence = told + (match.evidence.empty() ? "" : "; ") + match.evidence;
  }
  return answer;
}

WordsOfObjects words_with_gone(const MapRecord& corrected, const MapInfo& info,
                               ImageTextEncoder& encoder, const QueryConfig& config,
                               const TaughtThings& taught) {
  HistoryPhrase all;
  all.text = "anything";
  all.change = AskedChange::kAny;
  MapSearch past = search_history(corrected, info, all).search;
  past.scene.taught = taught;
  const QueryEngine engine(past.index, &encoder, config, Embeddings{}, past.scene);
  WordsOfObjects words;
  const TextEvidence* evidence = engine.matcher()->evidence();
  if (!evidence) return words;
  const std::vector<ObjectName> names = name_objects(*evidence);
  for (std::size_t i = 0; i < names.size(); ++i) words[past.index.object(i).id] = names[i].word;
  return words;
}

}  // namespace ovimap
