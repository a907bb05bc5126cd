// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Room, Rooms } from './api/types';
import type { MapView } from './scene/map-view';
import type { Status } from './ui/status';
import { faultText } from './ui/words';

export interface RoomsHooks {
  /** Shows these in the list; null: what it shows otherwise. */
  list: (rooms: readonly Room[] | null) => void;
}

/** The rooms of the map, drawn on its floor and listed. */
export class RoomsView {
  view: MapView | null = null;
  private open = false;
  private loading: Promise<Rooms> | null = null;

  constructor(
    private readonly status: Status,
    private readonly hooks: RoomsHooks,
  ) {}

  async toggle(on: boolean): Promise<void> {
    this.open = on;
    if (!on) {
      this.view?.showRooms(null);
      return this.hooks.list(null);
    }
    const slow = window.setTimeout(() => this.status.toast('Looking for rooms …'), 500);
    try {
      this.loading ??= api.rooms();
      const rooms = await this.loading;
      if (!this.open) return;
      this.view?.showRooms(rooms);
      this.hooks.list(rooms.rooms);
    } catch (error) {
      this.loading = null;
      this.status.toast(faultText(error));
    } finally {
      window.clearTimeout(slow);
    }
  }

  /** Objects or their names changed, and with them what rooms are called. */
  async changed(): Promise<void> {
    this.loading = null;
    if (this.open) await this.toggle(true);
  }

  choose(room: Room): void {
    this.view?.focusRoom(room);
  }
}
