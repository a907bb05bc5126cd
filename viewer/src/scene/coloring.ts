// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Color, Instance } from '../api/types';
import { type LabelTable, NO_INSTANCE } from './label-table';

export type Mode = 'color' | 'instances' | 'classes' | 'heat' | 'evidence';

/** The colour at `share` in [0, 1] of a ramp. */
export function rampColor(ramp: readonly Color[], share: number): Color {
  const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const below = Math.min(Math.floor(at), ramp.length - 2);
  const weight = at - below;
  const mix = (c: 0 | 1 | 2): number =>
    Math.round(ramp[below]![c] * (1 - weight) + ramp[below + 1]![c] * weight);
  return [mix(0), mix(1), mix(2)];
}

/** From surface that is known to a millimetre or two to such as is hardly known. */
export const EVIDENCE_RAMP: readonly Color[] = [
  [38, 120, 90],
  [140, 190, 90],
  [245, 200, 80],
  [225, 90, 60],
];
/** Metres of standard error at the ends of the ramp. */
export const EVIDENCE_M: readonly [number, number] = [0.001, 0.01];

export interface ColoringInput {
  mode: Mode;
  instances: readonly Instance[];
  /** Relevance in [0, 1] by instance id; empty: nothing was asked. */
  heat: ReadonlyMap<number, number>;
  ramp: readonly Color[];
}

function colorOf(instance: Instance, { mode, heat, ramp }: ColoringInput): Color {
  if (mode === 'classes') return instance.class?.color ?? NO_INSTANCE;
  if (mode === 'heat') return rampColor(ramp, heat.get(instance.id) ?? 0);
  return instance.color;
}

/** Fills the table with what the mode shows. */
export function paint(table: LabelTable, input: ColoringInput): void {
  const colors = input.instances.map(
    (instance) => [instance.id, colorOf(instance, input)] as const,
  );
  table.paint(new Map(colors), input.mode === 'heat' ? rampColor(input.ramp, 0) : NO_INSTANCE);
}
