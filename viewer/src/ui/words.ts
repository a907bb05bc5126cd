// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Answer, Approach, Box, HistoryEvent, Instance, Visit } from '../api/types';

/** The word that the evidence for an object is clear about; empty: none. */
function clearWord(instance: Instance): string {
  const word = instance.label?.name ?? '';
  return word === 'object' ? '' : word;
}

/** What an object is called: as a person named it, else what it clearly is, else by its number. */
export function titleOf(instance: Instance): string {
  return instance.name || clearWord(instance) || `Object ${instance.id}`;
}

/** Whether the title is only a guess. */
export function isGuess(instance: Instance): boolean {
  return instance.name === '' && clearWord(instance) !== '';
}

export function percent(share: number | null): string {
  return share === null ? '' : `${Math.round(share * 100)} %`;
}

export function sizeOf({ box }: { box: Box }): string {
  const sides = [0, 1, 2].map((axis) => box.max[axis]! - box.min[axis]!);
  if (box.min[0] === null) return '–';
  return `${sides.map((side) => side.toFixed(2)).join(' × ')} m`;
}

export function placeOf({ centroid }: Instance): string {
  return centroid.map((value) => value?.toFixed(2) ?? '–').join(', ');
}

/** What is said when a robot asks where to stand. */
export function approachText(approach: Approach): string {
  const [best] = approach.poses;
  if (!best) return `It cannot be reached: ${approach.reason}`;
  const seen = `${(best.seen * 100).toFixed(0)} % of it is seen from ${best.distance_m.toFixed(2)} m`;
  return best.way_in_world.length > 1 ? `${seen}, ${best.way_m.toFixed(1)} m to go` : seen;
}

/** "14 Mar 2026, 09:30"; empty where nobody knows. */
export function dateOf(time_s: number | null): string {
  if (time_s === null) return '';
  return new Date(time_s * 1000).toLocaleString('en-GB', {
    dateStyle: 'medium',
    timeStyle: 'short',
  });
}

/** "visit 2 of 3, 14 Mar 2026, 09:30". */
export function visitText(visits: readonly Visit[], visit: number): string {
  const date = dateOf(visits[visit - 1]?.begin_s ?? null);
  return `visit ${visit} of ${visits.length}${date && `, ${date}`}`;
}

/** "visit 2 of 3, 14 Mar 2026, 09:30"; empty where there was but one, and nobody knows when. */
export function lastSeenText({ last_seen: seen }: Instance): string {
  const visit = seen && seen.visits > 1 ? `visit ${seen.visit} of ${seen.visits}` : '';
  return [visit, dateOf(seen?.time_s ?? null)].filter((part) => part !== '').join(', ');
}

/** What an object that may be gone is called. */
export function eventTitle(event: HistoryEvent): string {
  const word = event.label === 'object' ? '' : event.label;
  return event.name || word || `Object ${event.instance}`;
}

/** "moved 1.20 m", "gone", "new". */
export function eventText(event: HistoryEvent): string {
  if (event.event === 'gone') return 'gone';
  if (event.event === 'appeared')
    return event.may_be === null ? 'new' : `new, may be Object ${event.may_be}`;
  const middle = (box: typeof event.before, axis: number): number =>
    ((box?.min[axis] ?? 0) + (box?.max[axis] ?? 0)) / 2;
  const shift = [0, 1, 2].map((axis) => middle(event.after, axis) - middle(event.before, axis));
  return `moved ${Math.hypot(...shift).toFixed(2)} m`;
}

/** "2 found, 1.9 ± 0.7 by their chances" */
export function countText(count: NonNullable<Answer['count']>): string {
  const expected = `${count.expected.toFixed(1)} ± ${count.deviation.toFixed(1)}`;
  return `${count.found} found, ${expected} by their chances`;
}

export function plural(count: number, one: string, many = `${one}s`): string {
  return `${count.toLocaleString('en')} ${count === 1 ? one : many}`;
}

/** "#12" in a sentence of the server becomes what the object is called. */
export function withTitles(sentence: string, find: (id: number) => Instance | undefined): string {
  return sentence.replace(/#(\d+)/g, (number, id: string) => {
    const instance = find(Number(id));
    return instance ? `${titleOf(instance)} ${number}` : number;
  });
}

export function faultText(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
