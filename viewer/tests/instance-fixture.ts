// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Instance } from '../src/api/types';

export function instance(id: number, more: Partial<Instance> = {}): Instance {
  return {
    id,
    name: '',
    label: null,
    guesses: [],
    writing: [],
    class: null,
    color: [id, 0, 0],
    box: { min: [0, 0, 0], max: [1, 2, 3] },
    centroid: [0.5, 1, 1.5],
    points: 10,
    locked: false,
    views: 3,
    last_seen: null,
    confidence: 0.72,
    crops: [],
    ...more,
  };
}
