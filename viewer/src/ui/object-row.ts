// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from '../api/client';
import type { Box, Instance, Match } from '../api/types';
import { h, swatch } from './dom';
import { isGuess, percent, plural, titleOf } from './words';

export function thumbnail(instance: Instance): HTMLElement {
  const crop = instance.crops[0];
  if (crop === undefined) return h('span', { class: 'thumb empty', 'aria-hidden': 'true' });
  return h('img', {
    class: 'thumb',
    src: api.cropUrl(instance.id, crop),
    alt: '',
    loading: 'lazy',
    width: 44,
    height: 44,
  });
}

/** How sure the search is, as a bar and in figures. */
function certainty(match: Match): HTMLElement {
  const share = match.probability ?? 0;
  const bar = h('span', { class: 'bar', 'aria-hidden': 'true' }, h('i'));
  (bar.firstElementChild as HTMLElement).style.width = `${Math.round(100 * share)}%`;
  const title = `cosine ${match.score.toFixed(3)}, ${match.standard_score.toFixed(1)} standard deviations above unrelated things`;
  const figure = match.probability === null ? match.score.toFixed(2) : percent(share);
  return h('span', { class: 'certainty', title }, bar, h('span', { class: 'figure' }, figure));
}

function nameOf(instance: Instance): HTMLElement {
  const guess = isGuess(instance);
  return h(
    'span',
    { class: guess ? 'name guess' : 'name', title: guess ? 'guessed by the encoder' : '' },
    titleOf(instance),
    ' ',
    h('small', {}, `#${instance.id}`),
  );
}

/** A line of a list: what the object looks like and is called, and how well it matches. */
export function objectRow(
  instance: Instance,
  match: Match | null,
  evidence: string,
  onSelect: (id: number, part: Box | null) => void,
): HTMLElement {
  const details = match
    ? certainty(match)
    : h('span', { class: 'detail' }, `seen in ${plural(instance.views, 'frame')}`);
  const button = h(
    'button',
    {
      class: 'row',
      type: 'button',
      'data-id': instance.id,
      onclick: () => onSelect(instance.id, match?.part?.box ?? null),
    },
    thumbnail(instance),
    h(
      'span',
      { class: 'row-text' },
      h('span', { class: 'row-head' }, swatch(instance.color), nameOf(instance)),
      details,
      evidence !== '' && h('span', { class: 'detail' }, evidence),
    ),
  );
  return h('li', {}, button);
}
