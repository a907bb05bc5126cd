// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { Instance, Labels, MapInfo } from './api/types';
import type { Status } from './ui/status';

const FIRST_FRAME_MS = 500; // between looks whether there is one

/** All that is known of a map besides its surface. */
export function loadObjects(): Promise<[MapInfo, Instance[], Labels]> {
  return Promise.all([api.map(), api.instances(), api.labels()]);
}

/** A map that is being made shows something from its first frame on. Returns the latest event before it is loaded. */
export async function waitForFrames(status: Status): Promise<number> {
  let info = await api.map();
  for (; info.live && info.frames === 0; info = await api.map()) {
    status.setBanner('Waiting for the first frames …');
    await new Promise((resolve) => setTimeout(resolve, FIRST_FRAME_MS));
  }
  status.setBanner('');
  return info.last_event;
}
