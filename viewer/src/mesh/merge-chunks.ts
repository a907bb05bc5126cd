// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Chunk, Patch } from './chunk-format';

interface Part {
  from: Chunk;
  patch: Patch;
  firstVertex: number;
  firstTriangle: number;
}

function partsOf(chunk: Chunk): Part[] {
  let firstVertex = 0;
  let firstTriangle = 0;
  return chunk.patches.map((patch) => {
    const part = { from: chunk, patch, firstVertex, firstTriangle };
    firstVertex += patch.vertices;
    firstTriangle += patch.triangles;
    return part;
  });
}

const keyOf = ({ patch }: Part): string => patch.block.join();

/** A chunk with the patches of `update` in the place of those it had; blocks that lost their surface go. */
export function mergeChunks(before: Chunk, update: Chunk): Chunk {
  const fresh = partsOf(update);
  const replaced = new Set(fresh.map(keyOf));
  const kept = partsOf(before).filter((part) => !replaced.has(keyOf(part)));
  const parts = [...kept, ...fresh].filter(({ patch }) => patch.triangles > 0);
  const vertices = parts.reduce((sum, { patch }) => sum + patch.vertices, 0);
  const triangles = parts.reduce((sum, { patch }) => sum + patch.triangles, 0);
  const merged: Chunk = {
    ...update,
    patches: parts.map(({ patch }) => patch),
    positions: new Uint16Array(vertices * 4),
    colors: new Uint8Array(vertices * 4),
    labels: new Uint32Array(vertices),
    indices: new Uint32Array(triangles * 3),
  };
  let vertex = 0;
  let triangle = 0;
  for (const part of parts) {
    copyPart(part, merged, vertex, triangle);
    vertex += part.patch.vertices;
    triangle += part.patch.triangles;
  }
  return merged;
}

function copyPart(part: Part, to: Chunk, vertex: number, triangle: number): void {
  const { from, patch, firstVertex, firstTriangle } = part;
  const vertexEnd = firstVertex + patch.vertices;
  to.positions.set(from.positions.subarray(firstVertex * 4, vertexEnd * 4), vertex * 4);
  to.colors.set(from.colors.subarray(firstVertex * 4, vertexEnd * 4), vertex * 4);
  to.labels.set(from.labels.subarray(firstVertex, vertexEnd), vertex);
  const shift = vertex - firstVertex;
  for (let i = 0; i < patch.triangles * 3; ++i)
    to.indices[triangle * 3 + i] = from.indices[firstTriangle * 3 + i]! + shift;
}
