// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';
import type { Chunk } from '../src/mesh/chunk-format';
import { mergeChunks } from '../src/mesh/merge-chunks';

/** A triangle for each block that is named, all of whose numbers are the block's. */
function chunk(version: number, blocks: readonly [number, boolean][]): Chunk {
  const full = blocks.filter(([, hasSurface]) => hasSurface).map(([block]) => block);
  const each = (count: number): number[] => full.flatMap((block) => Array(count).fill(block));
  return {
    level: 0,
    index: [0, 0, 0],
    origin: [0, 0, 0],
    edge_m: 1,
    version,
    patches: blocks.map(([block, hasSurface]) => ({
      block: [block, 0, 0],
      version,
      vertices: hasSurface ? 3 : 0,
      triangles: hasSurface ? 1 : 0,
    })),
    positions: new Uint16Array(each(12)),
    colors: new Uint8Array(each(12)),
    labels: new Uint32Array(each(3)),
    indices: new Uint32Array(full.flatMap((_, i) => [3 * i, 3 * i + 1, 3 * i + 2])),
  };
}

test('patches are replaced, added and taken away', () => {
  const before = chunk(1, [
    [1, true],
    [2, true],
    [3, true],
  ]);
  const merged = mergeChunks(
    before,
    chunk(2, [
      [2, false],
      [3, true],
      [4, true],
    ]),
  );
  expect(merged.version).toBe(2);
  expect(merged.patches.map(({ block, version }) => [block[0], version])).toEqual([
    [1, 1],
    [3, 2],
    [4, 2],
  ]);
  expect([...merged.labels]).toEqual([1, 1, 1, 3, 3, 3, 4, 4, 4]);
  expect([...merged.indices]).toEqual([0, 1, 2, 3, 4, 5, 6, 7, 8]);
  expect(merged.positions.length).toBe(36);
  expect(merged.colors[35]).toBe(4);
});

test('a chunk may lose all its surface, and get some again', () => {
  const empty = mergeChunks(chunk(1, [[1, true]]), chunk(2, [[1, false]]));
  expect(empty.indices.length).toBe(0);
  expect([...mergeChunks(empty, chunk(3, [[5, true]])).labels]).toEqual([5, 5, 5]);
});
