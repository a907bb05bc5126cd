// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Group, type LineSegments, Vector3 } from 'three';
import type { Approach, ApproachPose } from '../api/types';
import { disposeLines, lineSegments } from './lines';

const ARROW_M = 0.5;
const HEAD_M = 0.14;
const LIFT_M = 0.03; // above the floor

/** An arrow on the floor that looks where the robot looks, as pairs of points in the world. */
export function arrowEdges(pose: ApproachPose, up: Vector3): Vector3[] {
  const foot = new Vector3(...pose.position).addScaledVector(up, LIFT_M);
  const ahead = new Vector3(...pose.direction).projectOnPlane(up).normalize();
  const aside = new Vector3().crossVectors(up, ahead);
  const tip = foot.clone().addScaledVector(ahead, ARROW_M);
  const barb = (side: number): Vector3 =>
    tip
      .clone()
      .addScaledVector(ahead, -HEAD_M)
      .addScaledVector(aside, side * HEAD_M);
  return [foot, tip, tip, barb(1), tip, barb(-1)];
}

/** The way to a pose, as pairs of points in the world. */
export function wayEdges(pose: ApproachPose, up: Vector3): Vector3[] {
  const corners = pose.way_in_world.map((at) => new Vector3(...at).addScaledVector(up, LIFT_M));
  return corners.slice(1).flatMap((corner, i) => [corners[i]!, corner]);
}

/** Where to stand to see an object: an arrow for each pose, and the way to the best. */
export class ApproachMarks {
  readonly group = new Group();
  private lines: LineSegments[] = [];

  show(approach: Approach | null, up: Vector3): void {
    this.lines.forEach(disposeLines);
    const poses = approach?.poses ?? [];
    this.lines = poses.map((pose, i) =>
      lineSegments(arrowEdges(pose, up), i === 0 ? '#2f9e63' : '#8ac7a5', true),
    );
    if (poses[0]) this.lines.push(lineSegments(wayEdges(poses[0], up), '#2f9e63', true));
    if (this.lines.length > 0) this.group.add(...this.lines);
  }
}
