// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Box3, Vector3 } from 'three';
import { api } from './api/client';
import { listen } from './api/events';
import type { Answer, CorrectionKind, Instance, MapInfo, MeshListing } from './api/types';
import { listenToKeys } from './keyboard';
import { chunkKey, loadChunks } from './mesh/chunk-loader';
import type { Mode } from './scene/coloring';
import { MapView } from './scene/map-view';
import type { Pick } from './scene/picking';
import { type CardContext, ObjectCard } from './ui/object-card';
import { download, h } from './ui/dom';
import { Help } from './ui/help';
import { Legend } from './ui/legend';
import { PathPanel } from './ui/path-panel';
import { SearchPanel } from './ui/search-panel';
import { SectionPanel } from './ui/section-panel';
import { Status } from './ui/status';
import { applyTheme, backgroundOf, initialTheme, type Theme } from './ui/theme';
import { type Command, type Tool, Toolbar } from './ui/toolbar';
import { faultText, titleOf } from './ui/words';
import { metres } from './scene/measure';

const COARSE = 1;
const FINE = 0;

/** Ties the page together: what the server tells, what is shown, what the person does. */
export class App {
  private readonly canvas = h('canvas', {
    class: 'view', tabindex: 0, role: 'application',
    'aria-label': 'The map in 3D. Arrow keys turn it, W A S D move. The list of objects holds the same objects.',
  });
  private readonly status = new Status();
  private readonly help = new Help();
  private readonly legend = new Legend();
  private readonly search = new SearchPanel({
    onQuery: (text, not) => void this.ask({ text, not }, text),
    onClear: () => this.clearQuery(),
    onSelect: (id) => this.select(id, true),
  });
  private readonly card = new ObjectCard({
    onFocus: (id) => this.focus(id),
    onAlike: (id) => void this.ask({ like: id }, `like ${this.titleOf(id)} #${id}`),
    onRename: (id, name) => void this.rename(id, name),
    onMerge: (id) => this.startMerge(id),
    onHide: (id) => void this.toggleHidden(id),
    onLock: (id) => void this.correct('lock', id),
    onDelete: (id) => void this.correct('delete', id),
    onSelect: (id) => this.select(id, true),
    onClose: () => this.select(0, false),
  });
  private readonly sectionPanel = new SectionPanel((section) => this.view?.setSection(section));
  private readonly pathPanel = new PathPanel({
    onFrame: (frame) => this.view?.showPath(true, frame),
    onLook: (frame) => this.view?.lookFromFrame(frame),
  });
  private readonly toolbar = new Toolbar({
    onMode: (mode) => this.setMode(mode),
    onTool: (tool) => this.toggleTool(tool),
    onCommand: (command) => this.run(command),
  });

  private view: MapView | null = null;
  private info: MapInfo | null = null;
  private instances = new Map<number, Instance>();
  private selected = 0;
  private mode: Mode = 'color';
  private modeBefore: Mode = 'color';
  private answer: Answer | null = null;
  private asking: AbortController | null = null;
  private merging = 0;
  private meshVersion = 0;
  private readonly tools = new Set<Tool>();
  private theme: Theme = initialTheme();

  constructor(root: HTMLElement) {
    root.append(
      this.canvas, this.search.element, this.card.element, this.toolbar.element, this.legend.element,
      this.sectionPanel.element, this.pathPanel.element, this.help.element, ...this.status.elements,
    );
    this.toolbar.setMode(this.mode);
    this.listenToKeys();
  }

  /** Loads the map and shows it; faults are shown, never thrown. */
  async start(): Promise<void> {
    try {
      const coarse = api.chunks(COARSE);
      const [info, instances] = await Promise.all([api.map(), api.instances()]);
      this.takeMap(info, instances);
      this.search.showAll(0);
      this.makeView(info, instances);
      this.repaint();
      await this.loadSurface(await coarse);
    } catch (error) {
      this.status.setBanner(faultText(error));
      this.status.progress(1);
      return;
    }
    this.follow();
  }

  // ---------------------------------------------------------------------------- what the map is

  private takeMap(info: MapInfo, instances: readonly Instance[]): void {
    this.info = info;
    this.instances = new Map(instances.map((instance) => [instance.id, instance]));
    document.title = `${info.title} – ovimap`;
    this.search.setMap(info);
    this.search.setInstances(instances);
  }

  /** Names or guesses changed. */
  private async refresh(): Promise<void> {
    const [info, instances] = await Promise.all([api.map(), api.instances()]);
    this.takeMap(info, instances);
    this.showList();
    this.repaint();
    if (this.selected !== 0 && !this.card.element.querySelector('form')) this.showCard(this.selected);
  }

  private makeView(info: MapInfo, instances: readonly Instance[]): void {
    const largestId = instances.reduce((most, { id }) => Math.max(most, id), 0);
    try {
      this.view = new MapView(this.canvas, info, largestId, {
        onClick: (hit) => this.onClick(hit),
        onLost: () => this.status.setBanner('The graphics driver gave up; reload this page.'),
      });
      this.view.setTheme(backgroundOf(this.theme));
      this.canvas.after(this.view.measure.label);
    } catch (error) {
      this.canvas.hidden = true;
      this.status.setBanner(faultText(error));
    }
  }

  private async loadSurface(coarse: MeshListing): Promise<void> {
    const { view } = this;
    if (!view) return this.status.progress(1);
    const cameras = await api.cameras();
    view.setCameras(cameras);
    this.pathPanel.setCount(cameras.frames.length);
    view.frameAll(boxOfChunks(coarse), false);
    const put = view.put.bind(view);
    await loadChunks(COARSE, coarse.chunks, (chunk, at) => put(chunkKey(at), chunk), () => this.status.progress(0.05));
    view.frameAll(view.surface.box(), false);
    this.mark('first-picture');
    await this.loadFine();
    this.mark('whole-picture');
  }

  private async loadFine(): Promise<void> {
    const fine = await api.chunks(FINE);
    this.meshVersion = fine.version;
    await loadChunks(FINE, fine.chunks, (chunk, at) => this.view?.put(chunkKey(at), chunk), (done, total) => this.status.progress(total === 0 ? 1 : done / total));
    this.view?.surface.keepOnly(new Set(fine.chunks.map(chunkKey)));
    this.view?.surfaceChanged();
  }

  /** For measurements: once the browser has drawn what is there now. */
  private mark(name: string): void {
    requestAnimationFrame(() => setTimeout(() => performance.mark(name)));
  }

  private follow(): void {
    const failed = (error: unknown): void => this.status.toast(faultText(error));
    listen({
      onMap: () => void this.refresh().catch(failed),
      onMesh: () => void api.map().then((info) => (info.mesh_version > this.meshVersion ? this.loadFine() : undefined)).catch(failed),
      onConnection: (connected) => this.status.setBanner(connected ? '' : 'The connection to the server is lost; trying again. What is loaded stays usable.'),
    });
  }

  // ------------------------------------------------------------------------------------ selection

  private onClick(hit: Pick | null): void {
    if (this.tools.has('measure')) {
      const distance = hit && this.view?.addMeasurePoint(hit.point);
      if (distance) this.status.toast(`${metres(distance)} between the two points`);
      return;
    }
    this.select(hit?.instance ?? 0, false);
  }

  private select(id: number, fly: boolean): void {
    if (this.merging !== 0 && id !== 0) return void this.merge(this.merging, id);
    this.selected = this.instances.has(id) ? id : 0;
    const instance = this.instances.get(this.selected) ?? null;
    document.body.classList.toggle('has-selection', instance !== null);
    this.view?.select(instance);
    this.search.mark(this.selected);
    if (!instance) return this.card.close();
    this.showCard(this.selected);
    if (fly) this.view?.focus(instance);
  }

  private focus(id: number): void {
    const instance = this.instances.get(id);
    if (instance) this.view?.focus(instance);
  }

  private showCard(id: number): void {
    const instance = this.instances.get(id);
    if (!instance) return;
    const context: CardContext = {
      find: (other) => this.instances.get(other),
      can: (kind) => this.info?.corrections.includes(kind) ?? false,
      hidden: this.view?.surface.table.isHidden(id) ?? false,
    };
    this.card.show(instance, context);
    api.instance(id).then(
      (detail) => { if (this.selected === id) this.card.showDetail(detail, context); },
      (error: unknown) => this.status.toast(faultText(error)),
    );
  }

  private titleOf(id: number): string {
    const instance = this.instances.get(id);
    return instance ? titleOf(instance) : `Object ${id}`;
  }

  // --------------------------------------------------------------------------------------- search

  private async ask(question: { text?: string; not?: string[]; like?: number }, shown: string): Promise<void> {
    this.asking?.abort();
    const asking = (this.asking = new AbortController());
    this.search.setQuery(shown);
    this.search.showBusy();
    try {
      this.answer = await api.query(question, asking.signal);
    } catch (error) {
      if (!asking.signal.aborted) this.search.showFault(faultText(error));
      return;
    }
    if (this.mode !== 'heat') this.modeBefore = this.mode;
    this.select(0, false);
    this.showList();
    this.setMode('heat');
    this.mark('answer-drawn');
  }

  private clearQuery(): void {
    this.asking?.abort();
    if (this.answer && this.mode === 'heat') this.setMode(this.modeBefore);
    this.answer = null;
    this.showList();
    this.repaint();
  }

  private showList(): void {
    if (this.answer) this.search.showAnswer(this.answer, this.selected);
    else this.search.showAll(this.selected);
  }

  // ---------------------------------------------------------------------------------- corrections

  private async correct(kind: CorrectionKind, instance: number, more: { name?: string; into?: number; on?: boolean } = {}): Promise<boolean> {
    try {
      await api.correct({ kind, instance, ...more });
      await this.refresh();
      return true;
    } catch (error) {
      this.status.toast(faultText(error));
      return false;
    }
  }

  private async rename(id: number, name: string): Promise<void> {
    this.status.toast('Saving the name …');
    if (!(await this.correct('rename', id, { name }))) return;
    this.status.toast(name === '' ? 'The name is gone' : `Named “${name}”; it is kept in the map`);
    if (this.selected === id) this.showCard(id);
  }

  private startMerge(id: number): void {
    this.merging = id;
    this.status.setBanner(`Click the object that ${this.titleOf(id)} #${id} is a part of, or press Esc.`);
  }

  private async merge(id: number, into: number): Promise<void> {
    this.merging = 0;
    this.status.setBanner('');
    if (await this.correct('merge', id, { into })) this.select(into, false);
  }

  private async toggleHidden(id: number): Promise<void> {
    const hidden = !(this.view?.surface.table.isHidden(id) ?? false);
    this.view?.hide(id, hidden);
    this.showCard(id);
    if (this.info?.corrections.includes('hide')) await this.correct('hide', id, { on: hidden });
    else if (hidden) this.status.toast('Hidden on this page; reloading it brings the object back');
  }

  // ------------------------------------------------------------------------------- view and tools

  private setMode(mode: Mode): void {
    this.mode = mode;
    this.toolbar.setMode(mode);
    this.repaint();
  }

  private repaint(): void {
    const instances = [...this.instances.values()];
    const ramp = this.info?.heat_ramp ?? [];
    this.legend.show(this.mode, instances, ramp, this.answer?.query ?? '');
    this.view?.paint({ mode: this.mode, instances, ramp, heat: new Map(this.answer?.heat ?? []) });
  }

  private toggleTool(tool: Tool): void {
    const on = !this.tools.has(tool);
    if (on) this.tools.add(tool);
    else this.tools.delete(tool);
    this.toolbar.setTool(tool, on);
    if (tool === 'fly') this.view?.movement.setFlying(on);
    if (tool === 'measure') this.toggleMeasure(on);
    if (tool === 'section') this.toggleSection(on);
    if (tool === 'path') this.togglePath(on);
  }

  private toggleMeasure(on: boolean): void {
    this.canvas.classList.toggle('measuring', on);
    if (on) this.status.toast('Click two points of the surface');
    else this.view?.clearMeasure();
  }

  private toggleSection(on: boolean): void {
    this.sectionPanel.element.hidden = !on;
    if (on) this.sectionPanel.report();
    else this.view?.setSection(null);
  }

  private togglePath(on: boolean): void {
    this.pathPanel.element.hidden = !on;
    if (on) this.pathPanel.report();
    else this.view?.showPath(false, 0);
  }

  private run(command: Command): void {
    if (command === 'help') this.help.toggle();
    if (command === 'home' && this.view) this.view.frameAll(this.view.surface.box(), true);
    if (command === 'theme') this.switchTheme();
    if (command === 'picture') void this.savePicture();
    if (command === 'download') void this.saveGlb();
  }

  private switchTheme(): void {
    this.theme = this.theme === 'dark' ? 'light' : 'dark';
    applyTheme(this.theme);
    this.view?.setTheme(backgroundOf(this.theme));
  }

  private async savePicture(): Promise<void> {
    const picture = await this.view?.picture();
    if (picture) download(picture, `${this.info?.title ?? 'map'}.png`);
    else this.status.toast('There is no picture to save');
  }

  private async saveGlb(): Promise<void> {
    try {
      download(await api.glb(), `${this.info?.title ?? 'map'}.glb`);
    } catch (error) {
      this.status.toast(faultText(error));
    }
  }

  private escape(): void {
    if (this.merging !== 0) {
      this.merging = 0;
      return this.status.setBanner('');
    }
    const tool = [...this.tools].pop();
    if (tool) return this.toggleTool(tool);
    if (this.selected !== 0) return this.select(0, false);
    if (this.answer) {
      this.search.setQuery('');
      this.clearQuery();
    }
  }

  private listenToKeys(): void {
    const withSelected = (run: (id: number) => void) => () => { if (this.selected !== 0) run(this.selected); };
    listenToKeys({
      '/': () => this.search.focus(),
      '1': () => this.setMode('color'),
      '2': () => this.setMode('instances'),
      '3': () => this.setMode('classes'),
      '4': () => this.setMode('heat'),
      f: withSelected((id) => this.focus(id)),
      h: withSelected((id) => void this.toggleHidden(id)),
      n: withSelected(() => this.card.startRename()),
      m: () => this.toggleTool('measure'),
      x: () => this.toggleTool('section'),
      c: () => this.toggleTool('path'),
      g: () => this.toggleTool('fly'),
      p: () => this.run('picture'),
      t: () => this.run('theme'),
      Home: () => this.run('home'),
      '?': () => this.run('help'),
      Escape: () => this.escape(),
    });
  }
}

function boxOfChunks({ chunks, chunk_edge_m: edge }: MeshListing): Box3 {
  const box = new Box3();
  for (const { x, y, z } of chunks) {
    const corner = new Vector3(x, y, z).multiplyScalar(edge);
    box.expandByPoint(corner).expandByPoint(corner.clone().addScalar(edge));
  }
  return box;
}
