// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';
import { ApiError, api } from '../src/api/client';
import { forEachAtOnce } from '../src/mesh/chunk-loader';
import { suggest, vocabularyOf } from '../src/ui/suggestions';
import {
  approachText,
  isGuess,
  lastSeenText,
  percent,
  placeOf,
  plural,
  sizeOf,
  titleOf,
  withTitles,
} from '../src/ui/words';
import { instance } from './instance-fixture';

const guess = (name: string): { name: string; cosine: number } => ({ name, cosine: 0.4 });
const mug = instance(12, { name: 'my mug', guesses: [guess('cup')] });
const table = instance(3, {
  label: { name: 'table', share: 0.6 },
  guesses: [guess('table'), guess('desk')],
});
const unclear = instance(5, { label: { name: 'object', share: 0 }, guesses: [guess('dish rack')] });

describe('words', () => {
  test('an object is called by its name, what it clearly is, or its number', () => {
    expect(titleOf(mug)).toBe('my mug');
    expect(isGuess(mug)).toBe(false);
    expect(titleOf(table)).toBe('table');
    expect(isGuess(table)).toBe(true);
    expect(titleOf(instance(7))).toBe('Object 7');
    expect(titleOf(unclear)).toBe('Object 5');
    expect(isGuess(unclear)).toBe(false);
  });

  test('numbers of the server become names', () => {
    const find = (id: number) => [mug, table].find((entry) => entry.id === id);
    expect(withTitles('0.02 m above the top of #3, near #99', find)).toBe(
      '0.02 m above the top of table #3, near #99',
    );
  });

  test('figures read well', () => {
    expect(percent(0.876)).toBe('88 %');
    expect(percent(null)).toBe('');
    expect(plural(1, 'object')).toBe('1 object');
    expect(plural(2345, 'object')).toBe('2,345 objects');
    expect(sizeOf(table)).toBe('1.00 × 2.00 × 3.00 m');
    expect(placeOf(table)).toBe('0.50, 1.00, 1.50');
  });
});

describe('suggestions', () => {
  const words = vocabularyOf([mug, table, instance(4, { guesses: [guess('table')] })]);

  test('names and frequent classes come first', () => {
    expect(words).toEqual(['table', 'my mug', 'cup', 'desk']);
  });

  test('the last part of a phrase is completed', () => {
    expect(suggest('ta', words, [])).toEqual(['table']);
    expect(suggest('cup on the t', words, [])).toEqual(['cup on the table']);
    expect(suggest('cup, d', words, [])).toEqual(['cup, desk']);
    expect(suggest('table', words, [])).toEqual([]);
    expect(suggest('zebra', words, [])).toEqual([]);
  });

  test('recent queries are offered before anything is typed', () => {
    expect(suggest('', words, ['elephant'])[0]).toBe('elephant');
    expect(suggest('', [], [])).toEqual(['largest object']);
    expect(suggest('ele', words, ['elephant'])).toEqual(['elephant']);
  });
});

describe('requests', () => {
  test("a refusal is said in the server's words", async () => {
    globalThis.fetch = async () => new Response('{"error":"no such object"}', { status: 404 });
    await expect(api.instance(7)).rejects.toThrow('no such object');
    globalThis.fetch = async () => new Response('<html>', { status: 502 });
    await expect(api.map()).rejects.toThrow('error 502');
    globalThis.fetch = async () => Promise.reject(new TypeError('failed to fetch'));
    await expect(api.map()).rejects.toThrow(/does not answer/);
    await expect(api.map()).rejects.toBeInstanceOf(ApiError);
  });

  test('work is done a few at once, all of it, and faults come out', async () => {
    let running = 0;
    let most = 0;
    const done: number[] = [];
    await forEachAtOnce([1, 2, 3, 4, 5], 2, async (item) => {
      most = Math.max(most, ++running);
      await new Promise((resolve) => setTimeout(resolve));
      --running;
      done.push(item);
    });
    expect(most).toBe(2);
    expect(done.sort()).toEqual([1, 2, 3, 4, 5]);
    await expect(forEachAtOnce([1], 2, async () => Promise.reject(new Error('x')))).rejects.toThrow(
      'x',
    );
  });
});

test('a robot hears where to stand, or why it cannot', () => {
  const pose = {
    seen: 0.64,
    distance_m: 0.86,
    position: [0, 0, 0] as [number, number, number],
    direction: [1, 0, 0] as [number, number, number],
    way_m: 2.04,
    way_in_world: [
      [0, 0, 0],
      [2, 0, 0],
    ] as [number, number, number][],
  };
  expect(approachText({ poses: [pose], reason: '' })).toBe(
    '64 % of it is seen from 0.86 m, 2.0 m to go',
  );
  expect(approachText({ poses: [{ ...pose, way_in_world: [] }], reason: '' })).toBe(
    '64 % of it is seen from 0.86 m',
  );
  expect(approachText({ poses: [], reason: 'no way' })).toBe('It cannot be reached: no way');
});

test('says when an object was seen last where that tells something', () => {
  const seen = (visit: number, visits: number, time_s: number | null) =>
    lastSeenText(instance(1, { last_seen: { visit, visits, time_s } }));
  expect(lastSeenText(instance(1))).toBe('');
  expect(seen(1, 1, null)).toBe('');
  expect(seen(2, 3, null)).toBe('visit 2 of 3');
  expect(seen(1, 1, 1_773_480_600)).toMatch(/^14 Mar 2026/);
  expect(seen(2, 3, 1_773_480_600)).toMatch(/^visit 2 of 3, 14 Mar 2026/);
});
