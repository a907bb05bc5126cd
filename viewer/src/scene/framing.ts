// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { type Box3, type PerspectiveCamera, Vector3 } from 'three';

/** Two horizontal directions and up: right-handed, unit length. */
export function groundAxes(up: Vector3): { east: Vector3; north: Vector3; up: Vector3 } {
  const other = Math.abs(up.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
  const north = new Vector3().crossVectors(up, other).normalize();
  const east = new Vector3().crossVectors(north, up).normalize();
  return { east, north, up: up.clone().normalize() };
}

/** How far away a camera must be to see a ball whole. */
export function distanceToSee(radius: number, camera: PerspectiveCamera): number {
  const vertical = (camera.fov * Math.PI) / 360;
  const horizontal = Math.atan(Math.tan(vertical) * camera.aspect);
  return radius / Math.sin(Math.min(vertical, horizontal));
}

export interface Viewpoint {
  position: Vector3;
  target: Vector3;
}

/** From where to see `box`: from the direction `from`, or as the camera looks now. */
export function viewpointOf(box: Box3, camera: PerspectiveCamera, from: Vector3): Viewpoint {
  const target = box.getCenter(new Vector3());
  const radius = Math.max(box.getSize(new Vector3()).length() / 2, 0.05);
  const distance = distanceToSee(radius, camera);
  return { target, position: target.clone().addScaledVector(from.clone().normalize(), distance) };
}

/** Slanted from above, from the side that the recording looked from. */
export function overviewDirection(up: Vector3, lookedAlong: Vector3 | null): Vector3 {
  const { east, up: unitUp } = groundAxes(up);
  const back = (lookedAlong ?? east.clone().negate()).clone().negate().projectOnPlane(unitUp);
  if (back.length() < 1e-3) back.copy(east);
  return back.normalize().addScaledVector(unitUp, 0.9).normalize();
}
