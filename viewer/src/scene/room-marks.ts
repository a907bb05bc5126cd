// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import {
  Box3,
  CanvasTexture,
  CircleGeometry,
  DoubleSide,
  Group,
  type Material,
  Mesh,
  MeshBasicMaterial,
  type Object3D,
  Quaternion,
  Shape,
  ShapeGeometry,
  Sprite,
  SpriteMaterial,
  Vector2,
  Vector3,
} from 'three';
import type { Color, Point, Room, Rooms } from '../api/types';
import { groundAxes } from './framing';
import { disposeLines, lineSegments } from './lines';

const LIFT_M = 0.04; // above the floor
const LABEL_LIFT_M = 0.25;
const LABEL_M = 0.32; // high
const LABEL_PX = 64;
const FILL = 0.42;
const DOOR_COLOR = '#ffffff';
// Far from each other, and from the colours of changes and of poses.
const COLORS: Color[] = [
  [66, 133, 210],
  [230, 150, 40],
  [90, 165, 90],
  [170, 100, 190],
  [210, 95, 95],
  [60, 170, 170],
  [150, 130, 70],
  [120, 120, 200],
];

export function roomColor(room: Room): Color {
  return COLORS[(room.id - 1) % COLORS.length]!;
}

function vectorOf(point: Point): Vector3 {
  return new Vector3(...point.map((value) => value ?? 0));
}

/** The place of a room, as high as a person. */
export function roomBox(room: Room, up: Vector3): Box3 {
  const box = new Box3();
  for (const corner of room.outline[0] ?? [room.center])
    box.expandByPoint(vectorOf(corner)).expandByPoint(vectorOf(corner).addScaledVector(up, 1.8));
  return box;
}

/** Borders as pairs of points, above the floor. */
export function outlineEdges(room: Room, up: Vector3): Vector3[] {
  return room.outline.flatMap((polygon) => {
    const corners = polygon.map((corner) => vectorOf(corner).addScaledVector(up, LIFT_M));
    return corners.flatMap((corner, i) => [corner, corners[(i + 1) % corners.length]!]);
  });
}

/** A room's floor in two directions along it; what stands in it is a hole. */
export function floorShape(room: Room, up: Vector3): Shape {
  const { east, north } = groundAxes(up);
  const flat = (polygon: Point[]): Vector2[] =>
    polygon.map((corner) => {
      const at = vectorOf(corner);
      return new Vector2(at.dot(east), at.dot(north));
    });
  const [around = [], ...inside] = room.outline;
  const shape = new Shape(flat(around));
  shape.holes = inside.map((polygon) => new Shape(flat(polygon)));
  return shape;
}

function floorMesh(room: Room, up: Vector3): Mesh {
  const { east, north } = groundAxes(up);
  const geometry = new ShapeGeometry(floorShape(room, up));
  const height = vectorOf(room.center).dot(up) + LIFT_M;
  const flat = geometry.getAttribute('position');
  for (let i = 0; i < flat.count; ++i) {
    const at = new Vector3()
      .addScaledVector(east, flat.getX(i))
      .addScaledVector(north, flat.getY(i))
      .addScaledVector(up, height);
    flat.setXYZ(i, at.x, at.y, at.z);
  }
  const [r, g, b] = roomColor(room);
  const material = new MeshBasicMaterial({
    color: `rgb(${r}, ${g}, ${b})`,
    transparent: true,
    opacity: FILL,
    side: DoubleSide,
    depthWrite: false,
  });
  return new Mesh(geometry, material);
}

function label(room: Room, up: Vector3): Sprite {
  const canvas = document.createElement('canvas');
  const context = canvas.getContext('2d')!;
  const font = `600 ${LABEL_PX * 0.6}px system-ui, sans-serif`;
  context.font = font;
  canvas.width = Math.ceil(context.measureText(room.name).width) + LABEL_PX;
  canvas.height = LABEL_PX;
  context.font = font;
  context.fillStyle = 'rgba(20, 24, 30, 0.82)';
  context.roundRect(0, 0, canvas.width, canvas.height, LABEL_PX / 2);
  context.fill();
  context.fillStyle = '#fff';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText(room.name, canvas.width / 2, canvas.height / 2);
  const material = new SpriteMaterial({ map: new CanvasTexture(canvas), depthTest: false });
  const sprite = new Sprite(material);
  sprite.scale.set((LABEL_M * canvas.width) / canvas.height, LABEL_M, 1);
  sprite.position.copy(vectorOf(room.center)).addScaledVector(up, LABEL_LIFT_M);
  sprite.renderOrder = 3;
  return sprite;
}

function doorMark(place: Point, width_m: number, up: Vector3): Mesh {
  const material = new MeshBasicMaterial({ color: DOOR_COLOR, side: DoubleSide });
  const mark = new Mesh(new CircleGeometry(width_m / 5, 24), material);
  mark.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), up));
  mark.position.copy(vectorOf(place)).addScaledVector(up, 1.5 * LIFT_M);
  return mark;
}

function dispose(object: Object3D): void {
  if (object instanceof Mesh) object.geometry.dispose();
  if (object instanceof Sprite) object.material.map?.dispose();
  if (object instanceof Mesh || object instanceof Sprite) (object.material as Material).dispose();
}

/** The floors of rooms with their names, and where one goes from one into another. */
export class RoomMarks {
  readonly group = new Group();
  private borders: ReturnType<typeof lineSegments>[] = [];

  show(rooms: Rooms | null, up: Vector3): void {
    this.borders.forEach(disposeLines);
    this.group.children.forEach(dispose);
    this.group.clear();
    this.borders = [];
    for (const room of rooms?.rooms ?? []) {
      const [r, g, b] = roomColor(room);
      const border = lineSegments(outlineEdges(room, up), `rgb(${r}, ${g}, ${b})`);
      this.borders.push(border);
      this.group.add(floorMesh(room, up), border, label(room, up));
    }
    for (const { place, width_m } of rooms?.doors ?? [])
      this.group.add(doorMark(place, width_m, up));
  }
}
