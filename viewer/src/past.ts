// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Answer, History, HistoryEvent } from './api/types';
import { boxOf, placeOf } from './scene/ghosts';
import type { MapView } from './scene/map-view';
import { goneBy, stateAfter } from './scene/past-states';
import { HistoryPanel } from './ui/history-panel';
import type { Status } from './ui/status';
import { faultText } from './ui/words';

export interface PastHooks {
  /** Shows these in the list; null: what it shows otherwise. */
  list: (events: readonly HistoryEvent[] | null) => void;
  /** Shows the card of an object that is there; false: it is not. */
  select: (id: number) => boolean;
}

/** The map as earlier visits left it: a time line, what changed, and things where they are not any more. */
export class Past {
  readonly panel: HistoryPanel;
  view: MapView | null = null;
  private history: History | null = null;
  private loading: Promise<History> | null = null;
  private open = false;
  private gone = false;
  private asked: number[] = []; // events of an answer
  private chosen = 0; // event of the list

  constructor(
    private readonly status: Status,
    private readonly hooks: PastHooks,
  ) {
    this.panel = new HistoryPanel({
      onChange: (_, gone) => {
        this.gone = gone;
        void this.draw();
      },
    });
  }

  event(id: number): HistoryEvent | undefined {
    return this.history?.events[id - 1];
  }

  async toggle(on: boolean): Promise<void> {
    this.open = on;
    if (!on) {
      this.chosen = 0;
      this.panel.close();
      this.view?.outline(null);
      this.hooks.list(null);
      return this.draw();
    }
    const history = await this.load();
    if (!history || !this.open) return;
    this.panel.show(history);
    this.hooks.list([...history.events].reverse());
  }

  /** Objects or names changed; what is shown follows. */
  async changed(): Promise<void> {
    this.history = this.loading = null;
    this.view?.ghosts.clear();
    if (this.open) await this.toggle(true);
  }

  /** Shows what an answer speaks of where it is not any more. */
  async showAnswer(answer: Answer | null): Promise<void> {
    const past = answer?.matches.flatMap(({ event }) => event ?? []) ?? [];
    const had = this.asked.length > 0;
    this.asked = past;
    if (past.length > 0) await this.load();
    if (past.length > 0 || had) await this.draw();
  }

  /** Goes to what an event tells of, and shows what was there before. */
  async choose(event: HistoryEvent): Promise<void> {
    this.chosen = event.id;
    const there = event.event !== 'gone' && !this.asked.includes(event.id);
    await this.draw();
    if (there && this.hooks.select(event.instance)) {
      const box = placeOf(event);
      if (box) this.view?.focusBox(event.before ? box.union(boxOf(event.before)) : box);
      return;
    }
    this.hooks.select(0);
    const box = event.before && boxOf(event.before);
    this.view?.outline(box);
    if (box) this.view?.focusBox(box);
  }

  private async load(): Promise<History | null> {
    try {
      this.loading ??= api.history();
      this.history = await this.loading;
    } catch (error) {
      this.loading = null;
      this.status.toast(faultText(error));
    }
    return this.history;
  }

  private async draw(): Promise<void> {
    const events = this.history?.events ?? [];
    const last = this.history?.visits.length ?? 1;
    const visit = this.open ? Math.min(this.panel.visit, last) : last;
    const then = stateAfter(events, visit);
    const ghosts = new Map<number, { faint: boolean }>();
    if (this.open && this.gone)
      for (const { id } of goneBy(events, visit)) ghosts.set(id, { faint: true });
    for (const { id } of then.present) ghosts.set(id, { faint: false });
    for (const id of this.asked) ghosts.set(id, { faint: false });
    if (this.open && this.chosen !== 0 && !ghosts.has(this.chosen))
      ghosts.set(this.chosen, { faint: true });
    await this.fetch([...ghosts.keys()]);
    this.view?.showPast(ghosts, then.absent);
  }

  private async fetch(ids: number[]): Promise<void> {
    const missing = ids.filter((id) => this.event(id)?.surface && !this.view?.ghosts.has(id));
    try {
      await Promise.all(
        missing.map(async (id) => this.view?.ghosts.add(id, await api.pastSurface(id))),
      );
    } catch (error) {
      this.status.toast(faultText(error));
    }
  }
}
