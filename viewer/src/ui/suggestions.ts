// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Instance } from '../api/types';

const MOST = 7;

/** Words that may find something: names and classes of the map, most frequent first. */
export function vocabularyOf(instances: readonly Instance[]): string[] {
  const counts = new Map<string, number>();
  const count = (word: string, weight: number): void => {
    if (word) counts.set(word, (counts.get(word) ?? 0) + weight);
  };
  for (const instance of instances) {
    count(instance.name, 3);
    instance.guesses.forEach((guess, place) => count(guess.name, place === 0 ? 2 : 0.1));
  }
  return [...counts].sort((a, b) => b[1] - a[1] || a[0].localeCompare(b[0])).map(([word]) => word);
}

/** Queries to offer when nothing is typed. */
export function examples(vocabulary: readonly string[]): string[] {
  const [first, second] = vocabulary;
  const list = vocabulary.slice(0, 4);
  if (first && second) list.push(`${second} near the ${first}`);
  list.push('largest object');
  return list;
}

/** What the typed text may become: only its last part (after a comma or a relation) is completed. */
export function suggest(
  typed: string,
  vocabulary: readonly string[],
  recent: readonly string[],
): string[] {
  const text = typed.trimStart();
  if (text === '') return [...new Set([...recent, ...examples(vocabulary)])].slice(0, MOST);
  const { kept, last } = splitLast(text);
  const lower = last.toLowerCase();
  const starts = (word: string): boolean => word.toLowerCase().startsWith(lower);
  const inside = (word: string): boolean => !starts(word) && word.toLowerCase().includes(lower);
  const whole = recent.filter((query) => query.toLowerCase().startsWith(text.toLowerCase()));
  const completed = [...vocabulary.filter(starts), ...vocabulary.filter(inside)].map(
    (word) => kept + word,
  );
  return [...new Set([...whole, ...completed])].filter((entry) => entry !== text).slice(0, MOST);
}

const JOINTS =
  /^(.*(?:,| on the | on | under the | under | near the | near | next to the | next to | above the | above | in the | in )\s*)(.*)$/i;

function splitLast(text: string): { kept: string; last: string } {
  const parts = JOINTS.exec(text);
  return parts ? { kept: parts[1]!, last: parts[2]! } : { kept: '', last: text };
}
