// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';
import { Rounds } from '../src/rounds';

const begun = (): Promise<void> => new Promise((resolve) => setTimeout(resolve, 20));

test('requests during a round share the next one', async () => {
  let began = 0;
  let release = (): void => undefined;
  const rounds = new Rounds(
    () => {
      ++began;
      return new Promise((resolve) => (release = resolve));
    },
    () => 0,
  );
  const first = rounds.request();
  await begun();
  const later = [rounds.request(), rounds.request(), rounds.request()];
  await begun();
  expect(began).toBe(1);
  release();
  await first;
  await begun();
  expect(began).toBe(2);
  release();
  await Promise.all(later);
  expect(began).toBe(2);
});

test('a round that fails does not end them', async () => {
  let fails = true;
  let done = 0;
  const rounds = new Rounds(
    async () => {
      if (fails) throw new Error('gone');
      ++done;
    },
    () => 0,
  );
  await expect(rounds.request()).rejects.toThrow('gone');
  fails = false;
  await rounds.request();
  expect(done).toBe(1);
});

test('a request is done after its own round, however many follow', async () => {
  let began = 0;
  const rounds: Rounds = new Rounds(
    async () => {
      ++began;
      if (began < 9) void rounds.request(); // as a map that grows does all the time
      await begun();
    },
    () => 40,
  );
  await rounds.request();
  expect(began).toBe(1);
  const since = performance.now();
  await rounds.request();
  expect(began).toBe(2);
  expect(performance.now() - since).toBeGreaterThan(35);
});
