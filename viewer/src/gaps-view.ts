// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Gap } from './api/types';
import { boxOf } from './scene/ghosts';
import type { MapView } from './scene/map-view';
import type { Status } from './ui/status';
import { faultText } from './ui/words';

export interface GapsHooks {
  /** Shows these in the list; null: what it shows otherwise. */
  list: (gaps: readonly Gap[] | null) => void;
}

/** Where to look next, for a person who scans: marked in the map and listed. */
export class GapsView {
  view: MapView | null = null;
  private open = false;

  constructor(
    private readonly status: Status,
    private readonly hooks: GapsHooks,
  ) {}

  async toggle(on: boolean): Promise<void> {
    this.open = on;
    if (!on) {
      this.view?.showGaps([]);
      return this.hooks.list(null);
    }
    try {
      const { gaps, space_known } = await api.gaps();
      if (!this.open) return;
      this.view?.showGaps(gaps);
      this.hooks.list(gaps);
      if (!space_known)
        this.status.toast('This map does not tell which space was seen: surface alone is judged');
    } catch (error) {
      this.status.toast(faultText(error));
    }
  }

  /** The map grew, or is another one. */
  async changed(): Promise<void> {
    if (this.open) await this.toggle(true);
  }

  choose(gap: Gap): void {
    this.view?.focusBox(boxOf(gap.box));
  }
}
