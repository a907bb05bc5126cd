// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  Group,
  IntType,
  Mesh,
  type RawShaderMaterial,
  Sphere,
  Vector3,
} from 'three';
import { type Chunk } from '../mesh/chunk-format';
import { mergeChunks } from '../mesh/merge-chunks';
import { LabelTable } from './label-table';
import { surfaceMaterial } from './surface-material';

const STEPS = 65535;
const SAMPLE_STEP = 29; // vertices

/** The box of the vertices within the chunk's unit cube. */
function boxOf(positions: Uint16Array): Box3 {
  const low = [STEPS, STEPS, STEPS];
  const high = [0, 0, 0];
  for (let at = 0; at < positions.length; at += 4)
    for (let axis = 0; axis < 3; ++axis) {
      const value = positions[at + axis]!;
      if (value < low[axis]!) low[axis] = value;
      if (value > high[axis]!) high[axis] = value;
    }
  const corner = (values: number[]): Vector3 => new Vector3(...values).divideScalar(STEPS);
  return new Box3(corner(low), corner(high));
}

function geometryOf(chunk: Chunk): BufferGeometry {
  const geometry = new BufferGeometry();
  const labels = new BufferAttribute(chunk.labels, 1);
  labels.gpuType = IntType;
  geometry.setAttribute('position', new BufferAttribute(chunk.positions, 4, true));
  geometry.setAttribute('color', new BufferAttribute(chunk.colors, 4, true));
  geometry.setAttribute('label', labels);
  geometry.setIndex(new BufferAttribute(chunk.indices, 1));
  geometry.boundingBox = boxOf(chunk.positions);
  geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
  return geometry;
}

/** The map's surface: chunks in up to three levels, of which one is drawn. */
export class Surface {
  readonly group = new Group();
  readonly table = new LabelTable();
  readonly material: RawShaderMaterial;
  private texture: DataTexture;
  private readonly chunks = new Map<string, (Mesh | undefined)[]>();
  private readonly whole = new Map<string, Chunk>(); // of level 0, for updates
  private coarse = false;
  private nearby: ReadonlySet<string> = new Set(); // show level 1 where there are few triangles

  constructor() {
    this.texture = this.makeTexture();
    this.material = surfaceMaterial(this.texture);
  }

  tableChanged(): void {
    if (this.texture.image.height !== this.table.height) {
      this.texture.dispose();
      this.texture = this.makeTexture();
      this.material.uniforms.labelColors!.value = this.texture;
    }
    this.texture.needsUpdate = true;
  }

  /** Takes what changed of a chunk: some patches, or all of them. */
  update(key: string, update: Chunk): void {
    const before = this.whole.get(key);
    this.put(key, update.level === 0 && before ? mergeChunks(before, update) : update);
  }

  private put(key: string, chunk: Chunk): void {
    const levels = this.chunks.get(key) ?? [];
    const old = levels[chunk.level];
    if (old) this.drop(old);
    delete levels[chunk.level];
    this.chunks.set(key, levels);
    if (chunk.level === 0) this.whole.set(key, chunk);
    if (chunk.indices.length > 0) this.add(levels, chunk);
    this.choose(key, levels);
  }

  /** A level of a chunk is not needed any more. */
  forget(key: string, level: number): void {
    const levels = this.chunks.get(key);
    const mesh = levels?.[level];
    if (level === 0) this.whole.delete(key);
    if (!levels || !mesh) return;
    this.drop(mesh);
    delete levels[level];
    this.choose(key, levels);
  }

  private add(levels: (Mesh | undefined)[], chunk: Chunk): void {
    const mesh = new Mesh(geometryOf(chunk), this.material);
    mesh.position.set(...chunk.origin);
    mesh.scale.setScalar(chunk.edge_m);
    mesh.matrixAutoUpdate = false;
    mesh.updateMatrix();
    levels[chunk.level] = mesh;
    this.group.add(mesh);
    mesh.updateMatrixWorld();
  }

  /** Few triangles, where there are such: while the view moves on slow machines. */
  showCoarse(coarse: boolean): void {
    if (coarse === this.coarse) return;
    this.coarse = coarse;
    this.chooseAll();
  }

  /** Chunks that then show level 1; the others show less. */
  showWhileMoving(nearby: ReadonlySet<string>): void {
    this.nearby = nearby;
    if (this.coarse) this.chooseAll();
  }

  box(): Box3 {
    const box = new Box3();
    for (const levels of this.chunks.values()) {
      const mesh = levels[0] ?? levels[1] ?? levels[2];
      if (!mesh?.geometry.boundingBox) continue;
      box.union(mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrix));
    }
    return box;
  }

  /** Points all over the surface. */
  samples(): Vector3[] {
    const samples: Vector3[] = [];
    for (const levels of this.chunks.values()) {
      const mesh = levels[2] ?? levels[1] ?? levels[0];
      const position = mesh?.geometry.getAttribute('position');
      for (let v = 0; mesh && position && v < position.count; v += SAMPLE_STEP)
        samples.push(new Vector3().fromBufferAttribute(position, v).applyMatrix4(mesh.matrix));
    }
    return samples;
  }

  private makeTexture(): DataTexture {
    const texture = new DataTexture(this.table.pixels, this.table.width, this.table.height);
    texture.needsUpdate = true;
    return texture;
  }

  private chooseAll(): void {
    for (const [key, levels] of this.chunks) this.choose(key, levels);
  }

  private choose(key: string, levels: (Mesh | undefined)[]): void {
    const [all, some, few] = levels;
    const finest = all ?? some ?? few;
    const moving = this.nearby.has(key) ? (some ?? few ?? all) : (few ?? some ?? all);
    const shown = this.coarse ? moving : finest;
    for (const mesh of levels) if (mesh) mesh.visible = mesh === shown;
  }

  private drop(mesh: Mesh): void {
    this.group.remove(mesh);
    mesh.geometry.dispose();
  }
}
