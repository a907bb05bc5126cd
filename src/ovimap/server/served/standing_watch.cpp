// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served/standing_watch.h"

namespace ovimap {

namespace {

constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::size_t kBits = 4;  // of a digit

std::size_t bit_of(std::size_t query) {
  return std::size_t{1} << (kBits - 1 - query % kBits);
}

}  // namespace

StandingWatch::StandingWatch(std::vector<std::string> queries, Clock::duration hold,
                             std::shared_ptr<void> place)
    : queries_(std::move(queries)),
      hold_(hold),
      place_(std::move(place)),
      entries_(queries_.size()) {}

std::string StandingWatch::mark() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::size_t> digits((entries_.size() + kBits - 1) / kBits);
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (entries_[i].told) digits[i / kBits] |= bit_of(i);
  std::string text;
  for (const std::size_t digit : digits) text += kDigits[digit];
  return text;
}

void StandingWatch::go_on(const std::string& mark) {
  const std::lock_guard lock(mutex_);
  if (mark.size() != (entries_.size() + kBits - 1) / kBits ||
      mark.find_first_not_of(kDigits) != std::string::npos)
    return;
  for (std::size_t i = 0; i < entries_.size(); ++i)
    entries_[i].told = entries_[i].settled = kDigits.find(mark[i / kBits]) & bit_of(i);
}

void StandingWatch::take(const std::vector<const StandingVerdict*>& verdicts,
                         Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (!verdicts[i]) continue;
    entry.fault = verdicts[i]->fault;
    if (!entry.fault.empty()) continue;  // what was told stays
    const bool found = verdicts[i]->object.has_value();
    if (!entry.known || found != entry.found) entry.since = now;
    entry.known = true;
    entry.found = found;
    if (found) entry.last = verdicts[i]->object;
  }
}

void StandingWatch::settle(bool live, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  bool news = fault_ != fault_told_;
  for (Entry& entry : entries_) {
    if (entry.known && (!live || now - entry.since >= hold_)) entry.settled = entry.found;
    news = news || entry.settled != entry.told || entry.fault != entry.fault_told;
  }
  if (news) wake();
}

void StandingWatch::take_fault(const std::string& fault) {
  const std::lock_guard lock(mutex_);
  fault_ = fault;
  if (fault_ != fault_told_) wake();
}

std::optional<StandingEvent> StandingWatch::next() {
  using Kind = StandingEvent::Kind;
  const std::lock_guard lock(mutex_);
  if (fault_ != fault_told_) {
    fault_told_ = fault_;
    if (!fault_.empty()) return StandingEvent{Kind::kFault, "", {}, fault_};
  }
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (entry.fault != entry.fault_told) {
      entry.fault_told = entry.fault;
      if (!entry.fault.empty()) return StandingEvent{Kind::kFault, queries_[i], {}, entry.fault};
    }
    if (entry.settled == entry.told) continue;
    entry.told = entry.settled;
    return StandingEvent{entry.told ? Kind::kFound : Kind::kGone, queries_[i], entry.last, ""};
  }
  return std::nullopt;
}

void StandingWatch::call(std::function<void()> wake) {
  const std::lock_guard lock(mutex_);
  wake_ = std::move(wake);
}

/// Under the mutex, so that who is woken has not left in the meantime.
void StandingWatch::wake() const {
  if (wake_) wake_();
}

}  // namespace ovimap
