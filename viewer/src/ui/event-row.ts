// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from '../api/client';
import type { HistoryEvent, Instance, Match } from '../api/types';
import { h } from './dom';
import { thumbnail } from './object-row';
import { dateOf, eventText, eventTitle, percent } from './words';

/** What it looked like before; of what appeared, what it looks like. */
function picture(event: HistoryEvent, now: Instance | undefined): HTMLElement {
  if (!event.crop) return now ? thumbnail(now) : h('span', { class: 'thumb empty' });
  const src = api.pastCropUrl(event.id);
  return h('img', { class: 'thumb', src, alt: '', loading: 'lazy', width: 44, height: 44 });
}

function row(
  event: HistoryEvent,
  now: Instance | undefined,
  lines: string[],
  onSelect: () => void,
): HTMLElement {
  const button = h(
    'button',
    { class: 'row', type: 'button', 'data-event': event.id, onclick: onSelect },
    picture(event, now),
    h(
      'span',
      { class: 'row-text' },
      h(
        'span',
        { class: 'row-head' },
        h('span', { class: `change ${event.event}`, 'aria-hidden': 'true' }),
        h('span', { class: 'name' }, eventTitle(event), ' ', h('small', {}, `#${event.instance}`)),
      ),
      ...lines.filter(Boolean).map((line) => h('span', { class: 'detail' }, line)),
    ),
  );
  return h('li', {}, button);
}

/** A line of the list of changes. `now`: the object as it is, if it is there. */
export function eventRow(
  event: HistoryEvent,
  now: Instance | undefined,
  onSelect: (event: HistoryEvent) => void,
): HTMLElement {
  const date = dateOf(event.time_s);
  const lines = [eventText(event), `visit ${event.visit}${date && `, ${date}`}`];
  return row(event, now, lines, () => onSelect(event));
}

/** A line of an answer that speaks of an object where it is not any more. */
export function pastRow(
  event: HistoryEvent,
  match: Match,
  onSelect: (event: HistoryEvent) => void,
): HTMLElement {
  return row(event, undefined, [percent(match.probability), match.evidence], () => onSelect(event));
}
