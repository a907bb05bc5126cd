// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { BufferGeometry, LineBasicMaterial, LineSegments, type Vector3 } from 'three';

/** Lines over the surface, drawn through it where `through` says so. */
export function lineSegments(points: Vector3[], color: string, through = false): LineSegments {
  const material = new LineBasicMaterial({ color, depthTest: !through, transparent: through });
  const lines = new LineSegments(new BufferGeometry().setFromPoints(points), material);
  lines.renderOrder = through ? 2 : 1;
  return lines;
}

export function disposeLines(lines: LineSegments): void {
  lines.geometry.dispose();
  (lines.material as LineBasicMaterial).dispose();
  lines.removeFromParent();
}
