// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Cameras, MeshListing } from './api/types';
import { chunkKey, loadChunks } from './mesh/chunk-loader';
import type { MapView } from './scene/map-view';

const COARSE = 1;
const FINE = 0;

/** Fetches the surface: the coarse level for the first picture, then all of it, then what changed. */
export class SurfaceLoader {
  private version = 0;

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
    const surface = loadChunks(
      COARSE,
      coarse.chunks,
      (chunk, at) => view.put(chunkKey(at), chunk),
      () => this.onProgress(0.05),
    );
    const [cameras] = await Promise.all([api.cameras(), surface]);
    view.setCameras(cameras);
    view.frameAll(false);
    view.holdStill(false);
    return cameras;
  }

  async loadAll(): Promise<void> {
    const fine = await api.chunks(FINE);
    this.version = fine.version;
    await loadChunks(
      FINE,
      fine.chunks,
      (chunk, at) => this.view.put(chunkKey(at), chunk),
      (done, total) => this.onProgress(total === 0 ? 1 : done / total),
    );
    this.onProgress(1);
    this.view.surface.keepOnly(new Set(fine.chunks.map(chunkKey)));
    this.view.surfaceChanged();
  }

  async followChanges(): Promise<void> {
    const info = await api.map();
    if (info.mesh_version > this.version) await this.loadAll();
  }
}
