// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Section, SectionAxis } from '../scene/section';
import { h } from './dom';

const AXES: [SectionAxis, string][] = [
  ['height', 'Height'],
  ['width', 'Width'],
  ['depth', 'Depth'],
];

/** Where the section plane lies. */
export class SectionPanel {
  readonly element: HTMLElement;
  private readonly axis: HTMLSelectElement;
  private readonly share = h('input', {
    id: 'section-share',
    type: 'range',
    min: 0,
    max: 1,
    step: 0.005,
    value: 0.6,
  });
  private readonly flipped = h('input', { id: 'section-flip', type: 'checkbox' });

  constructor(private readonly onChange: (section: Section) => void) {
    this.axis = h(
      'select',
      { id: 'section-axis' },
      ...AXES.map(([value, label]) => h('option', { value }, label)),
    );
    for (const field of [this.axis, this.share, this.flipped])
      field.addEventListener('input', () => this.report());
    this.element = h(
      'div',
      { class: 'panel tool-panel', role: 'group', 'aria-label': 'Section plane' },
      h('label', { for: 'section-axis' }, 'Cut by'),
      this.axis,
      h('label', { for: 'section-share' }, 'At'),
      this.share,
      h('label', { for: 'section-flip' }, 'Other side'),
      this.flipped,
    );
    this.element.hidden = true;
  }

  report(): void {
    this.onChange({
      axis: this.axis.value as SectionAxis,
      share: Number(this.share.value),
      flipped: this.flipped.checked,
    });
  }
}
