// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Box3, Box3Helper, Color, Frustum, Matrix4, Vector2, Vector3, Vector4 } from 'three';
import type {
  Approach,
  Cameras,
  FrameEvent,
  Gap,
  Instance,
  Labels,
  MapInfo,
  Point,
  Room,
  Rooms,
} from '../api/types';
import type { Chunk } from '../mesh/chunk-format';
import { ApproachMarks } from './approach-marks';
import { CameraPath, LostCamera, meanDirection, viewpointOfFrame } from './camera-path';
import { type ColoringInput, paint } from './coloring';
import { cornersOf, overviewDirection, viewpointOf } from './framing';
import { GapMarks } from './gap-marks';
import { Ghosts } from './ghosts';
import { Measure } from './measure';
import { Movement } from './movement';
import { type Pick, pick } from './picking';
import { RoomMarks, roomBox } from './room-marks';
import { type Section, sectionPlane } from './section';
import { type Covered, Stage } from './stage';
import { Surface } from './surface';

const CLICK_SLACK_PX = 5;
const OUTLIER_SHARE = 0.02; // of the surface: what was seen through doors
const OVERVIEW_AIR = 1.08; // the bar at the bottom needs some room
const FOCUS_MARGIN_M = 0.3;

export interface MapViewHooks {
  onClick: (hit: Pick | null) => void;
  onLost: () => void;
}

function vectorOf(point: Point): Vector3 {
  return new Vector3(...point.map((value) => value ?? 0));
}

function boxOfInstance(instance: Instance): Box3 {
  return new Box3(vectorOf(instance.box.min), vectorOf(instance.box.max));
}

/** The map in 3D: its surface, the selected object, the camera's way, a measured line. */
export class MapView {
  readonly surface: Surface;
  readonly measure: Measure;
  readonly movement: Movement;
  readonly ghosts = new Ghosts();
  private readonly stage: Stage;
  private readonly up: Vector3;
  private readonly selection = new Box3Helper(new Box3(), new Color('#2f6fed'));
  private readonly approach = new ApproachMarks();
  private readonly rooms = new RoomMarks();
  private readonly gaps = new GapMarks();
  private readonly lost = new LostCamera();
  private path: CameraPath | null = null;
  private cameras: Cameras | null = null;
  private section: Section | null = null;
  private still = false;

  /** Called when the view has moved and rests. */
  onRest: () => void = () => undefined;

  /** Throws NoWebGlError where nothing can be drawn. */
  constructor(canvas: HTMLCanvasElement, info: MapInfo, hooks: MapViewHooks) {
    this.up = vectorOf(info.up).normalize();
    this.surface = new Surface();
    this.stage = new Stage(canvas, this.up, {
      onFrame: (now) => this.frame(now),
      onDetail: (coarse) => this.surface.showCoarse(coarse),
      onRest: () => this.onRest(),
      onLost: hooks.onLost,
    });
    this.measure = new Measure(() => 1.5 * info.voxel_size_m);
    this.movement = new Movement(this.stage.camera, canvas, () => this.stage.moved());
    this.selection.visible = false;
    this.stage.scene.add(this.surface.group, this.selection, this.measure.group);
    this.stage.scene.add(this.approach.group, this.ghosts.group, this.rooms.group);
    this.stage.scene.add(this.lost.group, this.gaps.group);
    this.uniform('light', this.up.toArray());
    this.listen(canvas, hooks);
  }

  put(key: string, chunk: Chunk): void {
    this.surface.update(key, chunk);
    if (!this.still) this.stage.drawSoon();
  }

  /** Tells of chunks how far from the camera they are, and whether it sees them. */
  look(): (
    index: { x: number; y: number; z: number },
    edge_m: number,
  ) => {
    distance: number;
    inView: boolean;
  } {
    const { camera } = this.stage;
    camera.updateMatrixWorld();
    const frustum = new Frustum().setFromProjectionMatrix(
      new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse),
    );
    return ({ x, y, z }, edge_m) => {
      const corner = new Vector3(x, y, z).multiplyScalar(edge_m);
      const box = new Box3(corner, corner.clone().addScalar(edge_m));
      return { distance: box.distanceToPoint(camera.position), inView: frustum.intersectsBox(box) };
    };
  }

  /** Draws nothing until called again with false: the first picture should come in one go. */
  holdStill(still: boolean): void {
    this.still = still;
    if (!still) this.stage.draw();
  }

  /** Shows the whole map as it grows, until somebody moves the view. */
  followGrowth(): void {
    if (!this.movement.moved) this.frameAll(true);
  }

  /** Shows the whole map. */
  frameAll(animated: boolean): void {
    this.movement.moved = false;
    const points = this.surface.samples();
    if (points.length === 0) return;
    const direction = overviewDirection(this.up, this.cameras && meanDirection(this.cameras));
    const view = viewpointOf(points, this.stage.lens(), direction, this.up, OUTLIER_SHARE);
    view.position.sub(view.target).multiplyScalar(OVERVIEW_AIR).add(view.target);
    const reach = view.position.distanceTo(view.target);
    this.movement.speed = Math.min(Math.max(reach / 3, 0.5), 5);
    this.movement.goTo(view, animated);
  }

  /** Goes near an object without changing the direction of view. */
  focus(instance: Instance): void {
    this.focusBox(boxOfInstance(instance));
  }

  /** The same for a place in the world. */
  focusBox(box: Box3): void {
    this.movement.moved = true;
    const from = this.stage.camera.position.clone().sub(this.movement.orbit.target);
    const wider = box.clone().expandByScalar(FOCUS_MARGIN_M);
    this.movement.goTo(viewpointOf(cornersOf(wider), this.stage.lens(), from, this.up), true);
  }

  /** Marks where to look next. */
  showGaps(gaps: readonly Gap[]): void {
    this.gaps.show(gaps);
    this.stage.draw();
  }

  focusRoom(room: Room): void {
    this.focusBox(roomBox(room, this.up));
  }

  /** Draws rooms on the floor, or none. */
  showRooms(rooms: Rooms | null): void {
    this.rooms.show(rooms, this.up);
    this.stage.draw();
  }

  /** Outlines a place that no object has, or nothing. */
  outline(box: Box3 | null): void {
    this.selection.visible = box !== null;
    if (box) this.selection.box.copy(box);
    this.selection.updateMatrixWorld(true);
    this.stage.draw();
  }

  /** Draws objects where they are not any more, and leaves out some of those that are there. */
  showPast(ghosts: ReadonlyMap<number, { faint: boolean }>, absent: ReadonlySet<number>): void {
    this.ghosts.show(ghosts);
    this.surface.table.leaveOut(absent);
    this.surface.tableChanged();
    this.stage.draw();
  }

  /** Where the last camera stood: a point of the world, null without cameras. */
  lastCamera(): number[] | null {
    const last = this.cameras?.frames.at(-1);
    return last ? [3, 7, 11].map((i) => last.world_from_camera[i]!) : null;
  }

  showApproach(approach: Approach | null): void {
    this.approach.show(approach, this.up);
    this.stage.draw();
  }

  select(instance: Instance | null): void {
    this.approach.show(null, this.up);
    this.surface.table.select(instance?.id ?? 0);
    this.surface.tableChanged();
    this.uniform('selecting', instance !== null);
    this.selection.visible = instance !== null;
    if (instance) this.selection.box.copy(boxOfInstance(instance));
    this.selection.updateMatrixWorld(true);
    this.stage.draw();
  }

  paint(input: ColoringInput): void {
    paint(this.surface.table, input);
    this.surface.tableChanged();
    this.uniform('ownColors', input.mode === 'color');
    this.uniform('showEvidence', input.mode === 'evidence');
    this.stage.moved(); // quickly first, in detail soon after
  }

  /** Which object each part of the surface belongs to. */
  setLabels(labels: Labels): void {
    this.surface.table.setLabels(labels);
    this.surface.tableChanged();
    this.stage.draw();
  }

  setTheme(background: string): void {
    this.stage.setBackground(background);
    this.uniform('fade', new Color(background).convertLinearToSRGB().toArray());
    this.stage.draw();
  }

  setSection(section: Section | null): void {
    this.section = section;
    const plane = section && sectionPlane(section, this.surface.box(), this.up);
    this.uniform('section', plane ?? new Vector4(0, 0, 0, 0));
    this.stage.draw();
  }

  /** The surface changed: planes lie by its box. */
  surfaceChanged(): void {
    this.setSection(this.section);
  }

  setCameras(cameras: Cameras): void {
    const shown = this.path?.group.visible ?? false;
    this.path?.group.removeFromParent();
    this.cameras = cameras;
    this.path = new CameraPath(cameras);
    this.path.group.visible = shown;
    this.stage.scene.add(this.path.group);
  }

  /** The camera moved on, while the map is made. */
  addCamera({ frames, index, world_from_camera }: FrameEvent): void {
    if (this.cameraCount >= frames) return; // it came with the others
    this.cameras?.frames.push({ index, timestamp_s: 0, labelled: false, world_from_camera });
  }

  get cameraCount(): number {
    return this.cameras?.frames.length ?? 0;
  }

  /** Draws in red where the camera was tracked last, and what it saw there; null: it is not lost. */
  showLost(world_from_camera: number[] | null): void {
    if (this.cameras) this.lost.show(this.cameras.camera, world_from_camera);
    this.stage.draw();
  }

  showPath(visible: boolean, frame: number): void {
    if (!this.path) return;
    this.path.group.visible = visible && this.cameraCount > 0;
    if (this.path.group.visible) this.path.show(Math.min(frame, this.cameraCount - 1));
    this.stage.draw();
  }

  lookFromFrame(frame: number): void {
    this.movement.moved = true;
    if (this.cameras && frame < this.cameraCount)
      this.movement.goTo(viewpointOfFrame(this.cameras, frame), true);
  }

  clearMeasure(): void {
    this.measure.clear();
    this.stage.draw();
  }

  addMeasurePoint(point: Vector3): number | null {
    const distance = this.measure.add(point);
    this.stage.draw();
    return distance;
  }

  /** Resolves once what is there now is drawn. */
  whenDrawn(): Promise<void> {
    return this.stage.whenDrawn();
  }

  /** How much of the canvas panels cover at each side, in pixels. */
  setCovered(covered: Covered): void {
    this.stage.setCovered(covered);
  }

  picture(): Promise<Blob | null> {
    return this.stage.picture();
  }

  private frame(now: number): boolean {
    const more = this.movement.advance(now);
    const { canvas, camera } = this.stage;
    camera.updateMatrixWorld();
    this.measure.follow(camera, canvas.clientWidth, canvas.clientHeight);
    return more;
  }

  private uniform(name: string, value: unknown): void {
    this.surface.material.uniforms[name]!.value = value;
    this.surface.material.uniformsNeedUpdate = true;
  }

  private pickAt(canvas: HTMLCanvasElement, event: MouseEvent): Pick | null {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const x = ((event.clientX - left) / width) * 2 - 1;
    const y = 1 - ((event.clientY - top) / height) * 2;
    return pick(this.surface, this.stage.camera, new Vector2(x, y));
  }

  private listen(canvas: HTMLCanvasElement, hooks: MapViewHooks): void {
    let down: { x: number; y: number } | null = null;
    canvas.addEventListener('pointerdown', (event) => {
      down = event.isPrimary && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
    });
    canvas.addEventListener('pointerup', (event) => {
      if (!down) return;
      const far = Math.hypot(event.clientX - down.x, event.clientY - down.y) > CLICK_SLACK_PX;
      down = null;
      if (!far) hooks.onClick(this.pickAt(canvas, event));
    });
  }
}
