// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Answer, Instance, MapInfo } from './api/types';
import type { Mode } from './scene/coloring';
import { titleOf } from './ui/words';

/** What the page knows of the map, and what it shows of it. */
export class MapState {
  info: MapInfo | null = null;
  instances = new Map<number, Instance>();
  /** The selected object; 0: none. */
  selected = 0;
  mode: Mode = 'color';
  answer: Answer | null = null;

  take(info: MapInfo, instances: readonly Instance[]): void {
    this.info = info;
    this.instances = new Map(instances.map((instance) => [instance.id, instance]));
  }

  titleOf(id: number): string {
    const instance = this.instances.get(id);
    return instance ? titleOf(instance) : `Object ${id}`;
  }
}
