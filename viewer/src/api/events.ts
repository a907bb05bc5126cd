// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { FrameEvent, Tracking } from './types';

export interface EventHandlers {
  /** Names, objects or the state of search changed. */
  onMap: () => void;
  onMesh: () => void;
  onFrame: (frame: FrameEvent) => void;
  /** The camera was lost or found, or loops of its way were closed. */
  onTracking: (tracking: Tracking) => void;
  /** The connection was lost (false) or came back (true). */
  onConnection: (connected: boolean) => void;
}

/** Listens to the server's events after one of them; the browser connects again by itself. */
export function listen(after: number, handlers: EventHandlers): void {
  const source = new EventSource(`/api/events?after=${after}`);
  let lost = false;
  source.addEventListener('map', handlers.onMap);
  source.addEventListener('mesh', handlers.onMesh);
  source.addEventListener('frame', (event: MessageEvent<string>) =>
    handlers.onFrame(JSON.parse(event.data) as FrameEvent),
  );
  source.addEventListener('tracking', (event: MessageEvent<string>) =>
    handlers.onTracking(JSON.parse(event.data) as Tracking),
  );
  source.addEventListener('reset', () => {
    handlers.onMap();
    handlers.onMesh();
  });
  source.addEventListener('hello', () => {
    if (lost) {
      handlers.onConnection(true);
      handlers.onMap(); // a new server knows nothing of what this page missed
      handlers.onMesh();
    }
    lost = false;
  });
  source.addEventListener('error', () => {
    if (!lost) handlers.onConnection(false);
    lost = true;
  });
}
