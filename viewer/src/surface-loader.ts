// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Cameras, MeshListing } from './api/types';
import { chunkKey, loadChunks, type ProgressListener } from './mesh/chunk-loader';
import { Rounds } from './rounds';
import type { MapView } from './scene/map-view';

const COARSE = 1;
const FINE = 0;

/** Fetches the surface: the coarse level for the first picture, then all of it, then what changed. */
export class SurfaceLoader {
  private readonly versions = [0, 0]; // by level
  private readonly rounds = new Rounds(
    () => this.takeChanges(),
    () => 0,
  );

  constructor(
    private readonly view: MapView,
    private readonly onProgress: (share: number) => void,
  ) {}

  static coarse(): Promise<MeshListing> {
    return api.chunks(COARSE);
  }

  /** The first picture, in one go. Returns from where the map was seen. */
  async loadFirst(coarse: MeshListing): Promise<Cameras> {
    const { view } = this;
    view.holdStill(true);
    const surface = this.take(coarse, () => this.onProgress(0.05));
    const [cameras] = await Promise.all([api.cameras(), surface]);
    view.setCameras(cameras);
    view.frameAll(false);
    view.holdStill(false);
    return cameras;
  }

  async loadAll(): Promise<void> {
    await this.take(await api.chunks(FINE), (done, total) =>
      this.onProgress(total === 0 ? 1 : done / total),
    );
    this.onProgress(1);
    this.view.surfaceChanged();
  }

  /** Brings the surface up to date. */
  followChanges(): Promise<void> {
    return this.rounds.request();
  }

  private async takeChanges(): Promise<void> {
    for (const level of [FINE, COARSE])
      await this.take(await api.chunks(level, this.versions[level]), () => undefined);
    this.view.surfaceChanged();
  }

  private async take(listing: MeshListing, onProgress: ProgressListener): Promise<void> {
    const since = this.versions[listing.level]!;
    await loadChunks(
      listing.level,
      listing.chunks,
      since,
      (chunk, at) => this.view.put(chunkKey(at), chunk),
      onProgress,
    );
    this.versions[listing.level] = listing.version;
  }
}
