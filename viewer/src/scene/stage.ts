// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Lens } from './framing';
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
const LOADING_FRAME_MS = 250;

/** Pixels of the canvas that panels lie over. */
export interface Covered {
  left: number;
  bottom: number;
}

export interface StageHooks {
  /** Before each frame; whether another one must follow. */
  onFrame: (now: number) => boolean;
  /** Few triangles while moving on a slow machine (true), all of them at rest (false). */
  onDetail: (coarse: boolean) => void;
  /** The view has moved and rests. */
  onRest: () => void;
  onLost: () => void;
}

/** Whether the browser draws on the processor, where smooth edges cost too much. */
function drawsInSoftware(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return false;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|basic render/i.test(name);
}

function makeRenderer(canvas: HTMLCanvasElement): WebGLRenderer {
  const antialias = !drawsInSoftware();
  // Without a context three.js writes to the console alone, where nobody looks.
  const context = canvas.getContext('webgl2', { antialias, powerPreference: 'high-performance' });
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
  private held = false;
  private lastFrame = 0;
  private covered: Covered = { left: 0, bottom: 0 };
  private waiting: (() => void)[] = [];

  constructor(
    readonly canvas: HTMLCanvasElement,
    up: Vector3,
    private readonly hooks: StageHooks,
  ) {
    this.renderer = makeRenderer(canvas);
    this.camera = new PerspectiveCamera(50, 1, 0.02, 500);
    this.camera.up.copy(up).normalize();
    new ResizeObserver(() => this.resize()).observe(canvas);
    canvas.addEventListener('pointerdown', () => (this.held = true));
    for (const end of ['pointerup', 'pointercancel'])
      window.addEventListener(end, () => (this.held = false));
    canvas.addEventListener('webglcontextlost', () => hooks.onLost());
    this.resize();
  }

  setBackground(color: string): void {
    this.scene.background = new Color(color);
    this.draw();
  }

  /** The middle of what is seen goes to the middle of what no panel covers. */
  setCovered(covered: Covered): void {
    this.covered = covered;
    this.resize();
  }

  /** Of the part of the canvas that is free. */
  lens(): Lens {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const halfHeight = Math.tan((this.camera.fov * Math.PI) / 360);
    return {
      halfHeight: halfHeight * (1 - this.covered.bottom / height),
      halfWidth: (halfHeight * (width - this.covered.left)) / height,
    };
  }

  whenDrawn(): Promise<void> {
    this.draw();
    return new Promise((resolve) => this.waiting.push(resolve));
  }

  /** Asks for a new frame. */
  draw(): void {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame((now) => this.frame(now));
  }

  /** Asks for a frame that need not come at once: while the map loads. */
  drawSoon(): void {
    const pause = Math.max(LOADING_FRAME_MS, 3 * this.frameMs);
    if (performance.now() - this.lastFrame > pause) this.draw();
  }

  /** The view began to move: detail may go until it rests. */
  moved(): void {
    this.moving = true;
    if (this.frameMs > SLOW_FRAME_MS) this.hooks.onDetail(true);
    this.settleSoon();
    this.draw();
  }

  /** Not while somebody holds the view: a slow frame in between would make them wait. */
  private settleSoon(): void {
    window.clearTimeout(this.settle);
    this.settle = window.setTimeout(() => {
      if (this.held) return this.settleSoon();
      this.moving = false;
      this.hooks.onDetail(false);
      this.hooks.onRest();
      this.draw();
    }, SETTLE_MS);
  }

  /** What is seen now, as a PNG. */
  picture(): Promise<Blob | null> {
    this.hooks.onDetail(false);
    this.renderer.render(this.scene, this.camera);
    return new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
  }

  private frame(now: number): void {
    this.wanted = false;
    this.lastFrame = now;
    const more = this.hooks.onFrame(now);
    const start = performance.now();
    this.renderer.render(this.scene, this.camera);
    if (!this.moving) this.measure(start);
    if (this.waiting.length > 0) this.finish();
    if (more) this.draw();
  }

  /** Reading a pixel back waits until the frame is drawn. */
  private finish(): void {
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    this.waiting.splice(0).forEach((resolve) => resolve());
  }

  /** How long a detailed frame takes, until the last pixel is drawn. */
  private measure(start: number): void {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const drawn = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const check = (): void => {
      if (!drawn || gl.isContextLost()) return;
      if (gl.clientWaitSync(drawn, 0, 0) === gl.TIMEOUT_EXPIRED) {
        setTimeout(check, 2);
        return;
      }
      gl.deleteSync(drawn);
      const took = performance.now() - start;
      this.frameMs = this.frameMs === 0 ? took : 0.5 * this.frameMs + 0.5 * took;
    };
    setTimeout(check);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    const { left, bottom } = this.covered;
    this.camera.setViewOffset(width, height, -left / 2, bottom / 2, width, height);
    this.draw();
  }
}
