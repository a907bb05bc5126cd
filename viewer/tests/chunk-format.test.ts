// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { decodeChunk } from '../src/mesh/chunk-format';

/** The same file that the server's tests write and compare. */
function shared(): ArrayBuffer {
  const bytes = readFileSync(new URL('../../tests/chunks/two_patches.bin', import.meta.url));
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) as ArrayBuffer;
}

test('reads what the server writes', () => {
  const chunk = decodeChunk(shared());
  expect(chunk.level).toBe(0);
  expect(chunk.index).toEqual([0, 0, 0]);
  expect(chunk.version).toBe(5);
  expect(chunk.origin.map((value) => value.toFixed(3))).toEqual(['0.005', '0.005', '0.005']);
  expect(chunk.edge_m).toBeCloseTo(1.28);
  expect(chunk.patches).toEqual([
    { block: [0, 0, 0], version: 5, vertices: 4, triangles: 2 },
    { block: [1, 2, 3], version: 3, vertices: 3, triangles: 1 },
  ]);
  expect([...chunk.positions.slice(4, 7)]).toEqual([32768, 0, 0]);
  expect(chunk.positions[14]).toBe(65535);
  expect([...chunk.colors.slice(8, 12)]).toEqual([0, 0, 255, 0]);
  expect([...chunk.labels]).toEqual([1, 1, 70000, 0, 2, 2, 2]);
  expect([...chunk.indices]).toEqual([0, 1, 2, 0, 2, 3, 6, 5, 4]);
});

test('unfolds normals as the shader does', () => {
  const { positions } = decodeChunk(shared());
  const unfold = (bits: number): number[] => {
    let [x, y] = [bits >> 8, bits & 255].map((value) => (value / 255) * 2 - 1) as [number, number];
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0)
      [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
    const length = Math.hypot(x, y, z);
    return [x / length, y / length, z / length];
  };
  const expected = [
    [0, 0, 1],
    [1, 0, 0],
    [0, -1, 0],
    [0, 0, -1],
    [0.6, 0, 0.8],
    [-0.6, 0, -0.8],
    [0, 0.6, -0.8],
  ];
  expected.forEach((normal, vertex) => {
    const found = unfold(positions[vertex * 4 + 3]!);
    normal.forEach((value, axis) => expect(found[axis]).toBeCloseTo(value, 1));
  });
});

test('refuses what is damaged', () => {
  const good = shared();
  expect(() => decodeChunk(good.slice(0, 20))).toThrow('no piece');
  expect(() => decodeChunk(good.slice(0, good.byteLength - 4))).toThrow('incomplete');
  const other = good.slice(0);
  new DataView(other).setUint16(4, 9, true);
  expect(() => decodeChunk(other)).toThrow('version');
  new DataView(other).setUint32(0, 1, true);
  expect(() => decodeChunk(other)).toThrow('no piece');
});
