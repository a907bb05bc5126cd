// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Box3, Vector3 } from 'three';
import { describe, expect, test } from 'vitest';
import type { Cameras, Color } from '../src/api/types';
import { arrowEdges, wayEdges } from '../src/scene/approach-marks';
import { frustumEdges, meanDirection, viewpointOfFrame } from '../src/scene/camera-path';
import { paint, rampColor } from '../src/scene/coloring';
import {
  cornersOf,
  groundAxes,
  overviewDirection,
  trimmedBox,
  viewpointOf,
} from '../src/scene/framing';
import { LabelTable, NO_INSTANCE } from '../src/scene/label-table';
import { metres } from '../src/scene/measure';
import { sectionPlane } from '../src/scene/section';
import { instance } from './instance-fixture';

const RAMP: Color[] = [
  [0, 0, 0],
  [100, 200, 40],
  [200, 200, 200],
];

describe('colours', () => {
  test('a ramp is interpolated and never left', () => {
    expect(rampColor(RAMP, 0.25)).toEqual([50, 100, 20]);
    expect(rampColor(RAMP, -3)).toEqual([0, 0, 0]);
    expect(rampColor(RAMP, 3)).toEqual([200, 200, 200]);
  });

  const at = (table: LabelTable, label: number): number[] => [
    ...table.pixels.slice(label * 4, label * 4 + 4),
  ];

  test('each mode paints its own colour', () => {
    const table = new LabelTable();
    table.setLabels({ version: 1, instances: [0, 2, 2, 300, 7], hidden: [] });
    const instances = [
      instance(2, { class: { id: 9, name: 'mug', color: [9, 9, 9] } }),
      instance(300),
    ];
    const heat = new Map([[2, 1]]);
    paint(table, { mode: 'instances', instances, heat, ramp: RAMP });
    expect(at(table, 1)).toEqual([2, 0, 0, 255]);
    expect(at(table, 2)).toEqual([2, 0, 0, 255]);
    expect(at(table, 4)).toEqual([...NO_INSTANCE, 255]);
    paint(table, { mode: 'classes', instances, heat, ramp: RAMP });
    expect(at(table, 1)).toEqual([9, 9, 9, 255]);
    expect(at(table, 3)).toEqual([...NO_INSTANCE, 255]);
    paint(table, { mode: 'heat', instances, heat, ramp: RAMP });
    expect(at(table, 1)).toEqual([200, 200, 200, 255]);
    expect(at(table, 0)).toEqual([0, 0, 0, 255]);
  });

  test('a surface takes the colour of the object it belongs to by now', () => {
    const table = new LabelTable();
    table.paint(
      new Map([
        [1, [1, 1, 1] as Color],
        [2, [2, 2, 2] as Color],
      ]),
      NO_INSTANCE,
    );
    table.setLabels({ version: 1, instances: [0, 1, 2], hidden: [] });
    expect(at(table, 2)).toEqual([2, 2, 2, 255]);
    table.select(1);
    expect([at(table, 1)[3], at(table, 2)[3]]).toEqual([128, 255]);
    table.setLabels({ version: 2, instances: [0, 1, 1], hidden: [] }); // merged
    expect(at(table, 2)).toEqual([1, 1, 1, 128]);
    table.setLabels({ version: 3, instances: [0, 1, 2], hidden: [2] });
    expect(at(table, 2)[3]).toBe(0);
    expect([table.isHidden(2), table.isHidden(1), table.isHidden(99999)]).toEqual([
      true,
      false,
      false,
    ]);
  });

  test('grows with the labels', () => {
    const table = new LabelTable();
    expect([table.width, table.height]).toEqual([256, 1]);
    table.setLabels({ version: 1, instances: Array.from({ length: 700 }, () => 1), hidden: [] });
    expect(table.height).toBe(4);
    expect(table.pixels.length).toBe(256 * 4 * 4);
    expect(table.instanceOf(699)).toBe(1);
    expect(table.instanceOf(700)).toBe(0);
  });
});

describe('framing', () => {
  const up = new Vector3(0, -0.9, -0.43).normalize();

  test('ground axes are a right-handed frame with the given up', () => {
    const axes = groundAxes(up);
    expect(new Vector3().crossVectors(axes.east, axes.north).dot(axes.up)).toBeCloseTo(1);
    expect(axes.east.dot(up)).toBeCloseTo(0);
  });

  test('all corners of a box are seen, and one of them only just', () => {
    const box = new Box3(new Vector3(-1, -2, 0), new Vector3(3, 2, 1));
    const lens = { halfWidth: 0.8, halfHeight: 0.5 };
    const view = viewpointOf(cornersOf(box), lens, new Vector3(1, 1, 1), new Vector3(0, 0, 1));
    const back = view.position.clone().sub(view.target).normalize();
    const right = new Vector3().crossVectors(new Vector3(0, 0, 1), back).normalize();
    const top = new Vector3().crossVectors(back, right);
    const reach = cornersOf(box).map((corner) => {
      const arm = corner.clone().sub(view.position);
      const depth = -arm.dot(back);
      return Math.max(
        Math.abs(arm.dot(right)) / depth / lens.halfWidth,
        Math.abs(arm.dot(top)) / depth / lens.halfHeight,
      );
    });
    expect(Math.max(...reach)).toBeCloseTo(1);
  });

  test('outliers do not count', () => {
    const points = Array.from({ length: 101 }, (_, i) => new Vector3(i / 100, 0, 0));
    points.push(new Vector3(1000, 0, 0));
    expect(trimmedBox(points, 0.02).max.x).toBeLessThan(1.1);
    expect(trimmedBox([], 0.02).isEmpty()).toBe(true);
  });

  test('an overview looks down, also without cameras', () => {
    expect(overviewDirection(up, null).dot(up)).toBeGreaterThan(0.5);
    expect(overviewDirection(up, up).dot(up)).toBeGreaterThan(0.5);
  });

  test('a section plane moves from one side to the other', () => {
    const box = new Box3(new Vector3(0, 0, 0), new Vector3(1, 1, 2));
    const z = new Vector3(0, 0, 1);
    const cutsAway = (share: number, flipped: boolean, height: number): boolean => {
      const plane = sectionPlane({ axis: 'height', share, flipped }, box, z);
      return plane.z * height + plane.w > 0;
    };
    expect(cutsAway(0.5, false, 1.5)).toBe(true);
    expect(cutsAway(0.5, false, 0.5)).toBe(false);
    expect(cutsAway(0.5, true, 0.5)).toBe(true);
    expect(cutsAway(1, false, 1.99)).toBe(false);
  });
});

describe('cameras', () => {
  const cameras: Cameras = {
    camera: { width: 101, height: 101, fx: 50, fy: 50, cx: 50, cy: 50 },
    frames: [
      {
        index: 0,
        timestamp_s: 0,
        labelled: true,
        world_from_camera: [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7],
      },
    ],
  };

  test('a frustum begins at the camera and opens forward', () => {
    const edges = frustumEdges(cameras, 0, 1);
    expect(edges).toHaveLength(16);
    expect(edges[0]!.toArray()).toEqual([5, 6, 7]);
    expect(edges[1]!.toArray()).toEqual([4, 5, 8]);
    expect(viewpointOfFrame(cameras, 0).target.toArray()).toEqual([5, 6, 8]);
    expect(meanDirection(cameras)!.toArray()).toEqual([0, 0, 1]);
    expect(meanDirection({ ...cameras, frames: [] })).toBeNull();
  });
});

describe('measuring', () => {
  test('lengths are written in a unit that fits', () => {
    expect(metres(0.1234)).toBe('12.3 cm');
    expect(metres(2.345)).toBe('2.35 m');
  });
});

describe('where to stand', () => {
  const up = new Vector3(0, 0, 1);
  const pose = {
    seen: 0.5,
    distance_m: 1,
    position: [1, 2, 0] as [number, number, number],
    direction: [0, 0.8, -0.6] as [number, number, number],
    way_m: 2,
    way_in_world: [
      [0, 0, 0],
      [1, 0, 0],
      [1, 2, 0],
    ] as [number, number, number][],
  };

  test('the arrow lies level and looks along the gaze', () => {
    const [foot, tip, , left, , right] = arrowEdges(pose, up);
    expect(tip!.clone().sub(foot!).toArray()).toEqual([0, 0.5, 0]);
    expect(left!.z).toBeCloseTo(foot!.z);
    expect(left!.x - 1).toBeCloseTo(1 - right!.x);
  });

  test('the way is in pieces from corner to corner', () => {
    const pieces = wayEdges(pose, up);
    expect(pieces).toHaveLength(4);
    expect(pieces[1]).toEqual(pieces[2]);
    expect(wayEdges({ ...pose, way_in_world: [] }, up)).toEqual([]);
  });
});
