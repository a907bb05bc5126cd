// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Box3, Vector3 } from 'three';

/** Two horizontal directions and up: right-handed, unit length. */
export function groundAxes(up: Vector3): { east: Vector3; north: Vector3; up: Vector3 } {
  const other = Math.abs(up.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
  const north = new Vector3().crossVectors(up, other).normalize();
  const east = new Vector3().crossVectors(north, up).normalize();
  return { east, north, up: up.clone().normalize() };
}

/** What a camera sees at a distance of 1: half of the height and half of the width. */
export interface Lens {
  halfWidth: number;
  halfHeight: number;
}

export interface Viewpoint {
  position: Vector3;
  target: Vector3;
}

export function cornersOf({ min, max }: Box3): Vector3[] {
  const pick = (bits: number): Vector3 =>
    new Vector3(bits & 1 ? max.x : min.x, bits & 2 ? max.y : min.y, bits & 4 ? max.z : min.z);
  return [0, 1, 2, 3, 4, 5, 6, 7].map(pick);
}

/**
 * From where to see the points, looking from the direction `from`: as near as the lens allows.
 * `outliers` is the share of points that need not be seen.
 */
export function viewpointOf(
  points: readonly Vector3[],
  lens: Lens,
  from: Vector3,
  up: Vector3,
  outliers = 0,
): Viewpoint {
  const target = trimmedBox(points, outliers).getCenter(new Vector3());
  const back = from.clone().normalize();
  const right = new Vector3().crossVectors(up, back).normalize();
  const top = new Vector3().crossVectors(back, right);
  const needed = points
    .map((point) => {
      const arm = point.clone().sub(target);
      const aside = Math.abs(arm.dot(right)) / lens.halfWidth;
      return arm.dot(back) + Math.max(aside, Math.abs(arm.dot(top)) / lens.halfHeight);
    })
    .sort((a, b) => a - b);
  const distance = needed[Math.floor((1 - outliers) * (needed.length - 1))] ?? 1;
  return { target, position: target.clone().addScaledVector(back, Math.max(distance, 0.1)) };
}

/** The box of the points without that share of them at each end of each axis. */
export function trimmedBox(points: readonly Vector3[], share: number): Box3 {
  if (points.length === 0) return new Box3();
  const ends = (['x', 'y', 'z'] as const).map((axis) => {
    const values = points.map((point) => point[axis]).sort((a, b) => a - b);
    const skipped = Math.floor(share * (values.length - 1));
    return [values[skipped]!, values[values.length - 1 - skipped]!] as const;
  });
  const corner = (end: 0 | 1): Vector3 => new Vector3(...ends.map((pair) => pair[end]));
  return new Box3(corner(0), corner(1));
}

/** Slanted from above, from the side that the recording looked from. */
export function overviewDirection(up: Vector3, lookedAlong: Vector3 | null): Vector3 {
  const { east, up: unitUp } = groundAxes(up);
  const back = (lookedAlong ?? east.clone().negate()).clone().negate().projectOnPlane(unitUp);
  if (back.length() < 1e-3) back.copy(east);
  return back.normalize().addScaledVector(unitUp, 0.9).normalize();
}
