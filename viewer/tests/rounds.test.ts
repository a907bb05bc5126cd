// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';
import { Rounds } from '../src/rounds';

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
  for (let i = 0; i < 5; ++i) void rounds.request();
  expect(began).toBe(1);
  release();
  await new Promise((resolve) => setTimeout(resolve, 20));
  expect(began).toBe(2);
  release();
  await first;
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
