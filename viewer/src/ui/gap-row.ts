// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Gap } from '../api/types';
import { gapColor } from '../scene/gap-marks';
import { h } from './dom';

const NAMES = { unseen: 'Nobody looked here', thin: 'Seen too little' } as const;

/** A line of the list of places to look at. */
export function gapRow(gap: Gap, number: number, onSelect: (gap: Gap) => void): HTMLElement {
  const mark = h('span', { class: 'swatch', 'aria-hidden': 'true' });
  mark.style.background = gapColor(gap);
  const button = h(
    'button',
    { class: 'row', type: 'button', 'data-gap': number, onclick: () => onSelect(gap) },
    h(
      'span',
      { class: 'row-text' },
      h('span', { class: 'row-head' }, mark, h('span', { class: 'name' }, NAMES[gap.kind])),
      h('span', { class: 'detail' }, `${gap.area_m2.toFixed(1)} m²`),
    ),
  );
  return h('li', {}, button);
}
