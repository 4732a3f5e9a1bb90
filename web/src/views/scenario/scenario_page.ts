// Edits the launcher's scenario: a form for each section, or its JSON; saves and flies it.
import type { FieldError } from '../../protocol/field_errors';
import type { JsonObject } from '../../protocol/rest_types';
import { draftOf, sectionText } from '../../store/scenario/draft';
import { formOf } from '../../store/scenario/form_nodes';
import {
  generalFields,
  kGeneral,
  sectionLabel,
  sectionOfField,
  sectionsOf,
} from '../../store/scenario/sections';
import type { State, Topic } from '../../store/state';
import { viewerNote } from '../access';
import { closeTopmost } from '../commands/shortcuts';
import { h, rebuild, setText } from '../dom';
import type { Context, View } from '../view';
import { SaveBar } from './save_bar';
import { ScenarioForm } from './scenario_form';

const kChecks = {
  none: 'No changes.',
  waiting: 'Checking …',
  done: 'The server has checked the changes: no errors.',
  browser: 'The server does not answer: checked in the browser only.',
};

export class ScenarioPageView implements View {
  readonly root: HTMLElement;
  private readonly title = h('span', { class: 'editor-scenario' });
  private readonly tabs = h('div', {
    class: 'editor-tabs',
    role: 'tablist',
    'aria-label': 'Sections',
  });
  private readonly form: ScenarioForm;
  private readonly text = h('textarea', {
    id: 'section-text',
    spellcheck: 'false',
    'aria-label': 'Section as JSON',
  });
  private readonly errors = h('div', { class: 'editor-errors', role: 'status' });
  private readonly asForm = this.button('Form', 'as-form', () => this.desk.show({ asJson: false }));
  private readonly asJson = this.button('JSON', 'as-json', () => this.desk.show({ asJson: true }));
  private readonly undo = this.button('As in the scenario', 'reset-section', () => this.reset());
  private readonly done = this.button('Done', 'close-editor', () => this.desk.close());
  private readonly launch = h(
    'button',
    { class: 'primary', type: 'button', 'data-role': 'launch-edited', 'data-changes': true },
    'Launch flight',
  );
  private readonly saveBar: SaveBar;
  private textOf = '';
  private opened = false;

  constructor(private readonly context: Context) {
    this.form = new ScenarioForm({
      set: (path, value) => this.desk.setValue(path, value),
      add: (path, fresh) => this.desk.add(path, fresh),
    });
    this.saveBar = new SaveBar(context);
    this.text.addEventListener('input', () => this.desk.setText(this.section, this.text.value));
    this.launch.addEventListener('click', () => {
      void context.catalogue.launch().then((started) => {
        if (started) this.desk.close();
      });
    });
    this.root = h(
      'div',
      {
        class: 'editor',
        role: 'dialog',
        'aria-label': 'Edit the scenario',
        onkeydown: (event: KeyboardEvent) => {
          if (event.key !== 'Escape') return;
          event.stopPropagation();
          closeTopmost(context);
        },
      },
      h(
        'header',
        { class: 'editor-head' },
        h('h2', {}, 'Edit the scenario'),
        this.title,
        h(
          'button',
          {
            class: 'icon-button',
            'aria-label': 'Close',
            title: 'Close and keep the changes (Esc)',
            onclick: () => this.desk.close(),
          },
          '×',
        ),
      ),
      h(
        'div',
        { class: 'editor-tools' },
        this.tabs,
        h(
          'span',
          { class: 'editor-modes', role: 'group', 'aria-label': 'Edit as' },
          this.asForm,
          this.asJson,
        ),
      ),
      h('div', { class: 'editor-body' }, this.form.root, this.text),
      this.errors,
      this.foot(),
    );
  }

  private foot(): HTMLElement {
    return h(
      'footer',
      { class: 'editor-foot' },
      this.saveBar.root,
      viewerNote("Changes are checked here; saving and flying them need the operator's address."),
      this.undo,
      this.done,
      this.launch,
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('launch') && !changed.has('lists') && !changed.has('connection')) return;
    const { state } = this.context.store;
    const { scenarioSchema, scenarioDocument } = state;
    if (!state.scenarioEditor.open || scenarioSchema === null || scenarioDocument === null) {
      this.opened = false;
      return;
    }
    this.drawHead(state);
    this.drawTabs(state, scenarioSchema);
    if (!this.opened) this.focusTab();
    this.opened = true;
    this.drawSection(state, scenarioSchema, scenarioDocument);
    this.drawErrors(state, scenarioSchema);
    this.saveBar.show(state);
    const { launching, connection } = state;
    this.launch.disabled = launching || connection.status !== 'open';
    setText(this.launch, launching ? 'Launching' : 'Launch flight');
  }

  private drawHead({ repeatedRun, scenarioName, scenarios }: State): void {
    const entry = scenarios?.find(({ name }) => name === scenarioName);
    const title = repeatedRun === null ? (entry?.title ?? '') : `Again: ${repeatedRun.title}`;
    setText(this.title, title);
  }

  private drawTabs(state: State, schema: JsonObject): void {
    const { scenarioEdits, launchErrors, scenarioEditor } = state;
    const sections = sectionsOf(schema).map((name) => ({
      name,
      edited: this.namesOf(name, schema).some((part) => scenarioEdits.has(part)),
      faulty: launchErrors.some(
        ({ field }) => field !== '' && sectionOfField(schema, field) === name,
      ),
      shown: name === scenarioEditor.section,
    }));
    const focused = this.tabs.contains(document.activeElement);
    rebuild(this.tabs, JSON.stringify(sections), () =>
      sections.map(({ name, edited, faulty, shown }) =>
        h(
          'button',
          {
            class: ['tab', edited ? 'edited' : '', faulty ? 'faulty' : ''].join(' ').trim(),
            role: 'tab',
            'data-section': name,
            'aria-selected': String(shown),
            title: [edited ? 'Changed' : '', faulty ? 'Has errors' : ''].filter(Boolean).join(', '),
            onclick: () => this.desk.show({ section: name }),
          },
          sectionLabel(name),
        ),
      ),
    );
    if (focused) this.focusTab();
  }

  private focusTab(): void {
    this.tabs.querySelector<HTMLElement>('[aria-selected=true]')?.focus();
  }

  private drawSection(state: State, schema: JsonObject, base: JsonObject): void {
    const { scenarioEdits, scenarioEditor, launchErrors } = state;
    const { section } = scenarioEditor;
    const general = section === kGeneral;
    const asJson = scenarioEditor.asJson && !general;
    this.asJson.disabled = general;
    this.asForm.setAttribute('aria-pressed', String(!asJson));
    this.asJson.setAttribute('aria-pressed', String(asJson));
    this.undo.disabled = !this.namesOf(section, schema).some((name) => scenarioEdits.has(name));
    this.form.root.hidden = asJson;
    this.text.hidden = !asJson;
    if (!asJson) {
      this.form.show(formOf(schema, section, draftOf(base, scenarioEdits).document), launchErrors);
      return;
    }
    const text = scenarioEdits.get(section) ?? sectionText(base, section);
    const other = this.textOf !== section;
    if (other || (document.activeElement !== this.text && this.text.value !== text)) {
      this.text.value = text;
    }
    this.textOf = section;
    this.text.setAttribute('placeholder', `${sectionLabel(section)}: not in this scenario`);
    const faulty = launchErrors.some(({ field }) => sectionOfField(schema, field) === section);
    this.text.setAttribute('aria-invalid', String(faulty));
  }

  private drawErrors({ launchErrors, scenarioEditor }: State, schema: JsonObject): void {
    const { check } = scenarioEditor;
    rebuild(this.errors, JSON.stringify([launchErrors, check]), () =>
      launchErrors.length === 0
        ? [h('span', { class: `check ${check}`, 'data-check': check }, kChecks[check])]
        : launchErrors.map((error) => this.errorLine(error, schema)),
    );
  }

  /** Leads to the section in which the error is. */
  private errorLine({ field, message }: FieldError, schema: JsonObject): HTMLElement {
    if (field === '') return h('div', {}, message);
    const show = () => this.desk.show({ section: sectionOfField(schema, field) });
    return h(
      'button',
      { class: 'editor-error', type: 'button', onclick: show },
      `${field}: ${message}`,
    );
  }

  private reset(): void {
    const { scenarioSchema } = this.context.store.state;
    this.textOf = '';
    if (scenarioSchema !== null) this.desk.reset(this.namesOf(this.section, scenarioSchema));
  }

  /** Names in the document of what a section shows. */
  private namesOf(section: string, schema: JsonObject): string[] {
    return section === kGeneral ? generalFields(schema) : [section];
  }

  private button(text: string, role: string, run: () => void): HTMLButtonElement {
    return h(
      'button',
      { class: 'secondary', type: 'button', 'data-role': role, onclick: run },
      text,
    );
  }

  private get section(): string {
    return this.context.store.state.scenarioEditor.section;
  }

  private get desk(): Context['scenarios'] {
    return this.context.scenarios;
  }
}
