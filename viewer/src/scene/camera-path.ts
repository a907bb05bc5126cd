// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Group, type LineSegments, Matrix4, Vector3 } from 'three';
import type { Cameras } from '../api/types';
import type { Viewpoint } from './framing';
import { disposeLines, lineSegments } from './lines';

const FRUSTUM_DEPTH_M = 0.35;
const LOST_DEPTH_M = 1; // as far as it should be seen from anywhere
const LOST_COLOR = '#e02020';

function matrixOf(m: readonly number[]): Matrix4 {
  return new Matrix4().set(
    m[0]!, m[1]!, m[2]!, m[3]!,
    m[4]!, m[5]!, m[6]!, m[7]!,
    m[8]!, m[9]!, m[10]!, m[11]!,
    0, 0, 0, 1,
  ); // prettier-ignore
}

export function poseOf(cameras: Cameras, frame: number): Matrix4 {
  return matrixOf(cameras.frames[frame]!.world_from_camera);
}

/** The edges of what a frame's camera saw, as pairs of points in the world. */
export function frustumEdges(cameras: Cameras, frame: number, depth = FRUSTUM_DEPTH_M): Vector3[] {
  return viewEdges(cameras.camera, poseOf(cameras, frame), depth);
}

function viewEdges(camera: Cameras['camera'], pose: Matrix4, depth: number): Vector3[] {
  const { width, height, fx, fy, cx, cy } = camera;
  const apex = new Vector3().applyMatrix4(pose);
  const corners = [
    [0, 0],
    [width - 1, 0],
    [width - 1, height - 1],
    [0, height - 1],
  ].map(([u, v]) =>
    new Vector3(((u! - cx) / fx) * depth, ((v! - cy) / fy) * depth, depth).applyMatrix4(pose),
  );
  return corners.flatMap((corner, i) => [apex, corner, corner, corners[(i + 1) % 4]!]);
}

/** From where a frame's camera looked, and whereto. */
export function viewpointOfFrame(cameras: Cameras, frame: number): Viewpoint {
  const pose = poseOf(cameras, frame);
  const position = new Vector3().applyMatrix4(pose);
  return { position, target: new Vector3(0, 0, 1).applyMatrix4(pose) };
}

/** Where the cameras looked on the whole; null without cameras. */
export function meanDirection(cameras: Cameras): Vector3 | null {
  const sum = new Vector3();
  for (const { world_from_camera: m } of cameras.frames) sum.add(new Vector3(m[2], m[6], m[10]));
  return sum.length() > 1e-6 ? sum.normalize() : null;
}

/** The way of the camera, and the view of one of its frames. */
export class CameraPath {
  readonly group = new Group();
  private way: LineSegments | null = null;
  private frustum: LineSegments | null = null;

  constructor(private readonly cameras: Cameras) {
    this.group.visible = false;
  }

  show(frame: number): void {
    if (this.way) disposeLines(this.way);
    if (this.frustum) disposeLines(this.frustum);
    const { cameras } = this;
    const places = cameras.frames.map((_, i) => new Vector3().applyMatrix4(poseOf(cameras, i)));
    const pairs = places.slice(1).flatMap((place, i) => [places[i]!, place]);
    this.way = lineSegments(pairs, '#e0912f');
    this.group.add(this.way);
    this.frustum = lineSegments(frustumEdges(this.cameras, frame), '#2f9e63', true);
    this.group.add(this.frustum);
  }
}

/** A camera that does not know where it is: red, where it was tracked last. */
export class LostCamera {
  readonly group = new Group();
  private lines: LineSegments | null = null;

  /** null: it is not lost. */
  show(camera: Cameras['camera'], world_from_camera: number[] | null): void {
    if (this.lines) disposeLines(this.lines);
    this.lines = null;
    if (!world_from_camera) return;
    const edges = viewEdges(camera, matrixOf(world_from_camera), LOST_DEPTH_M);
    this.lines = lineSegments(edges, LOST_COLOR, true);
    this.group.add(this.lines);
  }
}
