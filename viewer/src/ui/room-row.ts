// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Room } from '../api/types';
import { roomColor } from '../scene/room-marks';
import { h, swatch } from './dom';
import { plural } from './words';

/** A line of the list of rooms. */
export function roomRow(room: Room, onSelect: (room: Room) => void): HTMLElement {
  const named = room.name !== `room ${room.id}`;
  const button = h(
    'button',
    { class: 'row', type: 'button', 'data-room': room.id, onclick: () => onSelect(room) },
    h(
      'span',
      { class: 'row-text' },
      h(
        'span',
        { class: 'row-head' },
        swatch(roomColor(room)),
        h('span', { class: 'name' }, room.name, named && h('small', {}, ` room ${room.id}`)),
      ),
      h(
        'span',
        { class: 'detail' },
        `${room.area_m2.toFixed(1)} m², ${plural(room.objects.length, 'object')}`,
      ),
    ),
  );
  return h('li', {}, button);
}
