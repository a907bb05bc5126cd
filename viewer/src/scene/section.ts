// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { type Box3, Vector3, Vector4 } from 'three';
import { groundAxes } from './framing';

export type SectionAxis = 'height' | 'width' | 'depth';

export interface Section {
  axis: SectionAxis;
  /** Where the plane is, from one side of the map (0) to the other (1). */
  share: number;
  /** Cuts away the other side. */
  flipped: boolean;
}

export function axisDirection(axis: SectionAxis, up: Vector3): Vector3 {
  const axes = groundAxes(up);
  return axis === 'height' ? axes.up : axis === 'width' ? axes.east : axes.north;
}

/** The plane (n, d); what has n.x + d > 0 is cut away. */
export function sectionPlane(section: Section, box: Box3, up: Vector3): Vector4 {
  const normal = axisDirection(section.axis, up);
  const center = box.getCenter(new Vector3()).dot(normal);
  const size = box.getSize(new Vector3());
  const reach =
    0.5 * (Math.abs(normal.x) * size.x + Math.abs(normal.y) * size.y + Math.abs(normal.z) * size.z);
  const offset = center + (2 * section.share - 1) * reach;
  const sign = section.flipped ? -1 : 1;
  return new Vector4(sign * normal.x, sign * normal.y, sign * normal.z, -sign * offset);
}
