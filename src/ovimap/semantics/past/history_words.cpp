// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/past/history_words.h"

#include <array>
#include <limits>

#include "ovimap/base/text/ascii.h"
#include "ovimap/semantics/query/query_words.h"
#include "ovimap/semantics/words/one_of.h"

namespace ovimap {

namespace {

enum class When { kSince, kBefore, kAt };

struct WhenWord {
  std::string_view word;
  When when;
};
constexpr std::array kWhenWords{WhenWord{"since", When::kSince},   WhenWord{"after", When::kSince},
                                WhenWord{"before", When::kBefore}, WhenWord{"until", When::kBefore},
                                WhenWord{"at", When::kAt},         WhenWord{"on", When::kAt},
                                WhenWord{"in", When::kAt},         WhenWord{"during", When::kAt},
                                WhenWord{"as of", When::kAt}};

struct ChangeWord {
  std::string_view word;
  AskedChange change;
};
constexpr std::array kChangeWords{
    ChangeWord{"moved", AskedChange::kMoved},       ChangeWord{"gone", AskedChange::kGone},
    ChangeWord{"disappeared", AskedChange::kGone},  ChangeWord{"vanished", AskedChange::kGone},
    ChangeWord{"missing", AskedChange::kGone},      ChangeWord{"removed", AskedChange::kGone},
    ChangeWord{"appeared", AskedChange::kAppeared}, ChangeWord{"new", AskedChange::kAppeared},
    ChangeWord{"added", AskedChange::kAppeared},    ChangeWord{"arrived", AskedChange::kAppeared},
    ChangeWord{"changed", AskedChange::kAny},       ChangeWord{"different", AskedChange::kAny}};

// What may stand before a word of change: "what has been moved", "chairs that are gone".
constexpr std::array<std::string_view, 8> kBeforeChange{"has", "have", "is",   "are",
                                                        "was", "were", "been", "went"};

/// Whether words name a time without "on" or "since" before it, and could be nothing else.
bool names_time_alone(Words words) {
  const std::string first = lower_case(words.front()), last = lower_case(words.back());
  return first == "yesterday" || first == "today" || last == "ago" ||
         (first == "this" && words.size() == 2);
}

/// Takes a time off the end; whether there was one.
bool take_when(Words& words, double now_s, HistoryPhrase& phrase) {
  for (std::size_t at = 0; at < words.size(); ++at) {
    When when = When::kAt;
    std::size_t length = 0;
    for (const WhenWord& known : kWhenWords)
      if (const std::size_t found = match_length(words.subspan(at), known.word); found > length)
        length = found, when = known.when;
    const Words rest = words.subspan(at + length);
    if (rest.empty() || (length == 0 && !names_time_alone(rest))) continue;
    const auto time = parse_time(rest, now_s);
    if (!time) continue;
    auto& slot = when == When::kSince    ? phrase.since
                 : when == When::kBefore ? phrase.before
                                         : phrase.at;
    if (slot) return false;  // "on Monday on Tuesday" is no question
    slot = time;
    words = words.first(at);
    return true;
  }
  return false;
}

/// Takes "[has | are ...] moved" off the end.
std::optional<AskedChange> take_change(Words& words) {
  if (words.empty()) return std::nullopt;
  for (const ChangeWord& known : kChangeWords) {
    if (lower_case(words.back()) != known.word) continue;
    words = words.first(words.size() - 1);
    while (!words.empty() && is_one_of(lower_case(words.back()), kBeforeChange))
      words = words.first(words.size() - 1);
    return known.change;
  }
  return std::nullopt;
}

/// "what [mugs] ... moved", "mugs that ... moved": what is asked for, where that is how it is
/// asked.
bool take_changed_things(Words& words, HistoryPhrase& phrase) {
  Words rest = words;
  const auto change = take_change(rest);
  if (!change || rest.empty()) return false;
  constexpr std::array<std::string_view, 2> kAsking{"what", "which"}, kLinking{"that", "which"};
  const bool asking = is_one_of(lower_case(rest.front()), kAsking),
             linking = rest.size() > 1 && is_one_of(lower_case(rest.back()), kLinking);
  if (!asking && !linking) return false;
  words = asking ? rest.subspan(1) : rest.first(rest.size() - 1);
  phrase.change = change;
  return true;
}

bool take_where_was(Words& words, HistoryPhrase& phrase) {
  const bool asked = match_length(words, "where was") > 0 || match_length(words, "where were") > 0;
  if (!asked || words.size() < 3) return false;
  words = words.subspan(2);
  phrase.place_before = true;
  return true;
}

}  // namespace

MapMoment beginning_of(const TimeAsked& time, int last_visit) {
  if (time.visit == 0) return {0, time.begin_s};
  const int visit = time.visit == TimeAsked::kLastVisit ? last_visit : time.visit;
  if (visit > 1) return {visit - 1, 0};
  return {0, -std::numeric_limits<double>::infinity()};
}

MapMoment end_of(const TimeAsked& time, int last_visit) {
  if (time.visit == 0) return {0, time.end_s};
  return {time.visit == TimeAsked::kLastVisit ? last_visit : time.visit, 0};
}

MapMoment since_of(const TimeAsked& time, int last_visit) {
  return time.visit == 0 ? beginning_of(time, last_visit) : end_of(time, last_visit);
}

std::optional<HistoryPhrase> parse_history(std::string_view text, double now_s) {
  while (!text.empty() && (text.back() == '?' || text.back() == ' ')) text.remove_suffix(1);
  const std::vector<std::string> all = words_of(text);
  Words words = all;
  HistoryPhrase phrase;
  while (take_when(words, now_s, phrase)) {
  }
  const bool timed = phrase.since || phrase.before || phrase.at;
  const bool asked = take_where_was(words, phrase) || take_changed_things(words, phrase);
  if (!timed && !asked) return std::nullopt;
  if (timed && phrase.place_before) {  // a time says when
    phrase.place_before = false;
    if (phrase.since) (phrase.since->visit == 0 ? phrase.before : phrase.at) = phrase.since;
    phrase.since.reset();
  }
  if (!phrase.change && phrase.since) phrase.change = AskedChange::kAny;
  words = without_articles(words);
  phrase.text = words.empty() ? "anything" : joined(words);
  return phrase;
}

const char* change_words(AskedChange change) {
  switch (change) {
    case AskedChange::kAny:
      return "changed";
    case AskedChange::kMoved:
      return "moved";
    case AskedChange::kGone:
      return "is gone";
    case AskedChange::kAppeared:
      return "appeared";
  }
  return "";
}

}  // namespace ovimap
