// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Cameras, ChunkListing } from './api/types';
import { decodeChunk } from './mesh/chunk-format';
import { chunkKey, forEachAtOnce } from './mesh/chunk-loader';
import { LEVELS, type Wanted, detailOf } from './mesh/detail';
import { Rounds } from './rounds';
import type { MapView } from './scene/map-view';

const AT_ONCE = 6; // what browsers allow for one server
const USUAL_TRIANGLES = [50_000, 5_000, 500]; // by level, of a chunk that was not made yet
const FIRST_PICTURE_MS = 500; // what came by then is shown

/** A chunk that the server has, and what of it is here. */
interface Known {
  /** By level; undefined where there is none. */
  listed: (ChunkListing | undefined)[];
  /** Versions by level; 0: it is not here. */
  loaded: number[];
}

/** Fetches the surface: very few triangles of all of it for the first picture, then more where the view needs them. */
export class SurfaceLoader {
  private readonly versions = new Array<number>(LEVELS).fill(0);
  private readonly chunks = new Map<string, Known>();
  private edge_m = 1;
  private readonly rounds = new Rounds(
    () => this.catchUp(),
    () => 0,
  );
  private listing = true;
  private coarsest: Promise<void> = Promise.resolve();
  private moves = 0; // of the view, since the page was opened

  constructor(
    private readonly view: MapView,
    private readonly onProgress: (share: number) => void,
    private readonly onFault: (error: unknown) => void,
  ) {}

  /** Returns from where the map was seen. */
  async loadFirst(): Promise<Cameras> {
    const { view } = this;
    view.holdStill(true);
    await this.list(LEVELS - 1);
    if (this.chunks.size === 0) await this.list(0); // it is being made
    this.onProgress(0.05);
    this.coarsest = this.load(detailOf(this.seen()).wanted);
    const cameras = await api.cameras();
    view.setCameras(cameras);
    const soon = new Promise<void>((resolve) => setTimeout(resolve, FIRST_PICTURE_MS));
    await Promise.race([this.coarsest, soon]);
    view.frameAll(false);
    view.holdStill(false);
    return cameras;
  }

  /** All that the view needs, and from now on what it needs where it goes. */
  async loadAll(): Promise<void> {
    await this.coarsest; // then all chunks are made, and their totals known
    this.view.followGrowth();
    await this.rounds.request();
    this.view.onRest = () => void this.refine().catch(this.onFault);
  }

  /** Brings the surface up to date. */
  followChanges(): Promise<void> {
    this.listing = true;
    return this.rounds.request();
  }

  /** The view came to rest somewhere. */
  private refine(): Promise<void> {
    ++this.moves;
    return this.rounds.request();
  }

  private async catchUp(): Promise<void> {
    if (this.listing) {
      this.listing = false;
      for (let level = 0; level < LEVELS; ++level) await this.list(level);
    }
    const { wanted, whileMoving } = detailOf(this.seen());
    this.view.surface.showWhileMoving(whileMoving);
    await this.load(wanted);
    this.onProgress(1);
    this.letGo(wanted);
    this.view.surfaceChanged();
  }

  /** Learns what is new. */
  private async list(level: number): Promise<void> {
    const listing = await api.chunks(level, this.versions[level]);
    this.versions[level] = listing.version;
    this.edge_m = listing.chunk_edge_m;
    for (const chunk of listing.chunks) {
      const key = chunkKey(chunk);
      const known = this.chunks.get(key) ?? { listed: [], loaded: new Array(LEVELS).fill(0) };
      known.listed[level] = chunk;
      this.chunks.set(key, known);
    }
  }

  private seen() {
    const look = this.view.look();
    return [...this.chunks].map(([key, { listed }]) => ({
      key,
      ...look(listed.find((at) => at !== undefined)!, this.edge_m),
      triangles: Array.from(listed, (at, level) => at && (at.triangles ?? USUAL_TRIANGLES[level])),
    }));
  }

  private async load(wanted: readonly Wanted[]): Promise<void> {
    const missing = wanted.filter(({ key, level }) => {
      const { listed, loaded } = this.chunks.get(key)!;
      return listed[level]!.version > loaded[level]!;
    });
    const { moves } = this;
    let done = 0;
    await forEachAtOnce(missing, AT_ONCE, async ({ key, level }) => {
      if (this.moves !== moves) return; // something else is needed by now
      const known = this.chunks.get(key)!;
      const listed = known.listed[level]!;
      const chunk = decodeChunk(await api.chunk(level, listed, known.loaded[level]!));
      known.loaded[level] = listed.version;
      this.view.put(key, chunk);
      this.onProgress(0.05 + (0.95 * ++done) / missing.length);
    });
  }

  /** Forgets what is not needed, or not true any more. */
  private letGo(wanted: readonly Wanted[]): void {
    const needed = new Set(wanted.map(({ key, level }) => `${key}/${level}`));
    for (const [key, { loaded }] of this.chunks)
      for (let level = 0; level < LEVELS; ++level) {
        if (loaded[level] === 0 || needed.has(`${key}/${level}`)) continue;
        loaded[level] = 0;
        this.view.surface.forget(key, level);
      }
  }
}
