// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { Color, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';

/** WebGL 2 is missing or switched off. */
export class NoWebGlError extends Error {
  constructor() {
    super(
      'This browser cannot draw in 3D: WebGL 2 is missing or switched off. ' +
        'Switch on hardware acceleration in its settings, or use a current Firefox, Chrome or Safari. ' +
        'Searching and the list of objects work without.',
    );
  }
}

const SLOW_FRAME_MS = 45;
const SETTLE_MS = 220;

export interface StageHooks {
  /** Before each frame; whether another one must follow. */
  onFrame: (now: number) => boolean;
  /** Few triangles while moving on a slow machine (true), all of them at rest (false). */
  onDetail: (coarse: boolean) => void;
  onLost: () => void;
}

function makeRenderer(canvas: HTMLCanvasElement): WebGLRenderer {
  // three.js writes the fault to the console, and we say it to the person.
  const context = canvas.getContext('webgl2', { antialias: true, powerPreference: 'high-performance' });
  if (!context) throw new NoWebGlError();
  return new WebGLRenderer({ canvas, context });
}

/** The canvas: draws when something changed, and takes care that a slow machine stays usable. */
export class Stage {
  readonly scene = new Scene();
  readonly camera: PerspectiveCamera;
  private readonly renderer: WebGLRenderer;
  private wanted = false;
  private frameMs = 0;
  private settle = 0;
  private moving = false;

  constructor(
    readonly canvas: HTMLCanvasElement,
    up: Vector3,
    private readonly hooks: StageHooks,
  ) {
    this.renderer = makeRenderer(canvas);
    this.camera = new PerspectiveCamera(50, 1, 0.02, 500);
    this.camera.up.copy(up).normalize();
    new ResizeObserver(() => this.resize()).observe(canvas);
    canvas.addEventListener('webglcontextlost', () => hooks.onLost());
    this.resize();
  }

  setBackground(color: string): void {
    this.scene.background = new Color(color);
    this.draw();
  }

  /** Asks for a new frame. */
  draw(): void {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame((now) => this.frame(now));
  }

  /** The view began to move: detail may go until it rests. */
  moved(): void {
    this.moving = true;
    if (this.frameMs > SLOW_FRAME_MS) this.hooks.onDetail(true);
    window.clearTimeout(this.settle);
    this.settle = window.setTimeout(() => {
      this.moving = false;
      this.hooks.onDetail(false);
      this.draw();
    }, SETTLE_MS);
    this.draw();
  }

  /** What is seen now, as a PNG. */
  picture(): Promise<Blob | null> {
    this.hooks.onDetail(false);
    this.renderer.render(this.scene, this.camera);
    return new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
  }

  private frame(now: number): void {
    this.wanted = false;
    const more = this.hooks.onFrame(now);
    const start = performance.now();
    this.renderer.render(this.scene, this.camera);
    if (!this.moving) this.measure(start);
    if (more) this.draw();
  }

  /** How long a detailed frame takes; the next task runs once it is drawn, in software at least. */
  private measure(start: number): void {
    const gl = this.renderer.getContext();
    gl.flush();
    setTimeout(() => {
      const took = performance.now() - start;
      this.frameMs = this.frameMs === 0 ? took : 0.5 * this.frameMs + 0.5 * took;
    });
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}
