// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Box, Instance } from './api/types';
import type { MapState } from './map-state';
import { boxOf } from './scene/ghosts';
import type { MapView } from './scene/map-view';
import type { CardContext, ObjectCard } from './ui/object-card';
import type { SearchPanel } from './ui/search-panel';
import type { Status } from './ui/status';
import { approachText, faultText } from './ui/words';

/** The one object that a person chose: outlined in the view, marked in the list, told of in the card. */
export class Selection {
  view: MapView | null = null;

  constructor(
    private readonly state: MapState,
    private readonly card: ObjectCard,
    private readonly search: SearchPanel,
    private readonly status: Status,
  ) {}

  /** 0, or what is not there: nothing is selected. */
  select(id: number, fly: boolean): void {
    const instance = this.mark(id);
    if (!instance) return;
    this.showCard(id);
    if (fly) this.view?.focus(instance);
  }

  /** After the objects were loaded anew: it may be gone, or by now be part of another, which goes by its own id. */
  async follow(): Promise<void> {
    const { selected, instances } = this.state;
    if (selected === 0) return;
    const id = instances.has(selected) ? selected : await idNow(selected);
    if (this.state.selected !== selected) return;
    if (id !== selected) this.mark(id);
    if (!this.card.renames()) this.showCard(id); // what is being typed stays
  }

  /** What was asked of this object's name is done. */
  renamed(id: number): void {
    if (this.card.renames(id)) this.showCard(this.state.selected);
  }

  focus(id: number): void {
    const instance = this.state.instances.get(id);
    if (instance) this.view?.focus(instance);
  }

  /** Outlines a part of the selected object. */
  showPart(part: Box): void {
    this.view?.outline(boxOf(part));
    this.view?.focusBox(boxOf(part));
  }

  /** Draws from where a robot sees the object, and its way there from where the recording ended. */
  async stand(id: number): Promise<void> {
    try {
      const approach = await api.approach(id, this.view?.lastCamera() ?? null);
      if (this.state.selected !== id) return;
      this.view?.showApproach(approach);
      this.status.toast(approachText(approach));
    } catch (error) {
      this.status.toast(faultText(error));
    }
  }

  private mark(id: number): Instance | null {
    const instance = this.state.instances.get(id) ?? null;
    this.state.selected = instance ? id : 0;
    document.body.classList.toggle('has-selection', instance !== null);
    this.view?.select(instance);
    this.search.mark(this.state.selected);
    if (!instance) this.card.close();
    return instance;
  }

  private showCard(id: number): void {
    const instance = this.state.instances.get(id);
    if (!instance) return;
    const context: CardContext = { find: (other) => this.state.instances.get(other) };
    this.card.show(instance);
    api.instance(id).then(
      (detail) => {
        if (this.state.selected === id) this.card.showDetail(detail, context);
      },
      (error: unknown) => this.status.toast(faultText(error)),
    );
  }
}

/** By which id an object goes that was part of the map; 0: it is gone. */
function idNow(id: number): Promise<number> {
  return api.instance(id).then(
    (detail) => detail.id,
    () => 0,
  );
}
