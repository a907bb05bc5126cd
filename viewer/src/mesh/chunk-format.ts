// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Reads the binary chunks of docs/http-api.md.

export interface Patch {
  block: [number, number, number];
  version: number;
  vertices: number;
  triangles: number;
}

export interface Chunk {
  level: number;
  index: [number, number, number];
  /** The corner with the smallest coordinates, metres in the world. */
  origin: [number, number, number];
  edge_m: number;
  version: number;
  patches: Patch[];
  /** Four numbers a vertex: x, y, z in steps of edge_m / 65535 from the origin, packed normal. */
  positions: Uint16Array;
  /** Four bytes a vertex: red, green, blue, how well the place is known. */
  colors: Uint8Array;
  /** The map's label of each vertex, by which /api/labels tells its object; 0: none. */
  labels: Uint32Array;
  /** Three vertices a triangle. */
  indices: Uint32Array;
}

export const FORMAT_VERSION = 2;
const MAGIC = 0x434d564f; // "OVMC"
const HEADER_BYTES = 56;
const PATCH_BYTES = 28;

function triple(read: (at: number) => number, at: number): [number, number, number] {
  return [read(at), read(at + 4), read(at + 8)];
}

function readPatches(view: DataView, count: number): Patch[] {
  const patches: Patch[] = [];
  for (let i = 0; i < count; ++i) {
    const at = HEADER_BYTES + i * PATCH_BYTES;
    patches.push({
      block: triple((p) => view.getInt32(p, true), at),
      vertices: view.getUint32(at + 12, true),
      triangles: view.getUint32(at + 16, true),
      version: Number(view.getBigUint64(at + 20, true)),
    });
  }
  return patches;
}

/** The arrays are views into `buffer`. Throws when it is no chunk of this format. */
export function decodeChunk(buffer: ArrayBuffer): Chunk {
  const view = new DataView(buffer);
  if (buffer.byteLength < HEADER_BYTES || view.getUint32(0, true) !== MAGIC)
    throw new Error('The server sent something that is no piece of a map.');
  if (view.getUint16(4, true) !== FORMAT_VERSION)
    throw new Error('The server speaks another version than this page; reload the page.');
  const [patchCount, vertices, triangles] = triple((at) => view.getUint32(at, true), 36);
  const positionsAt = HEADER_BYTES + patchCount * PATCH_BYTES;
  const colorsAt = positionsAt + vertices * 8;
  const labelsAt = colorsAt + vertices * 4;
  const indicesAt = labelsAt + vertices * 4;
  if (buffer.byteLength !== indicesAt + triangles * 12)
    throw new Error('A piece of the map arrived incomplete; reload the page.');
  return {
    level: view.getUint16(6, true),
    index: triple((at) => view.getInt32(at, true), 8),
    origin: triple((at) => view.getFloat32(at, true), 20),
    edge_m: view.getFloat32(32, true),
    version: Number(view.getBigUint64(48, true)),
    patches: readPatches(view, patchCount),
    positions: new Uint16Array(buffer, positionsAt, vertices * 4),
    colors: new Uint8Array(buffer, colorsAt, vertices * 4),
    labels: new Uint32Array(buffer, labelsAt, vertices),
    indices: new Uint32Array(buffer, indicesAt, triangles * 3),
  };
}
