// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';
import type { Tracking } from '../src/api/types';
import { trackingText } from '../src/camera-state';
import { LostCamera } from '../src/scene/camera-path';

const HERE = [1, 0, 0, 2, 0, 1, 0, 3, 0, 0, 1, 4];

function tracking(more: Partial<Tracking>): Tracking {
  return { state: 'tracked', frames_lost: 0, loops: 0, world_from_camera: HERE, ...more };
}

describe('the camera', () => {
  test('is found again once, and is not when it was never lost', () => {
    expect(trackingText('lost', tracking({}), 0)).toBe('The camera is found again');
    expect(trackingText('given', tracking({}), 0)).toBe('');
    expect(trackingText('tracked', tracking({ state: 'lost', frames_lost: 3 }), 0)).toBe('');
  });

  test('came by places again', () => {
    expect(trackingText('tracked', tracking({ loops: 2 }), 0)).toContain('by 2 places again');
    expect(trackingText('tracked', tracking({ loops: 2 }), 2)).toBe('');
  });

  test('is drawn where it was tracked last, until it is found', () => {
    const lost = new LostCamera();
    const lens = { width: 640, height: 480, fx: 500, fy: 500, cx: 319.5, cy: 239.5 };
    lost.show(lens, HERE);
    lost.show(lens, HERE);
    expect(lost.group.children).toHaveLength(1);
    lost.show(lens, null);
    expect(lost.group.children).toHaveLength(0);
  });
});
