// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Group, type LineSegments, type PerspectiveCamera, Vector3 } from 'three';
import { disposeLines, lineSegments } from './lines';

export function metres(value: number): string {
  return value < 1 ? `${(value * 100).toFixed(1)} cm` : `${value.toFixed(2)} m`;
}

/** Two points on the surface and the distance between them, written beside the line. */
export class Measure {
  readonly group = new Group();
  readonly label: HTMLElement;
  private points: Vector3[] = [];
  private lines: LineSegments[] = [];

  constructor(private readonly crossSize: () => number) {
    this.label = document.createElement('output');
    this.label.className = 'measure-label';
    this.label.hidden = true;
  }

  /** The distance once there are two points. */
  add(point: Vector3): number | null {
    if (this.points.length === 2) this.clear();
    this.points.push(point.clone());
    this.draw(this.cross(point));
    if (this.points.length < 2) return null;
    const [a, b] = this.points as [Vector3, Vector3];
    this.draw([a, b]);
    const distance = a.distanceTo(b);
    this.label.textContent = metres(distance);
    this.label.hidden = false;
    return distance;
  }

  clear(): void {
    this.lines.forEach(disposeLines);
    this.lines = [];
    this.points = [];
    this.label.hidden = true;
  }

  /** Moves the label to where the line's middle is seen. */
  follow(camera: PerspectiveCamera, width: number, height: number): void {
    if (this.points.length < 2) return;
    const middle = this.points[0]!.clone().add(this.points[1]!).divideScalar(2).project(camera);
    this.label.style.visibility = middle.z < 1 ? 'visible' : 'hidden';
    const x = ((middle.x + 1) / 2) * width;
    const y = ((1 - middle.y) / 2) * height;
    this.label.style.transform = `translate(-50%, -130%) translate(${x}px, ${y}px)`;
  }

  private cross(at: Vector3): Vector3[] {
    const size = this.crossSize();
    const arms = [new Vector3(size, 0, 0), new Vector3(0, size, 0), new Vector3(0, 0, size)];
    return arms.flatMap((arm) => [at.clone().add(arm), at.clone().sub(arm)]);
  }

  private draw(points: Vector3[]): void {
    const lines = lineSegments(points, '#ff3d71', true);
    this.lines.push(lines);
    this.group.add(lines);
  }
}
