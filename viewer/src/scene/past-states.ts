// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { HistoryEvent } from '../api/types';

/** How the map differs from what it is now, at an earlier time. */
export interface PastState {
  /** Objects that were not there, or not where they are. */
  absent: Set<number>;
  /** Events before which an object was where it is not any more. */
  present: HistoryEvent[];
}

/** What was there after a visit: of each object the first event that came later tells. */
export function stateAfter(events: readonly HistoryEvent[], visit: number): PastState {
  const state: PastState = { absent: new Set(), present: [] };
  const told = new Set<number>();
  for (const event of events) {
    if (event.visit <= visit || told.has(event.instance)) continue;
    told.add(event.instance);
    if (event.event !== 'gone') state.absent.add(event.instance);
    if (event.event !== 'appeared') state.present.push(event);
  }
  return state;
}

/** Events before which something stood where it did not stand any more after a visit. */
export function goneBy(events: readonly HistoryEvent[], visit: number): HistoryEvent[] {
  return events.filter((event) => event.visit <= visit && event.event !== 'appeared');
}
