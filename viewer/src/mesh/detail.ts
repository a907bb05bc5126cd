// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Which chunks a view needs, and in how much detail.

export const LEVELS = 3; // 0: all triangles; 1 and 2: a tenth each time

const MOST_TRIANGLES = 4e6; // what computers of these days draw thirty times a second
const MOST_WHILE_MOVING = 3e5; // the same of a processor without a graphics card

/** A chunk as it is seen from where the camera is. */
export interface SeenChunk {
  key: string;
  distance: number;
  inView: boolean;
  /** By level; undefined where there is none. */
  triangles: readonly (number | undefined)[];
}

export interface Wanted {
  key: string;
  level: number;
}

export interface Detail {
  /** What to have, what is needed most first. */
  wanted: Wanted[];
  /** Chunks that show level 1 while the view moves on a slow machine; the others are shown coarser. */
  whileMoving: Set<string>;
}

/** What is in view comes first, and what is near. */
function byNeed(a: SeenChunk, b: SeenChunk): number {
  return Number(b.inView) - Number(a.inView) || a.distance - b.distance;
}

/** The first chunks whose triangles at a level are within a budget; and what of it is left. */
function within(chunks: readonly SeenChunk[], level: number, budget: number): [Wanted[], number] {
  const wanted: Wanted[] = [];
  let left = budget;
  for (const { key, triangles } of chunks) {
    const count = triangles[level];
    if (count === undefined) continue;
    if (count > left) break;
    left -= count;
    wanted.push({ key, level });
  }
  return [wanted, left];
}

function coarsestOf(triangles: SeenChunk['triangles']): number {
  let level = triangles.length - 1;
  while (level > 0 && triangles[level] === undefined) --level;
  return level;
}

/**
 * All chunks at their coarsest level, so that nothing is missing; of half of what can be drawn level 1, and of the rest
 * all triangles.
 */
export function detailOf(chunks: readonly SeenChunk[], most = MOST_TRIANGLES): Detail {
  const order = [...chunks].sort(byNeed);
  const wanted = order.map(({ key, triangles }) => ({ key, level: coarsestOf(triangles) }));
  const coarsest = new Set(wanted.map(({ key, level }) => `${key}/${level}`));
  const [some, left] = within(order, 1, most / 2);
  const [all] = within(order, 0, most / 2 + left);
  const [moving] = within(order, 1, MOST_WHILE_MOVING);
  const finer = [...some, ...all].filter(({ key, level }) => !coarsest.has(`${key}/${level}`));
  return { wanted: [...wanted, ...finer], whileMoving: new Set(moving.map(({ key }) => key)) };
}
