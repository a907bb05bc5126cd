// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Correction, LoggedCorrection } from './api/types';
import type { MapState } from './map-state';
import { CorrectionLog } from './ui/correction-log';
import type { Status } from './ui/status';
import { faultText } from './ui/words';

export interface CorrectionHooks {
  /** Loads names and objects anew. */
  refresh: () => Promise<void>;
  /** What was asked of this object's name is done. */
  renamed: (id: number) => void;
  select: (id: number) => void;
}

type Choice = (id: number, label: number) => void;

/** What a person says against what mapping found; the server keeps it in the map. */
export class Corrections {
  readonly log = new CorrectionLog({
    load: () => api.corrections(),
    onUndo: (edit) => void this.undo(edit.id),
    titleOf: (id) => this.state.titleOf(id),
    onFault: (error) => this.status.toast(faultText(error)),
  });
  private choice: Choice | null = null;

  constructor(
    private readonly state: MapState,
    private readonly status: Status,
    private readonly hooks: CorrectionHooks,
  ) {}

  async rename(id: number, name: string): Promise<void> {
    if (!(await this.send({ kind: 'rename', instance: id, name }))) return;
    this.status.toast(name === '' ? 'The name is gone' : `Named “${name}”; it is kept in the map`);
    this.hooks.renamed(id);
  }

  /** Locks, or takes the lock back. */
  async toggleLock(id: number): Promise<void> {
    if (!this.state.instances.get(id)?.locked) {
      if (await this.send({ kind: 'lock', instance: id }))
        this.status.toast('Locked: mapping and corrections leave it as it is');
      return;
    }
    const lock = (await this.effective())
      .filter((edit) => edit.kind === 'lock' && edit.instances?.[0] === id)
      .at(-1);
    if (lock) await this.undo(lock.id);
  }

  async remove(id: number): Promise<void> {
    if (await this.send({ kind: 'delete', instance: id })) this.gone('Deleted; U brings it back');
  }

  async hide(id: number): Promise<void> {
    if (await this.send({ kind: 'hide', instance: id })) this.gone('Hidden; U brings it back');
  }

  /** Takes back a correction; 0: the latest. */
  async undo(edit = 0): Promise<void> {
    const before = await this.effective();
    const undone = before.find(({ id }) => id === edit) ?? before.at(-1);
    const what = undone ? `Undone: ${this.log.sentence(undone)}` : 'Undone';
    if (!(await this.send({ kind: 'undo', edit }))) return;
    this.status.toast(what);
    await this.log.refresh();
  }

  startMerge(id: number): void {
    this.choose(
      `Choose the object that ${this.state.titleOf(id)} #${id} is a part of, or press Esc.`,
      (into) => {
        if (into !== id)
          void this.send({ kind: 'merge', instance: id, into }).then((kept) => {
            if (kept) this.hooks.select(into);
          });
      },
    );
  }

  startSplit(id: number): void {
    this.choose(
      `Click the part of ${this.state.titleOf(id)} #${id} that is an object of its own, or press Esc.`,
      (other, label) => {
        if (other !== id || label === 0)
          return this.status.toast('That was no part of it; nothing changed');
        void this.send({ kind: 'split', instance: id, super_points: [label] });
      },
    );
  }

  /** Takes a selection that was asked for. `label`: the surface's, 0 when it was chosen from a list. */
  takeSelection(id: number, label: number): boolean {
    const { choice } = this;
    if (!choice || id === 0) return false;
    this.endChoice();
    choice(id, label);
    return true;
  }

  /** Whether there was a choice to end. */
  endChoice(): boolean {
    if (!this.choice) return false;
    this.choice = null;
    this.status.setBanner('');
    return true;
  }

  private choose(sentence: string, choice: Choice): void {
    this.choice = choice;
    this.status.setBanner(sentence);
  }

  private gone(sentence: string): void {
    this.status.toast(sentence);
    this.hooks.select(0);
  }

  /** What is not undone, oldest first. */
  private async effective(): Promise<LoggedCorrection[]> {
    const log = await api.corrections().catch(() => []);
    return log.filter((edit) => edit.kind !== 'undo' && edit.undone_by === null);
  }

  private async send(correction: Correction): Promise<boolean> {
    try {
      await api.correct(correction);
      await this.hooks.refresh();
      return true;
    } catch (error) {
      this.status.toast(faultText(error));
      return false;
    }
  }
}
