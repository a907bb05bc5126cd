// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { LoggedCorrection } from '../api/types';
import { h } from './dom';

export interface CorrectionLogHooks {
  load: () => Promise<LoggedCorrection[]>;
  onUndo: (edit: LoggedCorrection) => void;
  titleOf: (id: number) => string;
  onFault: (error: unknown) => void;
}

/** The dialog that lists what was corrected, the latest first, and takes it back. */
export class CorrectionLog {
  readonly element: HTMLDialogElement;
  private readonly list = h('ol', { class: 'log' });

  constructor(private readonly hooks: CorrectionLogHooks) {
    this.element = h(
      'dialog',
      { class: 'panel help', 'aria-labelledby': 'log-title' },
      h('h2', { id: 'log-title' }, 'Corrections'),
      this.list,
      h(
        'button',
        { class: 'primary', type: 'button', onclick: () => this.element.close() },
        'Close',
      ),
    );
  }

  async open(): Promise<void> {
    await this.load();
    if (!this.element.open) this.element.showModal();
  }

  async refresh(): Promise<void> {
    if (this.element.open) await this.load();
  }

  /** What a correction did, in words. */
  sentence(edit: LoggedCorrection): string {
    const [first, ...others] = (edit.instances ?? []).map(
      (id) => `${this.hooks.titleOf(id)} #${id}`,
    );
    switch (edit.kind) {
      case 'rename':
        return edit.name
          ? `#${edit.instances?.[0]} named “${edit.name}”`
          : `${first}: name taken away`;
      case 'merge':
        return `${others.join(', ')} merged into ${first}`;
      case 'split':
        return `#${edit.new_instance} split off ${first}`;
      case 'undo':
        return `correction ${edit.undoes} undone`;
      default:
        return `${first} ${{ lock: 'locked', delete: 'deleted', hide: 'hidden' }[edit.kind]}`;
    }
  }

  private async load(): Promise<void> {
    try {
      const edits = await this.hooks.load();
      this.list.replaceChildren(...edits.reverse().map((edit) => this.row(edit)));
      if (edits.length === 0)
        this.list.append(h('li', { class: 'detail' }, 'The map is as mapping found it.'));
    } catch (error) {
      this.hooks.onFault(error);
    }
  }

  private row(edit: LoggedCorrection): HTMLElement {
    const undone = edit.undone_by !== null;
    const undo = h(
      'button',
      { class: 'action', type: 'button', onclick: () => this.hooks.onUndo(edit) },
      'Undo',
    );
    return h(
      'li',
      { class: undone ? 'undone' : '' },
      h('span', {}, this.sentence(edit)),
      h('small', {}, new Date(edit.time_s * 1000).toLocaleString()),
      !undone && undo,
    );
  }
}
