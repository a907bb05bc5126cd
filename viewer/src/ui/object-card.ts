// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from '../api/client';
import type { Box, Instance, InstanceDetail, Neighbor, Part } from '../api/types';
import { h, swatch } from './dom';
import { icon, type IconName } from './icons';
import { isGuess, lastSeenText, percent, placeOf, plural, sizeOf, titleOf } from './words';

export interface CardHooks {
  onFocus: (id: number) => void;
  onAlike: (id: number) => void;
  onStand: (id: number) => void;
  onRename: (id: number, name: string) => void;
  onMerge: (id: number) => void;
  onSplit: (id: number) => void;
  onHide: (id: number) => void;
  onLock: (id: number) => void;
  onDelete: (id: number) => void;
  onSelect: (id: number) => void;
  onPart: (box: Box) => void;
  onClose: () => void;
}

export interface CardContext {
  find: (id: number) => Instance | undefined;
}

/** What is known of the selected object, and what one can do with it. */
export class ObjectCard {
  readonly element = h('section', { class: 'panel card', 'aria-label': 'Selected object' });

  constructor(private readonly hooks: CardHooks) {
    this.element.hidden = true;
  }

  close(): void {
    this.element.hidden = true;
  }

  show(instance: Instance): void {
    this.element.hidden = false;
    this.element.replaceChildren(
      this.header(instance),
      crops(instance),
      this.actions(instance),
      facts(instance, null),
      guesses(instance),
      h('div', { class: 'parts' }),
      h('div', { class: 'neighbors' }),
    );
  }

  /** Asks for a new name of the object that is shown. */
  startRename(): void {
    this.element.querySelector<HTMLButtonElement>('[data-action="rename"]')?.click();
  }

  /** Whether a person is giving something a new name; with an id, whether it is that object. */
  renames(id?: number): boolean {
    const form = this.element.querySelector<HTMLFormElement>('form.rename');
    return form !== null && (id === undefined || form.dataset.id === String(id));
  }

  /** The parts that come with a second reply. */
  showDetail(detail: InstanceDetail, context: CardContext): void {
    this.element.querySelector('.facts-table')?.replaceWith(facts(detail, detail));
    this.element.querySelector('.parts')?.replaceWith(this.parts(detail.parts));
    this.element
      .querySelector('.neighbors')
      ?.replaceWith(this.neighbors(detail.neighbors, context));
  }

  private header(instance: Instance): HTMLElement {
    const title = h(
      'h2',
      { class: isGuess(instance) ? 'guess' : '' },
      titleOf(instance),
      ' ',
      h('small', {}, `#${instance.id}`),
    );
    const close = h(
      'button',
      {
        class: 'icon-button',
        type: 'button',
        'aria-label': 'Close the card',
        onclick: () => this.hooks.onClose(),
      },
      icon('close'),
    );
    return h('header', { class: 'card-head' }, swatch(instance.color), title, close);
  }

  private actions(instance: Instance): HTMLElement {
    const { id, locked } = instance;
    const free = locked ? 'It is locked; unlock it first' : '';
    const action = (name: IconName, label: string, run: () => void, why = ''): HTMLElement =>
      h(
        'button',
        {
          class: 'action',
          type: 'button',
          'data-action': name,
          disabled: why !== '',
          title: why || label,
          onclick: run,
        },
        icon(name),
        h('span', {}, label),
      );
    return h(
      'div',
      { class: 'actions', role: 'group', 'aria-label': 'Actions' },
      action('focus', 'Focus', () => this.hooks.onFocus(id)),
      action(
        'alike',
        'More like this',
        () => this.hooks.onAlike(id),
        instance.guesses.length ? '' : 'This object has no embedding',
      ),
      action('stand', 'Where to stand', () => this.hooks.onStand(id)),
      action('rename', 'Rename', () => this.editName(instance), free),
      action('hide', 'Hide', () => this.hooks.onHide(id)),
      action('merge', 'Merge', () => this.hooks.onMerge(id), free),
      action('split', 'Split', () => this.hooks.onSplit(id), free),
      action('lock', locked ? 'Unlock' : 'Lock', () => this.hooks.onLock(id)),
      action('delete', 'Delete', () => this.hooks.onDelete(id), free),
    );
  }

  private editName(instance: Instance): void {
    const field = h('input', {
      id: 'new-name',
      type: 'text',
      value: instance.name,
      maxlength: 100,
      placeholder: titleOf(instance),
      autocomplete: 'off',
    });
    const form = h(
      'form',
      { class: 'rename', 'data-id': instance.id },
      h('label', { for: 'new-name' }, 'New name'),
      field,
      h('button', { class: 'primary', type: 'submit' }, 'Save'),
    );
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.hooks.onRename(instance.id, field.value.trim());
    });
    form.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape') return;
      event.stopPropagation();
      form.remove();
    });
    this.element.querySelector('form.rename')?.remove();
    this.element.querySelector('.actions')?.after(form);
    field.focus();
    field.select();
  }

  private parts(parts: readonly Part[]): HTMLElement {
    const rows = parts.map((part) => {
      const button = h(
        'button',
        { class: 'neighbor', type: 'button', onclick: () => this.hooks.onPart(part.box) },
        `Part ${part.number}`,
        h('small', {}, sizeOf(part)),
      );
      return h('li', {}, button);
    });
    if (rows.length === 0) return h('div', { class: 'parts' });
    return h('div', { class: 'parts' }, h('h3', {}, 'Parts'), h('ul', {}, ...rows));
  }

  private neighbors(neighbors: readonly Neighbor[], context: CardContext): HTMLElement {
    if (neighbors.length === 0)
      return h(
        'div',
        { class: 'neighbors' },
        h('h3', {}, 'Neighbours'),
        h('p', { class: 'detail' }, 'Nothing within a metre.'),
      );
    const rows = neighbors.flatMap((neighbor) => {
      const other = context.find(neighbor.id);
      if (!other) return [];
      const button = h(
        'button',
        {
          class: 'neighbor',
          type: 'button',
          title: neighbor.evidence,
          onclick: () => this.hooks.onSelect(other.id),
        },
        h('span', { class: 'relation' }, neighbor.relation),
        swatch(other.color),
        titleOf(other),
        h('small', {}, `${(neighbor.gap_m * 100).toFixed(0)} cm`),
      );
      return [h('li', {}, button)];
    });
    return h('div', { class: 'neighbors' }, h('h3', {}, 'Neighbours'), h('ul', {}, ...rows));
  }
}

function crops(instance: Instance): HTMLElement {
  if (instance.crops.length === 0)
    return h('p', { class: 'detail' }, 'No pictures of this object are kept.');
  const pictures = instance.crops.map((crop, i) =>
    h('img', {
      src: api.cropUrl(instance.id, crop),
      alt: `${titleOf(instance)}, view ${i + 1}`,
      loading: 'lazy',
    }),
  );
  return h(
    'div',
    { class: 'crops', role: 'group', 'aria-label': 'Views', tabindex: 0 },
    ...pictures,
  );
}

function facts(instance: Instance, detail: InstanceDetail | null): HTMLElement {
  const entry = (name: string, value: string): HTMLElement[] => [
    h('dt', {}, name),
    h('dd', {}, value),
  ];
  return h(
    'dl',
    { class: 'facts-table' },
    ...entry('Size', sizeOf(instance)),
    ...(detail ? entry('Height', `${detail.height_m.toFixed(2)} m`) : []),
    ...(detail ? entry('Footprint', `${detail.footprint_m2.toFixed(2)} m²`) : []),
    ...entry('Position', placeOf(instance)),
    ...entry('Seen in', plural(instance.views, 'frame')),
    ...(lastSeenText(instance) ? entry('Last seen', lastSeenText(instance)) : []),
    ...(instance.confidence === null
      ? []
      : entry('Whole by its masks', percent(instance.confidence))),
    ...entry('Surface', plural(instance.points, 'voxel')),
    ...(instance.writing.length > 0 ? entry('Reads', writingOf(instance)) : []),
  );
}

const MOST_LINES = 6;

/** “EXIT”, “Mobile” … */
function writingOf({ writing }: Instance): string {
  const lines = writing.slice(0, MOST_LINES).map((line) => `“${line.text}”`);
  return lines.join(', ') + (writing.length > MOST_LINES ? ' …' : '');
}

function guesses(instance: Instance): HTMLElement {
  const rows = instance.guesses.map((guess) =>
    h(
      'li',
      {},
      h('span', {}, guess.name),
      h('small', { title: 'cosine' }, guess.cosine.toFixed(2)),
    ),
  );
  return h(
    'div',
    { class: 'guesses' },
    rows.length > 0 && h('h3', {}, 'Best names'),
    h('ol', {}, ...rows),
  );
}
