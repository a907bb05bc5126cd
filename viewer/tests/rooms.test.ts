// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from 'three';
import { describe, expect, test } from 'vitest';
import type { Point, Room } from '../src/api/types';
import { floorShape, outlineEdges, roomBox, roomColor } from '../src/scene/room-marks';

const UP = new Vector3(0, 0, 1);

function square(low: number, high: number): Point[] {
  return [
    [low, low, -1],
    [high, low, -1],
    [high, high, -1],
    [low, high, -1],
  ];
}

const ROOM: Room = {
  id: 1,
  name: 'kitchen',
  area_m2: 12,
  center: [1, 1, -1],
  outline: [square(0, 4), square(1, 2)],
  objects: [3],
};

describe('rooms', () => {
  test('a border runs around the room and what stands in it, above the floor', () => {
    const edges = outlineEdges(ROOM, UP);
    expect(edges).toHaveLength(16);
    expect(edges[1]).toEqual(edges[2]);
    expect(edges[7]).toEqual(edges[0]);
    expect(edges.every(({ z }) => z > -1 && z < -0.9)).toBe(true);
  });

  test('its floor has holes', () => {
    const shape = floorShape(ROOM, UP);
    expect(shape.getPoints()).toHaveLength(4);
    expect(shape.holes).toHaveLength(1);
  });

  test('one looks at all of it', () => {
    const box = roomBox(ROOM, UP);
    expect(box.min).toEqual(new Vector3(0, 0, -1));
    expect(box.max.x).toBe(4);
    expect(box.max.z).toBeCloseTo(0.8);
    expect(roomBox({ ...ROOM, outline: [] }, UP).min.x).toBe(1);
  });

  test('colours differ from room to room', () => {
    expect(roomColor(ROOM)).not.toEqual(roomColor({ ...ROOM, id: 2 }));
    expect(roomColor({ ...ROOM, id: 9 })).toEqual(roomColor(ROOM));
  });
});
