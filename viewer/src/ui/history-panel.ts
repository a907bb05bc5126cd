// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { History } from '../api/types';
import { h } from './dom';
import { visitText } from './words';

export interface HistoryPanelHooks {
  onChange: (visit: number, gone: boolean) => void;
}

/** The time line: after which visit the map is shown, and whether what was gone by then is, too. */
export class HistoryPanel {
  readonly element: HTMLElement;
  private readonly slider = h('input', {
    id: 'visit',
    type: 'range',
    min: 1,
    max: 1,
    step: 1,
    value: 1,
    list: 'visits',
  });
  private readonly ticks = h('datalist', { id: 'visits' });
  private readonly shown = h('output', { for: 'visit', class: 'visit' });
  private readonly gone = h('input', { id: 'gone', type: 'checkbox' });
  private history: History | null = null;

  constructor(private readonly hooks: HistoryPanelHooks) {
    for (const field of [this.slider, this.gone])
      field.addEventListener('input', () => this.report());
    this.element = h(
      'div',
      { class: 'panel tool-panel', role: 'group', 'aria-label': 'Visits' },
      h('label', { for: 'visit' }, 'As of'),
      this.slider,
      this.ticks,
      this.shown,
      this.gone,
      h('label', { for: 'gone' }, 'Show what is gone'),
    );
    this.element.hidden = true;
  }

  get visit(): number {
    return Number(this.slider.value);
  }

  show(history: History): void {
    this.history = history;
    const { visits } = history;
    const atEnd = this.element.hidden || this.slider.value === this.slider.max;
    this.slider.max = String(visits.length);
    this.slider.disabled = visits.length < 2;
    if (atEnd) this.slider.value = this.slider.max;
    this.ticks.replaceChildren(...visits.map(({ visit }) => h('option', { value: visit })));
    this.element.hidden = false;
    this.report();
  }

  close(): void {
    this.element.hidden = true;
  }

  private report(): void {
    if (!this.history) return;
    this.shown.textContent = visitText(this.history.visits, this.visit);
    this.hooks.onChange(this.visit, this.gone.checked);
  }
}
