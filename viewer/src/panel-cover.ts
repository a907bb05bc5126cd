// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { MapView } from './scene/map-view';

/**
 * Tells the view which part of it panels cover, now and whenever they change: they lie at the left, on
 * phones at the bottom, where one of them is shown at a time.
 */
export function tellWhatPanelsCover(view: MapView, search: HTMLElement, card: HTMLElement): void {
  const cover = (): void => {
    const left = search.getBoundingClientRect();
    const phone = window.matchMedia('(max-width: 760px)').matches;
    const bottom = Math.max(left.height, card.getBoundingClientRect().height);
    view.setCovered(phone ? { left: 0, bottom } : { left: left.right, bottom: 0 });
  };
  const observer = new ResizeObserver(cover);
  for (const panel of [search, card]) observer.observe(panel);
  cover();
}
