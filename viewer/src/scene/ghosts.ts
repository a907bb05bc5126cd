// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  Points,
  PointsMaterial,
  Vector3,
} from 'three';
import type { Box, HistoryEvent, PastSurface } from '../api/types';

const POINT_M = 0.024; // the points of a past surface are 2 cm apart
const FAINT = 0.3;
const UNKNOWN: [number, number, number] = [150, 150, 150];

export function boxOf({ min, max }: Box): Box3 {
  const corner = (values: Box['min']): Vector3 => new Vector3(...values.map((value) => value ?? 0));
  return new Box3(corner(min), corner(max));
}

/** Colours as three.js takes them, linear in [0, 1]; grey where none is known. */
export function pointColors(colors: readonly number[]): Float32Array {
  const result = new Float32Array(colors.length);
  const color = new Color();
  for (let at = 0; at < colors.length; at += 3) {
    const own = colors.slice(at, at + 3) as [number, number, number];
    const [r, g, b] = own.some((channel) => channel > 0) ? own : UNKNOWN;
    color.setRGB(r / 255, g / 255, b / 255, 'srgb').toArray(result, at);
  }
  return result;
}

function cloudOf({ points, colors }: PastSurface): Points {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
  geometry.setAttribute('color', new BufferAttribute(pointColors(colors), 3));
  const material = new PointsMaterial({ size: POINT_M, vertexColors: true, transparent: true });
  return new Points(geometry, material);
}

/** Objects where they are not any more: faint, or as solid as the map. */
export class Ghosts {
  readonly group = new Group();
  private readonly clouds = new Map<number, Points>();

  has(event: number): boolean {
    return this.clouds.has(event);
  }

  add(event: number, surface: PastSurface): void {
    if (this.has(event)) return;
    const cloud = cloudOf(surface);
    cloud.visible = false;
    this.clouds.set(event, cloud);
    this.group.add(cloud);
  }

  /** By event: whether it is drawn faintly. What is not named is not drawn. */
  show(events: ReadonlyMap<number, { faint: boolean }>): void {
    for (const [event, cloud] of this.clouds) {
      const how = events.get(event);
      cloud.visible = how !== undefined;
      const material = cloud.material as PointsMaterial;
      material.opacity = how?.faint ? FAINT : 1;
      material.depthWrite = !how?.faint;
    }
  }

  /** Other events than those that are known: the map changed. */
  clear(): void {
    for (const cloud of this.clouds.values()) {
      cloud.geometry.dispose();
      (cloud.material as PointsMaterial).dispose();
      cloud.removeFromParent();
    }
    this.clouds.clear();
  }
}

/** Where to look for what an event tells of: where it is, else where it was. */
export function placeOf(event: HistoryEvent): Box3 | null {
  const box = event.after ?? event.before;
  return box && boxOf(box);
}
