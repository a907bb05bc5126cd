// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import { listen } from './api/events';
import type { FrameEvent, Instance, MapInfo, Question } from './api/types';
import { CameraState } from './camera-state';
import { Commands } from './commands';
import { Corrections } from './corrections';
import { GapsView } from './gaps-view';
import { listenToKeys } from './keyboard';
import { loadObjects, waitForFrames } from './map-loading';
import { MapState } from './map-state';
import { tellWhatPanelsCover } from './panel-cover';
import { Past } from './past';
import { RoomsView } from './rooms-view';
import { Rounds } from './rounds';
import type { Mode } from './scene/coloring';
import { MapView } from './scene/map-view';
import { Selection } from './selection';
import { SurfaceLoader } from './surface-loader';
import { Tools } from './tools';
import { h } from './ui/dom';
import { Legend } from './ui/legend';
import { ObjectCard } from './ui/object-card';
import { SearchPanel } from './ui/search-panel';
import { Status } from './ui/status';
import { Toolbar } from './ui/toolbar';
import { faultText } from './ui/words';

const LIVE_PAUSE_MS = 1500; // between two looks at what objects there are by now

/** Ties the page together: what the server tells, what is shown, what the person does. */
export class App {
  private readonly state = new MapState();
  private readonly canvas = h('canvas', {
    class: 'view',
    tabindex: 0,
    role: 'application',
    'aria-label':
      'The map in 3D. Arrow keys turn it, W A S D move. The list holds the same objects.',
  });
  private readonly status = new Status();
  private readonly camera = new CameraState(this.status);
  private readonly commands = new Commands(
    this.status,
    () => this.state.info?.title ?? 'map',
    () => void this.corrections.log.open(),
  );
  private readonly legend = new Legend();
  private readonly search = new SearchPanel({
    onQuery: (text, not) => void this.ask({ text, not }, text),
    onClear: () => this.clearQuery(),
    onSelect: (id, part) => {
      this.select(id, part === null);
      if (part) this.selection.showPart(part);
    },
    onEvent: (event) => void this.past.choose(event),
    onRoom: (room) => this.rooms.choose(room),
    onGap: (gap) => this.gaps.choose(gap),
    eventOf: (id) => this.past.event(id),
  });
  private readonly corrections = new Corrections(this.state, this.status, {
    refresh: () => this.refresh(),
    renamed: (id) => this.selection.renamed(id),
    select: (id) => this.select(id, false),
  });
  private readonly card = new ObjectCard({
    onFocus: (id) => this.selection.focus(id),
    onAlike: (id) => void this.ask({ like: id }, `like ${this.state.titleOf(id)} #${id}`),
    onStand: (id) => void this.selection.stand(id),
    onRename: (id, name) => void this.corrections.rename(id, name),
    onMerge: (id) => this.corrections.startMerge(id),
    onSplit: (id) => this.corrections.startSplit(id),
    onHide: (id) => void this.corrections.hide(id),
    onLock: (id) => void this.corrections.toggleLock(id),
    onDelete: (id) => void this.corrections.remove(id),
    onSelect: (id) => this.select(id, true),
    onPart: (box) => this.selection.showPart(box),
    onClose: () => this.select(0, false),
  });
  private readonly selection = new Selection(this.state, this.card, this.search, this.status);
  private readonly toolbar = new Toolbar({
    onMode: (mode) => this.setMode(mode),
    onTool: (tool) => this.tools.toggle(tool),
    onCommand: (command) => this.commands.run(command),
  });
  private readonly past = new Past(this.status, {
    list: (events) => this.showInstead(events && (() => this.search.showChanges(events))),
    select: (id) => this.selectThere(id),
  });
  private readonly rooms = new RoomsView(this.status, {
    list: (rooms) => this.showInstead(rooms && (() => this.search.showRooms(rooms))),
  });
  private readonly gaps = new GapsView(this.status, {
    list: (gaps) => this.showInstead(gaps && (() => this.search.showGaps(gaps))),
  });
  private readonly tools = new Tools(this.canvas, this.toolbar, this.status, {
    history: this.past,
    rooms: this.rooms,
    gaps: this.gaps,
  });
  private readonly refreshes = new Rounds(
    () => this.loadAgain(),
    () => (this.state.info?.live ? LIVE_PAUSE_MS : 0),
  );
  private view: MapView | null = null;
  private modeBefore: Mode = 'color';
  private asking: AbortController | null = null;
  private instead: (() => void) | null = null; // shows something else than objects in the list

  constructor(root: HTMLElement) {
    root.append(
      h(
        'main',
        {},
        this.canvas,
        this.search.element,
        this.card.element,
        this.toolbar.element,
        this.legend.element,
        this.tools.sectionPanel.element,
        this.tools.pathPanel.element,
        this.past.panel.element,
        ...this.status.elements,
      ),
      this.commands.help.element,
      this.corrections.log.element,
    );
    this.toolbar.setMode(this.state.mode);
    this.listenToKeys();
  }

  /** Loads the map and shows it; faults are shown, never thrown. */
  async start(): Promise<void> {
    try {
      const seen = await waitForFrames(this.status);
      const [info, instances, labels] = await loadObjects();
      this.takeMap(info, instances);
      this.makeView(info);
      this.view?.setLabels(labels);
      this.repaint();
      this.follow(await this.loadSurface(), seen);
    } catch (error) {
      this.status.setBanner(faultText(error));
      this.status.progress(1);
    }
  }

  // ---------------------------------------------------------------------------- what the map is

  private takeMap(info: MapInfo, instances: readonly Instance[]): void {
    this.state.take(info, instances);
    document.title = `${info.title} – ovimap`;
    this.search.setMap(info);
    this.search.setInstances(instances);
  }

  /** Names, guesses or objects changed. */
  private refresh(): Promise<void> {
    return this.refreshes.request();
  }

  private async loadAgain(): Promise<void> {
    const [info, instances, labels] = await loadObjects();
    if (this.state.info?.live && !info.live) this.view?.setCameras(await api.cameras());
    this.takeMap(info, instances);
    this.view?.setLabels(labels);
    this.showList();
    this.repaint();
    await Promise.all([this.past.changed(), this.rooms.changed(), this.gaps.changed()]);
    await this.selection.follow();
  }

  private makeView(info: MapInfo): void {
    try {
      this.view = new MapView(this.canvas, info, {
        onClick: (hit) => {
          if (!this.tools.takeClick(hit)) this.select(hit?.instance ?? 0, false, hit?.label);
        },
        onLost: () => this.status.setBanner('The graphics driver gave up; reload this page.'),
      });
    } catch (error) {
      this.canvas.hidden = true;
      return this.status.setBanner(faultText(error));
    }
    this.tools.view = this.commands.view = this.past.view = this.view;
    this.rooms.view = this.gaps.view = this.view;
    this.camera.view = this.selection.view = this.view;
    this.canvas.after(this.view.measure.label);
    tellWhatPanelsCover(this.view, this.search.element, this.card.element);
  }

  private async loadSurface(): Promise<SurfaceLoader | null> {
    const { view } = this;
    if (!view) {
      this.search.showAll(0);
      this.status.progress(1);
      return null;
    }
    const loader = new SurfaceLoader(
      view,
      (share) => this.status.progress(share),
      (error) => this.status.toast(faultText(error)),
    );
    const cameras = await loader.loadFirst();
    this.tools.pathPanel.setCount(cameras.frames.length);
    await this.mark('first-picture');
    this.showList(); // its pictures wait until the map is there
    await loader.loadAll();
    await this.mark('whole-picture');
    return loader;
  }

  /** For measurements: notes the time when what is there now is drawn. */
  private async mark(name: string): Promise<void> {
    await this.view?.whenDrawn();
    performance.mark(name);
  }

  private follow(loader: SurfaceLoader | null, seen: number): void {
    const failed = (error: unknown): void => this.status.toast(faultText(error));
    const lost = 'The connection to the server is lost; trying again. What is loaded stays usable.';
    const surfaceChanged = async (): Promise<void> => {
      await loader?.followChanges();
      if (this.state.info?.live) this.view?.followGrowth();
    };
    if (this.state.info?.live && !this.tools.isOn('path')) this.tools.toggle('path');
    if (this.state.info?.live) this.camera.show(this.state.info.tracking);
    listen(seen, {
      onMap: () => void this.refresh().catch(failed),
      onMesh: () => void surfaceChanged().catch(failed),
      onFrame: (frame) => this.followCamera(frame),
      onTracking: (tracking) => this.camera.show(tracking),
      onConnection: (connected) => this.status.setBanner(connected ? '' : lost),
    });
  }

  private followCamera(frame: FrameEvent): void {
    this.search.setFrames(frame.frames);
    this.view?.addCamera(frame);
    this.tools.pathPanel.setCount(this.view?.cameraCount ?? 0);
  }

  // ------------------------------------------------------------------------------------ selection

  private select(id: number, fly: boolean, label = 0): void {
    if (!this.corrections.takeSelection(id, label)) this.selection.select(id, fly);
  }

  // --------------------------------------------------------------------------------------- search

  private async ask(question: Question, shown: string): Promise<void> {
    this.asking?.abort();
    const asking = (this.asking = new AbortController());
    this.search.setQuery(shown);
    this.search.showBusy();
    try {
      this.state.answer = await api.query(question, asking.signal);
    } catch (error) {
      if (!asking.signal.aborted) this.search.showFault(faultText(error));
      return;
    }
    if (this.state.mode !== 'heat') this.modeBefore = this.state.mode;
    await this.past.showAnswer(this.state.answer);
    this.select(0, false);
    this.showList();
    this.setMode('heat');
    await this.mark('answer-drawn');
  }

  private clearQuery(): void {
    this.asking?.abort();
    const had = this.state.answer !== null;
    this.state.answer = null;
    void this.past.showAnswer(null);
    this.showList();
    if (had && this.state.mode === 'heat') this.setMode(this.modeBefore);
    else this.repaint();
  }

  private showInstead(show: (() => void) | null): void {
    this.instead = show;
    this.showList();
  }

  /** Selects an object that is there; 0: none. Whether it is. */
  private selectThere(id: number): boolean {
    const there = this.state.instances.has(id);
    this.select(there ? id : 0, false);
    return there;
  }

  private showList(): void {
    const { answer, selected } = this.state;
    if (answer) this.search.showAnswer(answer, selected);
    else if (this.instead) this.instead();
    else this.search.showAll(selected);
  }

  // ----------------------------------------------------------------------------------------- view

  private setMode(mode: Mode): void {
    this.state.mode = mode;
    this.toolbar.setMode(mode);
    this.repaint();
  }

  private repaint(): void {
    const { mode, answer, info } = this.state;
    const instances = [...this.state.instances.values()];
    const ramp = info?.heat_ramp ?? [];
    this.legend.show(mode, instances, ramp, answer?.query ?? '');
    this.view?.paint({ mode, instances, ramp, heat: new Map(answer?.heat ?? []) });
  }

  /** Ends what was begun last: a merge, a tool, the selection, the query. */
  private escape(): void {
    if (this.corrections.endChoice() || this.tools.endLast()) return;
    if (this.state.selected !== 0) return this.select(0, false);
    if (this.state.answer) this.search.reset();
  }

  private listenToKeys(): void {
    const selected = (run: (id: number) => void) => () => {
      if (this.state.selected !== 0) run(this.state.selected);
    };
    listenToKeys({
      '/': () => this.search.focus(),
      '1': () => this.setMode('color'),
      '2': () => this.setMode('instances'),
      '3': () => this.setMode('classes'),
      '4': () => this.setMode('heat'),
      '5': () => this.setMode('evidence'),
      f: selected((id) => this.selection.focus(id)),
      h: selected((id) => void this.corrections.hide(id)),
      u: () => void this.corrections.undo(),
      n: selected(() => this.card.startRename()),
      m: () => this.tools.toggle('measure'),
      x: () => this.tools.toggle('section'),
      c: () => this.tools.toggle('path'),
      r: () => this.tools.toggle('rooms'),
      v: () => this.tools.toggle('history'),
      l: () => this.tools.toggle('gaps'),
      g: () => this.tools.toggle('fly'),
      p: () => this.commands.run('picture'),
      t: () => this.commands.run('theme'),
      Home: () => this.commands.run('home'),
      '?': () => this.commands.run('help'),
      Escape: () => this.escape(),
    });
  }
}
