// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/past_objects.h"

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

/// What is left of a thing that is gone, sides that no visit looked at, is not it.
PastStates states_now(const MapRecord& corrected) {
  PastStates states;
  for (const InstanceSummary& instance : corrected.instances) {
    const auto surface = corrected.surfaces.find(instance.id);
    states[instance.id] = {
        instance,
        surface == corrected.surfaces.end() ? std::vector<Eigen::Vector3f>{} : surface->second, 0};
  }
  for (const InstanceId id : gone_objects(corrected.history)) states.erase(id);
  return states;
}

/// What an object was before an event that ended it. `known`: what is known of its looks otherwise.
PastState state_before(const ObjectEvent& event, std::size_t number, const InstanceSummary* known) {
  PastState state;
  if (known) state.summary = *known;
  state.summary.id = event.instance;
  state.summary.box = event.before;
  state.summary.centroid = event.before.center();
  state.event = number + 1;
  if (!event.was) return state;
  state.summary.centroid = event.was->centroid;
  state.summary.points = event.was->points;
  state.summary.views = event.was->views;
  state.summary.super_points = event.was->super_points;
  state.surface = event.was->surface;
  return state;
}

/// Puts an object back to what it was before an event.
void undo(const ObjectEvent& event, std::size_t number, PastStates& states) {
  const auto now = states.find(event.instance);
  switch (event.kind) {
    case ObjectEventKind::kAppeared:
      if (now != states.end()) states.erase(now);
      return;
    case ObjectEventKind::kGone:
      states[event.instance] = state_before(event, number, nullptr);
      return;
    case ObjectEventKind::kMoved:  // unless people took it away
      if (now != states.end()) now->second = state_before(event, number, &now->second.summary);
      return;
  }
}

}  // namespace

PastStates states_at(const MapRecord& corrected, const HistoryDates& dates,
                     const MapMoment& moment) {
  dates.require(moment);
  const std::vector<ObjectEvent>& events = corrected.history.events;
  PastStates states = states_now(corrected);
  for (std::size_t i = events.size(); i-- > 0;)
    if (!dates.happened(corrected.history, i, moment) &&
        !find_instance(corrected.hidden, events[i].instance))
      undo(events[i], i, states);
  return states;
}

PastStates states_before_last(const MapRecord& corrected) {
  const std::vector<ObjectEvent>& events = corrected.history.events;
  PastStates states = states_now(corrected);
  for (std::size_t i = 0; i < events.size(); ++i)  // later events replace what earlier ones left
    if (events[i].kind != ObjectEventKind::kAppeared &&
        !find_instance(corrected.hidden, events[i].instance))
      undo(events[i], i, states);
  return states;
}

std::vector<HistoryChange> changes_between(const MapHistory& history, const HistoryDates& dates,
                                           const MapMoment& since, const MapMoment& until) {
  dates.require_known(since);
  dates.require(until);
  std::map<InstanceId, HistoryChange> changes;
  for (std::size_t i = 0; i < history.events.size(); ++i) {
    if (dates.happened(history, i, since) || !dates.happened(history, i, until)) continue;
    const InstanceId id = history.events[i].instance;
    HistoryChange& change = changes.try_emplace(id, HistoryChange{id, {}, i, i}).first->second;
    change.last = i;
  }
  std::vector<HistoryChange> result;
  for (auto& [id, change] : changes) {
    const bool before = history.events[change.first].kind != ObjectEventKind::kAppeared,
               after = history.events[change.last].kind != ObjectEventKind::kGone;
    if (!before && !after) continue;
    change.kind = !before  ? ObjectEventKind::kAppeared
                  : !after ? ObjectEventKind::kGone
                           : ObjectEventKind::kMoved;
    result.push_back(change);
  }
  return result;
}

MapChanges changes_between(const MapHistory& history, const HistoryDates& dates,
                           const std::string& since, const std::string& until, double now_s) {
  MapChanges between;
  between.since = since.empty() ? kBeginning : since_of(time_of_text(since, now_s), dates.visits());
  between.until = until.empty() ? MapMoment{dates.visits(), 0}
                                : end_of(time_of_text(until, now_s), dates.visits());
  between.changes = changes_between(history, dates, between.since, between.until);
  return between;
}

std::string change_text(const HistoryChange& change, const MapHistory& history,
                        const HistoryDates& dates) {
  const ObjectEvent &first = history.events[change.first], &last = history.events[change.last];
  const ObjectEvent whole{change.instance, change.kind, last.visit,  last.frame,
                          first.before,    last.after,  first.may_be};
  const auto date = dates.date_of(change.last);
  return concat(event_text(whole), ", visit ", last.visit,
                date ? ", " + date_text(*date) : std::string());
}

}  // namespace ovimap
