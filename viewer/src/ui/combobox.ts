// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { h } from './dom';

export interface ComboboxHooks {
  suggest: (typed: string) => string[];
  onSubmit: (text: string) => void;
}

/** A text field that offers completions (ARIA combobox with a listbox). */
export class Combobox {
  readonly element: HTMLElement;
  readonly input: HTMLInputElement;
  private readonly list: HTMLElement;
  private active = -1;

  constructor(
    id: string,
    label: string,
    placeholder: string,
    private readonly hooks: ComboboxHooks,
  ) {
    this.list = h('ul', {
      id: `${id}-list`,
      class: 'suggestions',
      role: 'listbox',
      'aria-label': 'Suggestions',
    });
    this.list.hidden = true;
    this.input = h('input', {
      id,
      type: 'text',
      placeholder,
      maxlength: 2000,
      autocomplete: 'off',
      spellcheck: 'false',
      enterkeyhint: 'search',
      role: 'combobox',
      'aria-label': label,
      'aria-expanded': 'false',
      'aria-controls': `${id}-list`,
      'aria-autocomplete': 'list',
    });
    this.element = h('div', { class: 'combobox' }, this.input, this.list);
    this.input.addEventListener('input', () => this.open());
    this.input.addEventListener('focus', () => this.open());
    this.input.addEventListener('blur', () => this.close());
    this.input.addEventListener('keydown', (event) => this.onKey(event));
  }

  close(): void {
    this.list.hidden = true;
    this.active = -1;
    this.input.setAttribute('aria-expanded', 'false');
    this.input.removeAttribute('aria-activedescendant');
  }

  private open(): void {
    const offers = this.hooks.suggest(this.input.value);
    this.list.replaceChildren(...offers.map((text, i) => this.option(text, i)));
    this.active = -1;
    this.list.hidden = offers.length === 0;
    this.input.setAttribute('aria-expanded', String(offers.length > 0));
  }

  private option(text: string, place: number): HTMLElement {
    const option = h(
      'li',
      { id: `${this.list.id}-${place}`, role: 'option', 'aria-selected': 'false' },
      text,
    );
    // Not "click": the field would lose the focus, and the list go, before it.
    option.addEventListener('pointerdown', (event) => {
      event.preventDefault();
      this.take(text);
    });
    return option;
  }

  private take(text: string): void {
    this.input.value = text;
    this.close();
    this.hooks.onSubmit(text);
  }

  private onKey(event: KeyboardEvent): void {
    const options = [...this.list.children] as HTMLElement[];
    const open = !this.list.hidden && options.length > 0;
    if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
      event.preventDefault();
      if (!open) return this.open();
      const step = event.key === 'ArrowDown' ? 1 : -1;
      this.mark(
        options,
        (this.active + step + options.length + (this.active < 0 && step < 0 ? 1 : 0)) %
          options.length,
      );
    } else if (event.key === 'Enter') {
      event.preventDefault();
      this.take(options[this.active]?.textContent ?? this.input.value);
    } else if (event.key === 'Escape' && open) {
      event.stopPropagation();
      this.close();
    }
  }

  private mark(options: HTMLElement[], place: number): void {
    this.active = place;
    options.forEach((option, i) => option.setAttribute('aria-selected', String(i === place)));
    options[place]?.scrollIntoView({ block: 'nearest' });
    this.input.setAttribute('aria-activedescendant', options[place]?.id ?? '');
  }
}
