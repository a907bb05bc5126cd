// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { h } from './dom';

export interface PathHooks {
  onFrame: (frame: number) => void;
  onLook: (frame: number) => void;
}

/** Walks along the frames of the recording. */
export class PathPanel {
  readonly element: HTMLElement;
  private readonly slider = h('input', {
    id: 'frame',
    type: 'range',
    min: 0,
    max: 0,
    step: 1,
    value: 0,
  });
  private readonly shown = h('output', { for: 'frame' });

  constructor(private readonly hooks: PathHooks) {
    this.slider.addEventListener('input', () => this.report());
    this.element = h(
      'div',
      { class: 'panel tool-panel', role: 'group', 'aria-label': 'Camera path' },
      h('label', { for: 'frame' }, 'Frame'),
      this.slider,
      this.shown,
      h(
        'button',
        { class: 'primary', type: 'button', onclick: () => hooks.onLook(this.frame) },
        'Look from here',
      ),
    );
    this.element.hidden = true;
  }

  get frame(): number {
    return Number(this.slider.value);
  }

  /** More frames: who looks at the last one goes on with the camera. */
  setCount(frames: number): void {
    const atEnd = this.frame === Number(this.slider.max);
    this.slider.max = String(Math.max(frames - 1, 0));
    if (atEnd && !this.element.hidden) this.slider.value = this.slider.max;
    if (!this.element.hidden) this.report();
  }

  report(): void {
    this.shown.textContent = `${this.frame + 1} / ${Number(this.slider.max) + 1}`;
    this.hooks.onFrame(this.frame);
  }
}
