// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Tracking } from './api/types';
import type { MapView } from './scene/map-view';
import type { Status } from './ui/status';
import { plural } from './ui/words';

/** What is said when the camera is lost, found again, or came by a place again; empty: nothing. */
export function trackingText(before: Tracking['state'], now: Tracking, loops: number): string {
  if (now.loops > loops)
    return `The camera came by ${plural(now.loops, 'place')} again: the map was set right`;
  if (now.state === 'tracked' && before === 'lost') return 'The camera is found again';
  return '';
}

/** Whether the camera knows where it is: drawn red where it does not, with what to point it at. */
export class CameraState {
  view: MapView | null = null;
  private state: Tracking['state'] = 'given';
  private loops = 0;

  constructor(private readonly status: Status) {}

  show(tracking: Tracking): void {
    const said = trackingText(this.state, tracking, this.loops);
    if (said !== '') this.status.toast(said);
    const lost = tracking.state === 'lost';
    if (lost)
      this.status.setBanner(
        `The camera has been lost for ${plural(tracking.frames_lost, 'frame')}. Point it at what the red ` +
          'camera sees, from about there; nothing is added to the map meanwhile.',
      );
    else if (this.state === 'lost') this.status.setBanner('');
    this.view?.showLost(lost ? tracking.world_from_camera : null);
    this.state = tracking.state;
    this.loops = tracking.loops;
  }
}
