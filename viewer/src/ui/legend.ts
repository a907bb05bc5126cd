// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Color, Instance } from '../api/types';
import { EVIDENCE_M, EVIDENCE_RAMP, type Mode } from '../scene/coloring';
import { cssColor, h, swatch } from './dom';

const MOST_CLASSES = 12;

function classLegend(instances: readonly Instance[]): HTMLElement[] {
  const classes = new Map<number, { name: string; color: Color; points: number }>();
  for (const { class: own, points } of instances) {
    if (!own) continue;
    const entry = classes.get(own.id) ?? { name: own.name, color: own.color, points: 0 };
    entry.points += points;
    classes.set(own.id, entry);
  }
  const list = [...classes.values()].sort((a, b) => b.points - a.points);
  const rows = list
    .slice(0, MOST_CLASSES)
    .map(({ name, color }) => h('li', {}, swatch(color), name));
  if (list.length > MOST_CLASSES)
    rows.push(h('li', { class: 'detail' }, `and ${list.length - MOST_CLASSES} more`));
  return rows.length > 0
    ? [h('ul', {}, ...rows)]
    : [
        h(
          'p',
          { class: 'detail' },
          'No classes: the map has no embeddings, or they are still being compared.',
        ),
      ];
}

function heatLegend(ramp: readonly Color[], query: string): HTMLElement[] {
  const bar = h('span', { class: 'ramp', 'aria-hidden': 'true' });
  bar.style.background = `linear-gradient(to right, ${ramp.map(cssColor).join(', ')})`;
  const ends = h('span', { class: 'ramp-ends' }, h('span', {}, 'unlike'), h('span', {}, 'match'));
  const what = query
    ? `How well objects match “${query}”`
    : 'Ask for something to see how well objects match.';
  return [h('p', {}, what), bar, ends];
}

function evidenceLegend(): HTMLElement[] {
  const bar = h('span', { class: 'ramp', 'aria-hidden': 'true' });
  bar.style.background = `linear-gradient(to right, ${EVIDENCE_RAMP.map(cssColor).join(', ')})`;
  const ends = EVIDENCE_M.map((metres) => h('span', {}, `${1000 * metres} mm`));
  return [
    h('p', {}, 'How well places are known: the standard error of the surface'),
    bar,
    h('span', { class: 'ramp-ends' }, ...ends),
  ];
}

/** What the colours mean; hidden where they speak for themselves. */
export class Legend {
  readonly element = h('section', { class: 'panel legend', 'aria-label': 'Legend' });

  show(mode: Mode, instances: readonly Instance[], ramp: readonly Color[], query: string): void {
    this.element.hidden = mode === 'color' || mode === 'instances';
    if (mode === 'classes') this.element.replaceChildren(...classLegend(instances));
    if (mode === 'evidence') this.element.replaceChildren(...evidenceLegend());
    if (mode === 'heat') this.element.replaceChildren(...heatLegend(ramp, query));
  }
}
