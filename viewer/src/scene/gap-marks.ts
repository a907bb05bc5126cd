// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Box3, Group, type LineSegments, Vector3 } from 'three';
import type { Gap } from '../api/types';
import { boxOf } from './ghosts';
import { disposeLines, lineSegments } from './lines';

const COLORS = { unseen: '#c2449b', thin: '#d9822b' } as const;
const MARK_M = 0.12;

export function gapColor(gap: Gap): string {
  return COLORS[gap.kind];
}

/** The edges of a box, and a cross at a place in it, as pairs of points. */
export function gapEdges(gap: Gap): Vector3[] {
  const { min, max }: Box3 = boxOf(gap.box);
  const corner = (bits: number): Vector3 =>
    new Vector3(bits & 1 ? max.x : min.x, bits & 2 ? max.y : min.y, bits & 4 ? max.z : min.z);
  const edges: Vector3[] = [];
  for (let bits = 0; bits < 8; ++bits)
    for (const axis of [1, 2, 4])
      if ((bits & axis) === 0) edges.push(corner(bits), corner(bits | axis));
  const middle = new Vector3(...gap.middle.map((value) => value ?? 0));
  for (const axis of ['x', 'y', 'z'] as const) {
    const arm = new Vector3();
    arm[axis] = MARK_M;
    edges.push(middle.clone().sub(arm), middle.clone().add(arm));
  }
  return edges;
}

/** Where somebody who scans should look next. */
export class GapMarks {
  readonly group = new Group();
  private lines: LineSegments[] = [];

  show(gaps: readonly Gap[]): void {
    this.lines.forEach(disposeLines);
    this.group.clear();
    this.lines = gaps.map((gap) => lineSegments(gapEdges(gap), gapColor(gap), true));
    if (this.lines.length > 0) this.group.add(...this.lines);
  }
}
