// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import type { Answer, Box, Gap, HistoryEvent, Instance, MapInfo, Room } from '../api/types';
import { Combobox } from './combobox';
import { h } from './dom';
import { eventRow, pastRow } from './event-row';
import { gapRow } from './gap-row';
import { icon } from './icons';
import { objectRow } from './object-row';
import { roomRow } from './room-row';
import { suggest, vocabularyOf } from './suggestions';
import { countText, plural, withTitles } from './words';

const MOST_RECENT = 5;

export interface SearchHooks {
  onQuery: (text: string, not: string[]) => void;
  onClear: () => void;
  onSelect: (id: number, part: Box | null) => void;
  onEvent: (event: HistoryEvent) => void;
  onRoom: (room: Room) => void;
  onGap: (gap: Gap) => void;
  eventOf: (id: number) => HistoryEvent | undefined;
}

/** The panel on the left: query, its answer, or all objects. */
export class SearchPanel {
  readonly element: HTMLElement;
  private readonly box: Combobox;
  private readonly not = h('input', {
    id: 'not',
    type: 'text',
    placeholder: 'e.g. armchair, stool',
    autocomplete: 'off',
  });
  private readonly heading = h('h1', {}, 'ovimap');
  private readonly facts = h('p', { class: 'facts' });
  private readonly verdict = h('div', { class: 'verdict', role: 'status', 'aria-live': 'polite' });
  private readonly listTitle = h('h2', { id: 'list-title' });
  private readonly list = h('ul', { class: 'rows', 'aria-labelledby': 'list-title' });
  private readonly clear: HTMLButtonElement;
  private readonly recent: string[] = [];
  private objects = 0;
  private frames = 0;
  private vocabulary: string[] = [];
  private instances = new Map<number, Instance>();

  constructor(private readonly hooks: SearchHooks) {
    this.box = new Combobox('query', 'What to look for', 'Find: mug on the table', {
      suggest: (typed) => suggest(typed, this.vocabulary, this.recent),
      onSubmit: () => this.submit(),
    });
    this.clear = h(
      'button',
      {
        class: 'icon-button',
        type: 'button',
        'aria-label': 'Clear the query',
        onclick: () => this.reset(),
      },
      icon('close'),
    );
    this.clear.hidden = true;
    this.element = this.build();
  }

  focus(): void {
    this.box.input.focus();
    this.box.input.select();
  }

  setMap(info: MapInfo): void {
    this.heading.textContent = info.title;
    this.facts.classList.toggle('live', info.live);
    this.objects = info.instances;
    if (!info.live) this.frames = 0;
    this.setFrames(info.frames);
    const { state, reason } = info.search;
    this.verdict.className = 'verdict note';
    if (state === 'unavailable')
      this.verdict.textContent = `No search but for names that people gave: ${reason}`;
    else if (this.verdict.dataset.kind === 'note') this.verdict.textContent = '';
    this.verdict.dataset.kind = 'note';
  }

  /** How many frames the map is made of by now. */
  setFrames(frames: number): void {
    this.frames = Math.max(this.frames, frames); // objects are counted less often than frames
    this.facts.textContent = `${plural(this.objects, 'object')} from ${plural(this.frames, 'frame')}`;
  }

  setInstances(instances: readonly Instance[]): void {
    this.instances = new Map(instances.map((instance) => [instance.id, instance]));
    this.vocabulary = vocabularyOf(instances);
  }

  showAll(selected: number): void {
    const bySize = [...this.instances.values()].sort((a, b) => b.points - a.points);
    this.listTitle.textContent = 'All objects';
    this.fill(
      bySize.map((instance) => objectRow(instance, null, '', this.hooks.onSelect)),
      selected,
    );
  }

  showChanges(events: readonly HistoryEvent[]): void {
    this.listTitle.textContent = events.length > 0 ? 'Changes, the latest first' : 'No changes';
    this.fill(
      events.map((event) =>
        eventRow(event, this.instances.get(event.instance), this.hooks.onEvent),
      ),
      0,
    );
  }

  showRooms(rooms: readonly Room[]): void {
    this.listTitle.textContent = rooms.length > 0 ? 'Rooms' : 'No rooms were found';
    this.fill(
      rooms.map((room) => roomRow(room, this.hooks.onRoom)),
      0,
    );
  }

  showGaps(gaps: readonly Gap[]): void {
    this.listTitle.textContent =
      gaps.length > 0 ? 'Where to look next' : 'Nothing is left to look at';
    this.fill(
      gaps.map((gap, i) => gapRow(gap, i + 1, this.hooks.onGap)),
      0,
    );
  }

  showAnswer(answer: Answer, selected: number): void {
    const found = answer.verdict === 'found';
    this.clear.hidden = false;
    this.verdict.dataset.kind = 'answer';
    this.verdict.className = `verdict ${found ? 'found' : 'absent'}`;
    this.verdict.textContent = found ? 'Found' : 'Not in the map';
    const more = [
      answer.count && countText(answer.count),
      answer.reading && `read as ${answer.reading}`,
      withTitles(answer.reason, (id) => this.instances.get(id)),
    ];
    for (const text of more) if (text) this.verdict.append(h('small', {}, text));
    this.listTitle.textContent =
      answer.matches.length === 0 ? '' : found ? 'Best matches' : 'What comes nearest';
    const rows = answer.matches.flatMap((match) => {
      const event = match.event === null ? undefined : this.hooks.eventOf(match.event);
      if (event) return [pastRow(event, match, this.hooks.onEvent)];
      const instance = this.instances.get(match.id);
      const evidence = withTitles(match.evidence, (id) => this.instances.get(id));
      return instance ? [objectRow(instance, match, evidence, this.hooks.onSelect)] : [];
    });
    this.fill(rows, selected);
  }

  showBusy(): void {
    this.verdict.dataset.kind = 'answer';
    this.verdict.className = 'verdict note';
    this.verdict.textContent = 'Searching …';
  }

  showFault(sentence: string): void {
    this.clear.hidden = false;
    this.verdict.dataset.kind = 'answer';
    this.verdict.className = 'verdict fault';
    this.verdict.textContent = sentence;
  }

  /** Marks an object's line, and brings it into sight. */
  mark(id: number): void {
    for (const button of this.list.querySelectorAll<HTMLElement>('button.row')) {
      const own = button.dataset.id === String(id);
      button.setAttribute('aria-current', String(own));
      if (own) button.scrollIntoView({ block: 'nearest' });
    }
  }

  setQuery(text: string): void {
    this.box.input.value = text;
  }

  /** Back to the list of all objects. */
  reset(): void {
    this.box.input.value = '';
    this.clear.hidden = true;
    this.verdict.textContent = '';
    this.verdict.className = 'verdict note';
    this.hooks.onClear();
  }

  private submit(): void {
    const text = this.box.input.value.trim();
    if (text === '') return this.reset();
    this.recent.unshift(...this.recent.splice(0).filter((entry) => entry !== text));
    this.recent.unshift(text);
    this.recent.splice(MOST_RECENT);
    this.box.close();
    this.hooks.onQuery(
      text,
      this.not.value
        .split(',')
        .map((word) => word.trim())
        .filter(Boolean),
    );
  }

  private fill(rows: HTMLElement[], selected: number): void {
    const kept = this.list.dataset.of === this.listTitle.textContent ? this.list.scrollTop : 0;
    this.list.dataset.of = this.listTitle.textContent ?? '';
    this.list.replaceChildren(...rows);
    this.list.scrollTop = kept;
    this.mark(selected);
  }

  private build(): HTMLElement {
    const form = h(
      'form',
      {
        role: 'search',
        class: 'query',
        onsubmit: (event: Event) => {
          event.preventDefault();
          this.submit();
        },
      },
      icon('search'),
      this.box.element,
      this.clear,
      h('button', { class: 'primary', type: 'submit' }, 'Find'),
    );
    this.not.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') this.submit();
    });
    return h(
      'section',
      { class: 'panel search', 'aria-label': 'Search' },
      h('header', {}, this.heading, this.facts),
      form,
      h(
        'details',
        { class: 'refine' },
        h('summary', {}, 'But not …'),
        h('label', { for: 'not' }, 'Leave out'),
        this.not,
      ),
      this.verdict,
      this.listTitle,
      this.list,
    );
  }
}
