// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { h } from './dom';

const KEYS: [string, string][] = [
  ['/', 'write a query'],
  ['1 2 3 4 5', 'colour, objects, classes, heat, how well places are known'],
  ['drag, wheel', 'turn and zoom (two fingers on a touch screen)'],
  ['right drag', 'shift'],
  ['arrows', 'turn, when the 3D view has the focus'],
  ['W A S D Q E', 'move forward, left, back, right, down, up'],
  ['G', 'fly: dragging looks around'],
  ['click', 'select an object'],
  ['F', 'go to the selected object'],
  ['H', 'hide the selected object'],
  ['N', 'name the selected object'],
  ['U', 'undo the latest correction'],
  ['M', 'measure between two points'],
  ['X', 'section plane'],
  ['C', 'camera path'],
  ['R', 'rooms and doors'],
  ['V', 'visits and what they found changed'],
  ['L', 'where to look next, for who scans'],
  ['Home', 'show all'],
  ['P', 'save a picture'],
  ['T', 'dark or light'],
  ['Esc', 'end a tool, close the card, clear the query'],
];

/** The dialog with all keys. */
export class Help {
  readonly element: HTMLDialogElement;

  constructor() {
    const rows = KEYS.map(([key, what]) =>
      h(
        'tr',
        {},
        h('th', { scope: 'row' }, ...key.split(' ').map((part) => h('kbd', {}, part))),
        h('td', {}, what),
      ),
    );
    const close = h(
      'button',
      { class: 'primary', type: 'button', onclick: () => this.element.close() },
      'Close',
    );
    this.element = h(
      'dialog',
      { class: 'panel help', 'aria-labelledby': 'help-title' },
      h('h2', { id: 'help-title' }, 'Keys'),
      h('table', {}, h('tbody', {}, ...rows)),
      close,
    );
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else this.element.showModal();
  }
}
