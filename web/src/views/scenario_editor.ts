// Edits the scenario's sections (camera, faults, light, ...) as JSON, with checks while typing.
import type { JsonObject } from '../protocol/rest_types';
import {
  fieldNotes,
  sectionDescription,
  sectionErrors,
  sectionsOf,
  sectionText,
} from '../store/scenario_schema';
import type { State, Topic } from '../store/state';
import { h, rebuild, setAttribute, setText } from './dom';
import type { Context, View } from './view';

export class ScenarioEditor implements View {
  readonly root: HTMLElement;
  private readonly tabs = h('div', { class: 'editor-tabs', role: 'tablist' });
  private readonly description = h('p', { class: 'editor-description' });
  private readonly text = h('textarea', {
    id: 'section-text',
    spellcheck: 'false',
    'aria-label': 'Section as JSON',
  });
  private readonly errors = h('div', { class: 'editor-errors', role: 'alert' });
  private readonly notes = h('dl', { class: 'editor-notes' });
  private section = 'camera';
  private shown = '';

  constructor(private readonly context: Context) {
    this.text.addEventListener('input', () => this.edit(this.text.value));
    // A click outside the dialog closes it and keeps the text.
    this.root = h(
      'div',
      {
        class: 'overlay',
        hidden: true,
        onclick: (event: MouseEvent) => {
          if (event.target === this.root) this.close();
        },
        onkeydown: (event: KeyboardEvent) => {
          if (event.key === 'Escape') this.close();
        },
      },
      h(
        'div',
        { class: 'editor', role: 'dialog', 'aria-label': 'Scenario as JSON' },
        h('h2', {}, 'Scenario sections as JSON'),
        this.tabs,
        this.description,
        h('div', { class: 'editor-columns' }, this.text, this.notes),
        this.errors,
        h(
          'div',
          { class: 'editor-buttons' },
          h('button', { class: 'secondary', onclick: () => this.reset() }, 'As in the scenario'),
          h('button', { class: 'primary', onclick: () => this.close() }, 'Done'),
        ),
      ),
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('help') && !changed.has('launch')) return;
    const { state } = this.context.store;
    const { scenarioSchema, scenarioDocument } = state;
    if (scenarioDocument === null) state.editorOpen = false;
    this.root.hidden = !state.editorOpen;
    if (!state.editorOpen || scenarioSchema === null || scenarioDocument === null) {
      this.shown = '';
      return;
    }
    this.drawTabs(state, scenarioSchema);
    this.drawSection(state, scenarioSchema, scenarioDocument);
    this.drawErrors(state, scenarioSchema);
  }

  private drawTabs({ scenarioEdits }: State, schema: JsonObject): void {
    const sections = sectionsOf(schema);
    if (!sections.includes(this.section)) this.section = sections[0] ?? '';
    const edited = [...scenarioEdits.keys()].filter((name) => sections.includes(name));
    rebuild(this.tabs, JSON.stringify([sections, edited, this.section]), () =>
      sections.map((name) =>
        h(
          'button',
          {
            class: edited.includes(name) ? 'tab edited' : 'tab',
            role: 'tab',
            'data-section': name,
            'aria-pressed': name === this.section ? 'true' : 'false',
            onclick: () => {
              this.section = name;
              this.context.store.change('launch');
            },
          },
          name,
        ),
      ),
    );
  }

  private drawSection(state: State, schema: JsonObject, document: JsonObject): void {
    const key = `${String(state.scenarioName)}/${state.repeatedRun?.id ?? ''}/${this.section}`;
    if (this.shown === key) return;
    this.shown = key;
    this.text.value = state.scenarioEdits.get(this.section) ?? sectionText(document, this.section);
    setAttribute(this.text, 'placeholder', `${this.section}: not in this scenario`);
    setText(this.description, sectionDescription(schema, this.section));
    this.notes.replaceChildren(
      ...fieldNotes(schema, this.section).flatMap(({ name, what, description }) => [
        h('dt', {}, h('code', {}, name), ' ', h('span', { class: 'unit' }, what)),
        h('dd', {}, description),
      ]),
    );
  }

  private drawErrors({ scenarioEdits }: State, schema: JsonObject): void {
    const errors = sectionErrors(schema, this.section, scenarioEdits.get(this.section) ?? '');
    setText(this.errors, errors.map(({ field, message }) => `${field}: ${message}`).join('\n'));
    this.text.classList.toggle('invalid', errors.length > 0);
  }

  private edit(text: string): void {
    const { state } = this.context.store;
    const own = sectionText(state.scenarioDocument ?? {}, this.section);
    if (text === own) state.scenarioEdits.delete(this.section);
    else state.scenarioEdits.set(this.section, text);
    this.context.store.change('launch');
  }

  private reset(): void {
    this.context.store.state.scenarioEdits.delete(this.section);
    this.shown = '';
    this.context.store.change('launch');
  }

  private close(): void {
    this.context.store.state.editorOpen = false;
    this.context.store.change('help', 'launch');
  }
}
