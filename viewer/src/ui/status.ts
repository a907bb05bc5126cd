// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { h } from './dom';

const TOAST_MS = 5000;

/** Progress while the map loads, passing notes, and what stays until it is mended. */
export class Status {
  private readonly bar = h('progress', {
    class: 'progress',
    max: 1,
    value: 0,
    'aria-label': 'Loading the map',
  });
  private readonly toasts = h('div', { class: 'toasts', role: 'status', 'aria-live': 'polite' });
  private readonly banner = h('div', { class: 'panel banner', role: 'alert' });
  readonly elements = [this.bar, this.toasts, this.banner];

  constructor() {
    this.banner.hidden = true;
  }

  progress(share: number): void {
    this.bar.value = share;
    this.bar.hidden = share >= 1;
  }

  toast(sentence: string): void {
    const toast = h('p', { class: 'panel toast' }, sentence);
    this.toasts.append(toast);
    setTimeout(() => toast.remove(), TOAST_MS);
  }

  /** Stays until it is replaced by another sentence, or by none. */
  setBanner(sentence: string): void {
    this.banner.textContent = sentence;
    this.banner.hidden = sentence === '';
  }
}
