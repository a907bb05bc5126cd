// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Color } from '../api/types';

const ROW = 256;
export const NO_INSTANCE: Color = [170, 170, 170];

/** The colour of every instance, as a picture that the shader looks up: 256 instances a row. */
export class InstanceTable {
  readonly width = ROW;
  readonly height: number;
  readonly pixels: Uint8Array;
  private readonly hidden = new Set<number>();

  constructor(largestId: number) {
    this.height = Math.max(1, Math.ceil((largestId + 1) / ROW));
    this.pixels = new Uint8Array(ROW * this.height * 4);
    this.fill(NO_INSTANCE);
  }

  fill(color: Color): void {
    for (let id = 0; id < ROW * this.height; ++id) this.set(id, color);
  }

  set(id: number, color: Color): void {
    if (id >= ROW * this.height) return;
    this.pixels.set([...color, this.hidden.has(id) ? 0 : 255], id * 4);
  }

  hide(id: number, hidden: boolean): void {
    if (hidden) this.hidden.add(id);
    else this.hidden.delete(id);
    if (id < ROW * this.height) this.pixels[id * 4 + 3] = hidden ? 0 : 255;
  }

  isHidden(id: number): boolean {
    return this.hidden.has(id);
  }

  get hiddenCount(): number {
    return this.hidden.size;
  }
}
