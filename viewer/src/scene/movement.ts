// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { MOUSE, type PerspectiveCamera, Vector3 } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Viewpoint } from './framing';

const MOVES: Record<string, [right: number, up: number, forward: number]> = {
  KeyW: [0, 0, 1],
  KeyS: [0, 0, -1],
  KeyA: [-1, 0, 0],
  KeyD: [1, 0, 0],
  KeyE: [0, 1, 0],
  KeyQ: [0, -1, 0],
};
const TURNS: Record<string, [aside: number, upward: number]> = {
  ArrowLeft: [1, 0],
  ArrowRight: [-1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const TURN_RATE = 1.4; // radians a second
const LOOK_RATE = 0.004; // radians a pixel
const FLIGHT_MS = 450;

/** Moves the camera: orbiting around a point, flying through the scene, gliding to a viewpoint. */
export class Movement {
  readonly orbit: OrbitControls;
  private readonly keys = new Set<string>();
  private flying = false;
  private glide: { from: Viewpoint; to: Viewpoint; start: number } | null = null;
  private lastFrame = 0;
  private dragging: { x: number; y: number } | null = null;

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly canvas: HTMLElement,
    private readonly onChange: () => void,
  ) {
    this.orbit = new OrbitControls(camera, canvas);
    this.orbit.enableDamping = false;
    this.orbit.zoomToCursor = true;
    this.orbit.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.PAN };
    this.orbit.addEventListener('change', onChange);
    this.orbit.addEventListener('start', () => {
      this.glide = null;
      this.moved = true;
    });
    this.listen();
  }

  /** Whether somebody chose this view. */
  moved = false;
  /** Metres a second that keys move by; it follows the size of the map. */
  speed = 2;

  setFlying(flying: boolean): void {
    this.flying = flying;
    this.orbit.enableRotate = !flying;
    if (!flying) return;
    // Orbiting begins anew around a point close ahead.
    const ahead = this.camera.getWorldDirection(new Vector3());
    this.orbit.target.copy(this.camera.position).addScaledVector(ahead, 1);
  }

  goTo(to: Viewpoint, animated: boolean): void {
    if (!animated) return this.place(to);
    const from = { position: this.camera.position.clone(), target: this.orbit.target.clone() };
    this.glide = { from, to, start: performance.now() };
    this.onChange();
  }

  /** Moves on by one frame. Whether there is more to come. */
  advance(now: number): boolean {
    const seconds = Math.min((now - this.lastFrame) / 1000, 0.1);
    this.lastFrame = now;
    if (this.glide) this.glideOn(now);
    for (const key of this.keys) this.follow(key, seconds);
    return this.glide !== null || this.keys.size > 0;
  }

  private place({ position, target }: Viewpoint): void {
    this.camera.position.copy(position);
    this.orbit.target.copy(target);
    this.orbit.update();
    this.onChange();
  }

  private glideOn(now: number): void {
    const { from, to, start } = this.glide!;
    const share = Math.min((now - start) / FLIGHT_MS, 1);
    const eased = share * share * (3 - 2 * share);
    this.place({
      position: from.position.clone().lerp(to.position, eased),
      target: from.target.clone().lerp(to.target, eased),
    });
    if (share === 1) this.glide = null;
  }

  private follow(key: string, seconds: number): void {
    const move = MOVES[key];
    const turn = TURNS[key];
    if (move) this.move(move, seconds);
    if (turn) this.turn(turn[0] * TURN_RATE * seconds, turn[1] * TURN_RATE * seconds);
  }

  private move([right, up, forward]: [number, number, number], seconds: number): void {
    const ahead = this.camera.getWorldDirection(new Vector3());
    const aside = new Vector3().crossVectors(ahead, this.camera.up).normalize();
    const step = ahead
      .multiplyScalar(forward)
      .addScaledVector(aside, right)
      .addScaledVector(this.camera.up, up)
      .multiplyScalar(this.speed * seconds);
    this.camera.position.add(step);
    this.orbit.target.add(step);
    this.orbit.update();
  }

  /** Turns the look (flying) or goes around the target (orbiting). */
  private turn(aside: number, upward: number): void {
    const { camera, orbit } = this;
    const pivot = this.flying ? camera.position : orbit.target;
    const moved = this.flying ? orbit.target : camera.position;
    const arm = moved.clone().sub(pivot);
    const axis = new Vector3().crossVectors(arm, camera.up).normalize();
    const lifted = arm.clone().applyAxisAngle(axis, this.flying ? upward : upward);
    const steep = Math.abs(lifted.clone().normalize().dot(camera.up)) > 0.995;
    const turned = (steep ? arm : lifted).applyAxisAngle(camera.up, this.flying ? aside : -aside);
    moved.copy(pivot).add(turned);
    orbit.update();
    this.onChange();
  }

  private listen(): void {
    const { canvas } = this;
    canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (!(event.code in MOVES) && !(event.code in TURNS)) return;
      event.preventDefault();
      if (this.keys.size === 0) this.lastFrame = performance.now();
      this.keys.add(event.code);
      this.moved = true;
      this.onChange();
    });
    canvas.addEventListener('keyup', (event) => this.keys.delete(event.code));
    canvas.addEventListener('blur', () => this.keys.clear());
    canvas.addEventListener('pointerdown', (event) => {
      if (this.flying && event.button === 0) this.dragging = { x: event.clientX, y: event.clientY };
    });
    window.addEventListener('pointerup', () => (this.dragging = null));
    window.addEventListener('pointermove', (event) => {
      if (!this.dragging) return;
      const { clientX: x, clientY: y } = event;
      this.turn((this.dragging.x - x) * LOOK_RATE, (this.dragging.y - y) * LOOK_RATE);
      this.dragging = { x, y };
    });
  }
}
