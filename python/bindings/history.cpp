// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.h"
#include "ovimap/io/map_tables/map_file_history.h"
#include "ovimap/semantics/query/query_text.h"
#include "saved_map.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

using Corners = std::array<std::array<float, 3>, 2>;

/// A recording that went into the map.
struct Visit {
  int visit;
  std::string source;
  std::optional<double> begin_s, end_s;
};

/// What a visit found changed, or what changed between two times.
struct Change {
  InstanceId id;
  std::string name, label, event, text;
  int visit;
  std::optional<double> time_s;
  std::optional<Corners> before, after;
  std::optional<InstanceId> may_be;
};

std::optional<Corners> corners(const Eigen::AlignedBox3f& box) {
  if (box.isEmpty()) return std::nullopt;
  return Corners{{{box.min().x(), box.min().y(), box.min().z()},
                  {box.max().x(), box.max().y(), box.max().z()}}};
}

HistoryDates dates_of(const MapRecord& record) {
  return {record.history, record.frames};
}

Change told(SavedMap& map, const HistoryDates& dates, const HistoryChange& change) {
  const MapRecord& record = map.record();
  const ObjectEvent &first = record.history.events[change.first],
                    &last = record.history.events[change.last];
  const WordsOfObjects& words = map.words_with_gone();
  const auto word = words.find(change.instance);
  const auto name = record.names.find(change.instance);
  return {change.instance,
          name == record.names.end() ? "" : name->second,
          word == words.end() ? "" : word->second,
          event_name(change.kind),
          change_text(change, record.history, dates),
          last.visit,
          dates.date_of(change.last),
          corners(first.before),
          corners(last.after),
          first.may_be == 0 ? std::nullopt : std::optional(first.may_be)};
}

std::vector<Visit> visits(SavedMap& map) {
  const MapRecord& record = map.record();
  const HistoryDates dates = dates_of(record);
  std::vector<Visit> list;
  for (int visit = 1; visit <= dates.visits(); ++visit) {
    const auto at = static_cast<std::size_t>(visit - 1);
    list.push_back(
        {visit, record.history.visits.empty() ? record.source : record.history.visits[at].source,
         dates.begin_of(visit), dates.end_of(visit)});
  }
  return list;
}

using VisitAndTime = std::pair<int, std::optional<double>>;

std::optional<VisitAndTime> last_seen(SavedMap& map, InstanceId id) {
  const InstanceSummary& instance = map.info().instances[map.position(id)];
  const MapRecord& record = map.record();
  const auto seen = ovimap::last_seen(record, dates_of(record), instance.super_points);
  return seen ? std::optional(VisitAndTime{seen->visit, seen->time_s}) : std::nullopt;
}

std::vector<Change> events(SavedMap& map) {
  const MapRecord& record = map.record();
  const HistoryDates dates = dates_of(record);
  std::vector<Change> list;
  for (std::size_t i = 0; i < record.history.events.size(); ++i) {
    const ObjectEvent& event = record.history.events[i];
    list.push_back(told(map, dates, {event.instance, event.kind, i, i}));
  }
  return list;
}

std::vector<Change> changes(SavedMap& map, const std::string& since, const std::string& until) {
  const MapRecord& record = map.record();
  const HistoryDates dates = dates_of(record);
  std::vector<Change> list;
  for (const HistoryChange& change :
       changes_between(record.history, dates, since, until, seconds_now()).changes)
    list.push_back(told(map, dates, change));
  return list;
}

void bind_history_values(nb::module_& module) {
  nb::class_<Visit>(module, "Visit", "A recording that went into a map.")
      .def_ro("visit", &Visit::visit, "from 1")
      .def_ro("source", &Visit::source, "where its frames came from")
      .def_ro("begin_s", &Visit::begin_s, "seconds since 1970 (UTC); None: nobody knows")
      .def_ro("end_s", &Visit::end_s)
      .def("__repr__", [](const Visit& visit) {
        return concat("Visit(", visit.visit, ", '", visit.source, "')");
      });
  nb::class_<Change>(module, "Change", "What became of an object.")
      .def_ro("id", &Change::id, "of the object")
      .def_ro("name", &Change::name, "given by people; empty otherwise")
      .def_ro("label", &Change::label, "what it clearly is; empty: not known")
      .def_ro("event", &Change::event, "\"appeared\", \"gone\" or \"moved\"")
      .def_ro("text", &Change::text, "the same in a sentence")
      .def_ro("visit", &Change::visit, "that found it")
      .def_ro("time_s", &Change::time_s, "seconds since 1970 (UTC); None: nobody knows")
      .def_ro("before", &Change::before,
              "the box where it was: the lowest corner and the highest, metres in the world")
      .def_ro("after", &Change::after, "the box where it is")
      .def_ro("may_be", &Change::may_be, "of what appeared: a gone object that it resembles")
      .def("__repr__", [](const Change& change) {
        return concat("Change(#", change.id, ": ", change.text, ")");
      });
}

}  // namespace

const MapRecord& SavedMap::record() {
  const std::lock_guard lock(details_mutex_);
  if (!record_) record_ = read_corrected_record(path_);
  return *record_;
}

const WordsOfObjects& SavedMap::words_with_gone() {
  const MapRecord& past = record();
  const std::lock_guard lock(words_mutex_);
  if (words_) return *words_;
  words_.emplace();
  try {
    engine(true);  // opens the encoder
    if (encoder_)
      words_ = ovimap::words_with_gone(past, info(), *encoder_, config_, scene().taught);
  } catch (const Error&) {  // a search in words says why; names are an extra
  }
  return *words_;
}

std::optional<HistoryPhrase> SavedMap::past_of(const std::string& text, const std::string& at,
                                               const std::string& since) const {
  const bool timed = !at.empty() || !since.empty();
  if (!config_.grammar && !timed) return std::nullopt;
  const bool all = text.empty() && timed;
  return history_of_question(all ? text : checked_query_text(text, config_.max_text_chars), at,
                             since, seconds_now());
}

QueryAnswer SavedMap::ask_past(const HistoryPhrase& phrase, const Query& query) {
  HistorySearch past = search_history(record(), info(), phrase);
  past.search.scene.taught = scene().taught;
  const SearchIndex& then = past.search.index;
  std::unique_ptr<QueryEngine> words;
  if (!past.for_anything() || !query.not_texts.empty()) {
    engine(true);  // opens the encoder
    words = std::make_unique<QueryEngine>(then, encoder_.get(), config_, Embeddings(),
                                          past.search.scene);
  }
  QueryAnswer answer = ask_history(past, words.get(), query);
  answer.query = query.text;
  Eigen::VectorXf relevance =
      Eigen::VectorXf::Zero(static_cast<Eigen::Index>(query.relevance ? index().size() : 0));
  if (query.relevance)
    for (std::size_t i = 0; i < then.size(); ++i)
      if (const auto row = index().find(then.object(i).id))
        relevance[static_cast<Eigen::Index>(*row)] = answer.relevance[static_cast<Eigen::Index>(i)];
  answer.relevance = std::move(relevance);
  for (QueryMatch& match : answer.matches) match.position = index().find(match.id).value_or(kGone);
  return answer;
}

void bind_history(nb::module_& module, nb::class_<SavedMap>& map) {
  bind_history_values(module);
  map.def_prop_ro("visits", &visits, "the recordings that went into it, oldest first")
      .def_prop_ro("events", &events, nb::call_guard<WithoutGil>(),
                   "what its visits found changed, oldest first")
      .def("changes", &changes, nb::kw_only(), nb::arg("since") = "", nb::arg("until") = "",
           nb::call_guard<WithoutGil>(),
           "What changed between two times (docs/query.md, \"Times\"), by object; what came and "
           "went "
           "in between is left out. Empty: the beginning, and the last visit.")
      .def("last_seen", &last_seen, nb::arg("id"), nb::call_guard<WithoutGil>(),
           "When the last frame was taken whose segments showed an object: the visit, from 1, and "
           "seconds since 1970 (UTC), or None where nobody told when that visit was. None: the map "
           "does not know. Raises Error for an unknown id.");
}

}  // namespace ovimap::python
