// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Box3, Vector3 } from 'three';
import { describe, expect, test } from 'vitest';
import type { Box, HistoryEvent } from '../src/api/types';
import { Ghosts, placeOf, pointColors } from '../src/scene/ghosts';
import { LabelTable } from '../src/scene/label-table';
import { goneBy, stateAfter } from '../src/scene/past-states';
import { eventText, eventTitle, visitText } from '../src/ui/words';

function box(x: number): Box {
  return { min: [x, 0, 0], max: [x + 1, 1, 1] };
}

function event(id: number, more: Partial<HistoryEvent>): HistoryEvent {
  return {
    id,
    instance: id,
    name: '',
    label: '',
    event: 'moved',
    visit: 2,
    time_s: null,
    before: box(0),
    after: box(3),
    may_be: null,
    surface: true,
    crop: false,
    ...more,
  };
}

const EVENTS = [
  event(1, { instance: 5 }),
  event(2, { instance: 6, event: 'appeared', before: null }),
  event(3, { instance: 5, visit: 3, before: box(3), after: box(7) }),
  event(4, { instance: 8, event: 'gone', visit: 3, after: null }),
];

describe('the map as it was', () => {
  test('the first event after a visit tells what was there', () => {
    const first = stateAfter(EVENTS, 1);
    expect([...first.absent].sort()).toEqual([5, 6]);
    expect(first.present.map(({ id }) => id)).toEqual([1, 4]);
    const second = stateAfter(EVENTS, 2);
    expect([...second.absent]).toEqual([5]);
    expect(second.present.map(({ id }) => id)).toEqual([3, 4]);
    const now = stateAfter(EVENTS, 3);
    expect(now.absent.size + now.present.length).toBe(0);
  });

  test('what left its place by then', () => {
    expect(goneBy(EVENTS, 2).map(({ id }) => id)).toEqual([1]);
    expect(goneBy(EVENTS, 3).map(({ id }) => id)).toEqual([1, 3, 4]);
  });

  test('what is left out is not drawn, and comes back', () => {
    const table = new LabelTable();
    table.setLabels({ version: 1, instances: [0, 5, 6], hidden: [6] });
    table.leaveOut(new Set([5]));
    expect([1, 2].map((label) => table.isHidden(label))).toEqual([true, true]);
    table.leaveOut(new Set());
    expect([1, 2].map((label) => table.isHidden(label))).toEqual([false, true]);
  });
});

describe('ghosts', () => {
  test('are drawn as they are asked for', () => {
    const ghosts = new Ghosts();
    for (const id of [1, 4])
      ghosts.add(id, { instance: id, points: [0, 0, 0], colors: [255, 0, 0] });
    ghosts.show(new Map([[4, { faint: true }]]));
    expect(ghosts.group.children.map(({ visible }) => visible)).toEqual([false, true]);
    ghosts.clear();
    expect(ghosts.group.children).toHaveLength(0);
    expect(ghosts.has(4)).toBe(false);
  });

  test('colours that nobody knows are grey', () => {
    const colors = pointColors([255, 0, 0, 0, 0, 0]);
    expect([...colors.slice(0, 3)]).toEqual([1, 0, 0]);
    expect(colors[3]).toBeGreaterThan(0.2);
    expect(colors[3]).toBe(colors[4]);
  });

  test('one looks where it is, else where it was', () => {
    expect(placeOf(EVENTS[0]!)).toEqual(new Box3(new Vector3(3, 0, 0), new Vector3(4, 1, 1)));
    expect(placeOf(EVENTS[3]!)!.min.x).toBe(0);
  });
});

describe('changes in words', () => {
  test('say what happened', () => {
    expect(EVENTS.map(eventText)).toEqual(['moved 3.00 m', 'new', 'moved 4.00 m', 'gone']);
    expect(eventText(event(9, { event: 'appeared', may_be: 4 }))).toBe('new, may be Object 4');
    expect(eventTitle(event(9, {}))).toBe('Object 9');
    expect(eventTitle(event(9, { label: 'mug' }))).toBe('mug');
    expect(eventTitle(event(9, { label: 'object', name: 'tea pot' }))).toBe('tea pot');
  });

  test('visits have dates where somebody knows them', () => {
    const visit = { visit: 1, source: '', frames: 3, begin_s: null, end_s: null };
    expect(visitText([visit, { ...visit, visit: 2 }], 2)).toBe('visit 2 of 2');
    expect(visitText([{ ...visit, begin_s: 1773648000 }], 1)).toMatch(/^visit 1 of 1, 16 Mar 2026/);
  });
});
