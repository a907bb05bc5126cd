// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';
import { type SeenChunk, detailOf } from '../src/mesh/detail';

/** A row of chunks, each a metre farther away than the one before. */
function row(count: number, triangles: SeenChunk['triangles']): SeenChunk[] {
  return Array.from({ length: count }, (_, i) => ({
    key: String(i),
    distance: i,
    inView: true,
    triangles,
  }));
}

const atLevel = (chunks: readonly SeenChunk[], level: number, most: number): string[] =>
  detailOf(chunks, most)
    .wanted.filter((wanted) => wanted.level === level)
    .map(({ key }) => key);

describe('detail', () => {
  test('a small map is there in full', () => {
    const chunks = row(10, [1000, 100, 10]);
    for (const level of [0, 1, 2]) expect(atLevel(chunks, level, 1e6)).toHaveLength(10);
  });

  test('of a large one all is there, most of it in little detail', () => {
    const chunks = row(1000, [1000, 100, 10]);
    expect(atLevel(chunks, 2, 20000)).toHaveLength(1000);
    expect(atLevel(chunks, 1, 20000)).toEqual(chunks.slice(0, 100).map(({ key }) => key));
    expect(atLevel(chunks, 0, 20000)).toEqual(chunks.slice(0, 10).map(({ key }) => key));
  });

  test('what is in view comes before what is nearer', () => {
    const chunks = row(6, [1000, 100, 10]).map((chunk, i) => ({ ...chunk, inView: i > 3 }));
    expect(atLevel(chunks, 0, 3000)).toEqual(['4', '5']);
  });

  test('what has one level is there at that', () => {
    const chunks = row(5, [1000]);
    expect(detailOf(chunks, 2000).wanted).toEqual(chunks.map(({ key }) => ({ key, level: 0 })));
  });

  test('all is wanted in the order of need, the coarsest first', () => {
    const levels = detailOf(row(3, [1000, 100, 10]), 1e6).wanted.map(({ level }) => level);
    expect(levels).toEqual([2, 2, 2, 1, 1, 1, 0, 0, 0]);
  });

  test('while the view moves only what is near keeps some detail', () => {
    const { whileMoving } = detailOf(row(1000, [10000, 1000, 100]));
    expect(whileMoving.size).toBe(300);
    expect(whileMoving.has('0')).toBe(true);
  });
});
