// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';
import type { Gap } from '../src/api/types';
import { GapMarks, gapColor, gapEdges } from '../src/scene/gap-marks';

const GAP: Gap = {
  kind: 'unseen',
  middle: [1, 0.5, 1],
  box: { min: [0, 0, 0], max: [2, 1, 3] },
  area_m2: 1.5,
};

describe('where to look next', () => {
  test('is a box with a cross in it', () => {
    const edges = gapEdges(GAP);
    expect(edges).toHaveLength(2 * (12 + 3));
    const lengths = edges.flatMap((at, i) => (i % 2 ? [at.distanceTo(edges[i - 1]!)] : []));
    expect(lengths.slice(0, 12).sort()).toEqual([1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3]);
    expect(edges[24]!.clone().add(edges[25]!).multiplyScalar(0.5).toArray()).toEqual(GAP.middle);
  });

  test('differs in colour by what is wrong with it', () => {
    expect(gapColor(GAP)).not.toEqual(gapColor({ ...GAP, kind: 'thin' }));
  });

  test('goes when there are none', () => {
    const marks = new GapMarks();
    marks.show([GAP, GAP]);
    expect(marks.group.children).toHaveLength(2);
    marks.show([]);
    expect(marks.group.children).toHaveLength(0);
  });
});
