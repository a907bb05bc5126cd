// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Color, Labels } from '../api/types';

const ROW = 256;
const MOST_LABELS = ROW * 4096; // what textures can be high everywhere
const HIDDEN = 0;
const SELECTED = 128;
const PLAIN = 255;
export const NO_INSTANCE: Color = [170, 170, 170];

/**
 * How each label of the surface is drawn, as a picture that the shader looks up: 256 labels a row. The surface itself knows labels alone;
 * to which object they belong may change at any time.
 */
export class LabelTable {
  readonly width = ROW;
  height = 1;
  pixels = new Uint8Array(ROW * 4);
  private instances: readonly number[] = [];
  private hidden: ReadonlySet<number> = new Set();
  private absent: ReadonlySet<number> = new Set();
  private colors: ReadonlyMap<number, Color> = new Map();
  private other: Color = NO_INSTANCE;
  private selected = 0;

  constructor() {
    this.fill();
  }

  setLabels(labels: Labels): void {
    this.instances = labels.instances;
    this.hidden = new Set(labels.hidden);
    const count = Math.min(Math.max(labels.instances.length, 1), MOST_LABELS);
    if (count > ROW * this.height) {
      this.height = 2 ** Math.ceil(Math.log2(count / ROW)); // rarely a new texture
      this.pixels = new Uint8Array(ROW * this.height * 4);
    }
    this.fill();
  }

  /** Objects that are not drawn for now, whatever the labels say. */
  leaveOut(absent: ReadonlySet<number>): void {
    this.absent = absent;
    this.fill();
  }

  /** Colours by object; `other` is what belongs to none of them. */
  paint(colors: ReadonlyMap<number, Color>, other: Color): void {
    this.colors = colors;
    this.other = other;
    this.fill();
  }

  /** 0: none. */
  select(id: number): void {
    this.selected = id;
    this.fill();
  }

  /** The object that a label belongs to; 0: none. */
  instanceOf(label: number): number {
    return this.instances[label] ?? 0;
  }

  isHidden(label: number): boolean {
    return this.isLeftOut(this.instanceOf(label));
  }

  private fill(): void {
    for (let label = 0; label < ROW * this.height; ++label) {
      const id = this.instanceOf(label);
      const [r, g, b] = this.colors.get(id) ?? this.other;
      const at = label * 4;
      this.pixels[at] = r;
      this.pixels[at + 1] = g;
      this.pixels[at + 2] = b;
      this.pixels[at + 3] = this.isLeftOut(id) ? HIDDEN : this.isSelected(id) ? SELECTED : PLAIN;
    }
  }

  private isLeftOut(id: number): boolean {
    return this.hidden.has(id) || this.absent.has(id);
  }

  private isSelected(id: number): boolean {
    return id !== 0 && id === this.selected;
  }
}
