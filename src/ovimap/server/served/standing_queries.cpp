// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served/standing_queries.h"

#include <algorithm>
#include <set>

#include "ovimap/base/thread_priority.h"

namespace ovimap {

namespace {

using std::chrono::duration_cast;

constexpr double kWorkShare = 0.05;
constexpr std::chrono::seconds kMostRest{10};
// How often time is looked at while a verdict must stand, or the thread rests.
constexpr std::chrono::milliseconds kTick{200};

StandingObject standing_object(const MapAnswer& answered, const QueryMatch& match) {
  const MapSnapshot& now = *answered.map;
  StandingObject object;
  object.id = match.id;
  object.box = answered.index().object(match.position).box;
  object.probability = match.probability;
  object.title = now.name_of(match.id);
  object.named = !object.title.empty();
  if (object.named) return object;
  const bool known = !answered.past && match.position < now.names.size();
  object.title = known ? now.names[match.position].word : ObjectName::kUnclear;
  return object;
}

}  // namespace

StandingQueries::StandingQueries(const ServedMap& map, const Limits& limits)
    : map_(map), places_(limits.all, limits.of_one), listening_(map.events().watch([this] {
        {
          const std::lock_guard lock(mutex_);
          news_ = true;
        }
        changed_.notify_one();
      })) {}

StandingQueries::~StandingQueries() {
  listening_.reset();
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<StandingWatch> StandingQueries::watch(std::vector<std::string> queries,
                                                      Clock::duration hold, const std::string& mark,
                                                      const std::string& client) {
  auto place = places_.take(client, queries.size());
  if (!place) return nullptr;
  auto watch = std::make_shared<StandingWatch>(std::move(queries), hold, std::move(place));
  watch->go_on(mark);
  {
    const std::lock_guard lock(mutex_);
    watches_.push_back(watch);
    news_ = true;
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  }
  changed_.notify_one();
  return watch;
}

StandingQueries::Watches StandingQueries::living() {
  const std::lock_guard lock(mutex_);
  news_ = false;
  Watches living;
  std::erase_if(watches_, [&](const auto& weak) {
    if (auto watch = weak.lock()) {
      living.push_back(std::move(watch));
      return false;
    }
    return true;
  });
  return living;
}

void StandingQueries::work() {
  lower_thread_priority();
  while (!ending_) {
    bool waits = false;  // for time to pass
    {
      const Watches watches = living();
      if (!watches.empty()) look(watches);
      const auto now = map_.snapshot();
      waits = !watches.empty() && (now->live || now->version != looked_at_);
    }
    std::unique_lock lock(mutex_);
    const auto called = [&] { return ending_ || news_; };
    waits ? (void)changed_.wait_for(lock, kTick, called) : changed_.wait(lock, called);
  }
}

void StandingQueries::look(const Watches& watches) {
  const auto now = map_.snapshot();
  if (now->search == SearchState::kPreparing) return;  // an event says when it is ready
  const auto begin = Clock::now();
  const bool all = now->version != looked_at_ && begin >= rest_until_;
  std::string fault;
  try {
    if (!now->waits_for_objects) ask_all(watches, all);
  } catch (const SearchUnavailable& why) {
    fault = concat("this map cannot be searched: ", why.what());
  }
  const auto end = Clock::now();
  if (all) {
    looked_at_ = now->version;
    rest_until_ = end + std::min<Clock::duration>(
                            duration_cast<Clock::duration>((end - begin) / kWorkShare), kMostRest);
  }
  const bool settles = all || !now->live || now->version == looked_at_;
  for (const auto& watch : watches) {
    watch->take_fault(fault);
    if (settles && fault.empty()) watch->settle(now->live, Clock::now());
  }
}

/// What was never asked and, with `all`, what was asked of an earlier state. Nobody rests on behalf
/// of a new client.
void StandingQueries::ask_all(const Watches& watches, bool all) {
  const std::uint64_t version = map_.snapshot()->version;
  std::set<std::string> wanted;
  for (const auto& watch : watches) wanted.insert(watch->queries().begin(), watch->queries().end());
  std::erase_if(asked_, [&](const auto& known) { return !wanted.contains(known.first); });
  for (const std::string& text : wanted) {
    if (ending_) return;
    const auto known = asked_.find(text);
    if (known == asked_.end() || (all && known->second.version < version))
      asked_.insert_or_assign(text, ask(text));
  }
  const auto seen = Clock::now();
  for (const auto& watch : watches) {
    std::vector<const StandingVerdict*> verdicts;
    for (const std::string& text : watch->queries()) {
      const Asked& known = asked_.at(text);  // an older verdict tells a new client nothing
      verdicts.push_back(known.version < version ? nullptr : &known.verdict);
    }
    watch->take(verdicts, seen);
  }
}

StandingQueries::Asked StandingQueries::ask(const std::string& text) const {
  Asked asked{map_.snapshot()->version, {}};
  MapQuestion question;
  question.query.text = text;
  try {
    question.past = map_.past_of(text, "", "");
    const MapAnswer answered = map_.ask(question);
    const QueryAnswer& answer = answered.answer;
    if (answer.verdict == Verdict::kFound && !answer.matches.empty())
      asked.verdict.object = standing_object(answered, answer.matches.front());
  } catch (const SearchUnavailable&) {  // of all texts alike
    throw;
  } catch (const std::exception& error) {  // nobody else is there to tell
    asked.verdict.fault = error.what();
  }
  return asked;
}

}  // namespace ovimap
