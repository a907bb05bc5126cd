// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Mode } from '../scene/coloring';
import { h } from './dom';
import { icon, type IconName } from './icons';

export type Tool = 'measure' | 'section' | 'path' | 'rooms' | 'history' | 'gaps' | 'fly';
export type Command = 'home' | 'picture' | 'download' | 'log' | 'theme' | 'help';

const MODES: [Mode, string, string][] = [
  ['color', 'Colour', '1'],
  ['instances', 'Objects', '2'],
  ['classes', 'Classes', '3'],
  ['heat', 'Heat', '4'],
  ['evidence', 'Known', '5'],
];
const TOOLS: [Tool, string, string][] = [
  ['measure', 'Measure between two points', 'M'],
  ['section', 'Section plane', 'X'],
  ['path', 'Camera path', 'C'],
  ['rooms', 'Rooms', 'R'],
  ['history', 'Visits and changes', 'V'],
  ['gaps', 'Where to look next', 'L'],
  ['fly', 'Fly instead of orbit', 'G'],
];
const COMMANDS: [Command, string, string][] = [
  ['home', 'Show all', 'Home'],
  ['picture', 'Save a picture', 'P'],
  ['download', 'Download as GLB', ''],
  ['log', 'Corrections', ''],
  ['theme', 'Dark or light', 'T'],
  ['help', 'Keys and help', '?'],
];

function hint(label: string, key: string): string {
  return key === '' ? label : `${label} (${key})`;
}

export interface ToolbarHooks {
  onMode: (mode: Mode) => void;
  onTool: (tool: Tool) => void;
  onCommand: (command: Command) => void;
}

/** The bar at the bottom: how the map is coloured, and tools. */
export class Toolbar {
  readonly element: HTMLElement;
  private readonly modes = new Map<Mode, HTMLButtonElement>();
  private readonly tools = new Map<Tool, HTMLButtonElement>();

  constructor(hooks: ToolbarHooks) {
    const modes = MODES.map(([mode, label, key]) => {
      const button = h(
        'button',
        {
          class: 'mode',
          type: 'button',
          'aria-label': label,
          'aria-pressed': 'false',
          title: hint(label, key),
          onclick: () => hooks.onMode(mode),
        },
        icon(mode),
        h('span', {}, label),
      );
      this.modes.set(mode, button);
      return button;
    });
    const tools = TOOLS.map(([tool, label, key]) => {
      const button = this.iconButton(tool, label, key, () => hooks.onTool(tool));
      button.setAttribute('aria-pressed', 'false');
      this.tools.set(tool, button);
      return button;
    });
    const commands = COMMANDS.map(([name, label, key]) =>
      this.iconButton(name, label, key, () => hooks.onCommand(name)),
    );
    this.element = h(
      'div',
      { class: 'panel toolbar', role: 'group', 'aria-label': 'View' },
      h('div', { class: 'modes', role: 'group', 'aria-label': 'Colouring' }, ...modes),
      h('div', { class: 'tools', role: 'group', 'aria-label': 'Tools' }, ...tools),
      h('div', { class: 'tools', role: 'group', 'aria-label': 'Commands' }, ...commands),
    );
  }

  setMode(mode: Mode): void {
    for (const [name, button] of this.modes)
      button.setAttribute('aria-pressed', String(name === mode));
  }

  setTool(tool: Tool, on: boolean): void {
    this.tools.get(tool)?.setAttribute('aria-pressed', String(on));
  }

  private iconButton(
    name: IconName,
    label: string,
    key: string,
    run: () => void,
  ): HTMLButtonElement {
    return h(
      'button',
      {
        class: 'icon-button',
        type: 'button',
        'aria-label': label,
        title: hint(label, key),
        onclick: run,
      },
      icon(name),
    );
  }
}
