// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Correction } from './api/types';
import type { MapState } from './map-state';
import type { MapView } from './scene/map-view';
import type { Status } from './ui/status';
import { faultText } from './ui/words';

export interface CorrectionHooks {
  /** Loads names and objects anew. */
  refresh: () => Promise<void>;
  /** Shows the object's card as it is now. */
  show: (id: number) => void;
  select: (id: number) => void;
}

/** What a person says against what mapping found; the server keeps it in the map. */
export class Corrections {
  view: MapView | null = null;
  private merging = 0;

  constructor(
    private readonly state: MapState,
    private readonly status: Status,
    private readonly hooks: CorrectionHooks,
  ) {}

  async rename(id: number, name: string): Promise<void> {
    this.status.toast('Saving the name …');
    if (!(await this.send({ kind: 'rename', instance: id, name }))) return;
    this.status.toast(name === '' ? 'The name is gone' : `Named “${name}”; it is kept in the map`);
    if (this.state.selected === id) this.hooks.show(id);
  }

  async lock(id: number): Promise<void> {
    if (await this.send({ kind: 'lock', instance: id, on: true })) this.status.toast('Locked');
  }

  async remove(id: number): Promise<void> {
    if (!(await this.send({ kind: 'delete', instance: id }))) return;
    this.status.toast('Deleted');
    this.hooks.select(0);
  }

  /** Hides on this page, and in the map where it can keep that. */
  async toggleHidden(id: number): Promise<void> {
    const hidden = !(this.view?.surface.table.isHidden(id) ?? false);
    this.view?.hide(id, hidden);
    this.hooks.show(id);
    if (this.state.can('hide')) await this.send({ kind: 'hide', instance: id, on: hidden });
    else if (hidden) this.status.toast('Hidden on this page; reloading it brings the object back');
  }

  startMerge(id: number): void {
    this.merging = id;
    this.status.setBanner(
      `Choose the object that ${this.state.titleOf(id)} #${id} is a part of, or press Esc.`,
    );
  }

  /** Takes a selection as the object to merge into, when one is asked for. */
  takeSelection(id: number): boolean {
    const merged = this.merging;
    if (merged === 0 || id === 0) return false;
    this.endMerge();
    void this.send({ kind: 'merge', instance: merged, into: id }).then((kept) => {
      if (kept) this.hooks.select(id);
    });
    return true;
  }

  /** Whether there was a merge to end. */
  endMerge(): boolean {
    if (this.merging === 0) return false;
    this.merging = 0;
    this.status.setBanner('');
    return true;
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
