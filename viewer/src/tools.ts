// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { MapView } from './scene/map-view';
import { metres } from './scene/measure';
import type { Pick } from './scene/picking';
import { PathPanel } from './ui/path-panel';
import { SectionPanel } from './ui/section-panel';
import type { Status } from './ui/status';
import type { Tool, Toolbar } from './ui/toolbar';

/** A tool that fills the list. */
export interface ListTool {
  toggle: (on: boolean) => Promise<void>;
}

/** The tools of the view, each on or off: measuring, section plane, camera path, lists, flying. */
export class Tools {
  readonly sectionPanel = new SectionPanel((section) => this.view?.setSection(section));
  readonly pathPanel = new PathPanel({
    onFrame: (frame) => this.view?.showPath(true, frame),
    onLook: (frame) => this.view?.lookFromFrame(frame),
  });
  view: MapView | null = null;
  private readonly active = new Set<Tool>();

  constructor(
    private readonly canvas: HTMLElement,
    private readonly toolbar: Toolbar,
    private readonly status: Status,
    private readonly lists: Record<'history' | 'rooms' | 'gaps', ListTool>,
  ) {}

  toggle(tool: Tool): void {
    const on = !this.active.has(tool);
    if (on) this.active.add(tool);
    else this.active.delete(tool);
    this.toolbar.setTool(tool, on);
    if (tool === 'fly') this.view?.movement.setFlying(on);
    if (tool === 'measure') this.setMeasuring(on);
    if (tool === 'section') this.setSection(on);
    if (tool === 'path') this.setPath(on);
    if (tool === 'history' || tool === 'rooms' || tool === 'gaps') void this.lists[tool].toggle(on);
  }

  isOn(tool: Tool): boolean {
    return this.active.has(tool);
  }

  /** Ends the tool that was begun last. Whether there was one. */
  endLast(): boolean {
    const tool = [...this.active].pop();
    if (tool) this.toggle(tool);
    return tool !== undefined;
  }

  /** Takes a click on the surface, if a tool wants it. */
  takeClick(hit: Pick | null): boolean {
    if (!this.active.has('measure')) return false;
    const distance = hit && this.view?.addMeasurePoint(hit.point);
    if (distance) this.status.toast(`${metres(distance)} between the two points`);
    return true;
  }

  private setMeasuring(on: boolean): void {
    this.canvas.classList.toggle('measuring', on);
    if (on) this.status.toast('Click two points of the surface');
    else this.view?.clearMeasure();
  }

  private setSection(on: boolean): void {
    this.sectionPanel.element.hidden = !on;
    if (on) this.sectionPanel.report();
    else this.view?.setSection(null);
  }

  private setPath(on: boolean): void {
    this.pathPanel.element.hidden = !on;
    if (on) this.pathPanel.report();
    else this.view?.showPath(false, 0);
  }
}
