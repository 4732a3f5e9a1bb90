// Changes the launcher's scenario: by its fields or as JSON, checked here and by the server when
// the changes pause; saves it as a scenario of its own.
import type { RestClient } from '../../connection/rest_client';
import { errorText, fieldErrorsOf, RestError } from '../../connection/rest_error';
import type { FieldError } from '../../protocol/field_errors';
import type { Json, JsonObject } from '../../protocol/rest_types';
import type { FieldSpec } from '../launch_form';
import { withFieldText } from '../launch_form';
import type { Notices } from '../notices';
import type { Store } from '../state';
import {
  draftOf,
  editsWith,
  editsWithText,
  kChangedMeanwhile,
  kChosenMeanwhile,
  valueIn,
  withValue,
} from './draft';
import type { Edits, ShownScenario } from './draft';
import { newEstimator, withEstimatorTypes, withType } from './estimator_schema';
import type { ScenarioEditorState } from './scenario_editor';
import { documentErrors } from './schema_check';
import { isObject } from './schema_node';

const kPause_ms = 350;
const kName = /^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$/;
const kConflict = 409;

type Rest = Pick<
  RestClient,
  'scenarioSchema' | 'checkScenario' | 'saveScenario' | 'deleteScenario'
>;

/** Lists the server's scenarios, and chooses one of them. */
interface Scenarios {
  readScenarios(): Promise<void>;
  selectScenario(name: string): Promise<void>;
  /** Looks whether the server still has the scenario that is shown. */
  lookAgain(): Promise<ShownScenario>;
}

export class ScenarioDesk {
  private asking = new AbortController();

  constructor(
    private readonly store: Store,
    private readonly rest: Rest,
    private readonly scenarios: Scenarios,
    private readonly notices: Notices,
    private readonly later: (callback: () => void, delay_ms: number) => void,
  ) {}

  // ---- the editor ------------------------------------------------------------------------------

  async openEditor(): Promise<void> {
    try {
      await this.readSchema();
      Object.assign(this.editor, { saveError: '', replaces: null });
      this.store.state.openPage(this.editor);
    } catch (error) {
      this.notices.error(errorText(error));
    }
    this.changed();
  }

  close(): void {
    this.editor.open = false;
    this.changed();
  }

  show(change: Partial<Pick<ScenarioEditorState, 'section' | 'asJson'>>): void {
    Object.assign(this.editor, change);
    this.changed();
  }

  // ---- changes ---------------------------------------------------------------------------------

  /** The text of one of the launcher's fields. */
  setField(field: FieldSpec, text: string): void {
    this.change(field.path, (document, base) => withFieldText(document, base, field, text));
  }

  /** undefined removes the value. */
  setValue(path: string, value: Json | undefined): void {
    this.change(path, (document) => {
      const kind = /^estimators\.(\d+)\.type$/.exec(path);
      if (kind !== null && typeof value === 'string') {
        return withEstimators(document, (list) =>
          list.map((entry, i) =>
            i === Number(kind[1]) && isObject(entry)
              ? withType(
                  entry,
                  value,
                  list.filter((other) => other !== entry),
                )
              : entry,
          ),
        );
      }
      return withValue(document, path, value);
    });
  }

  /** Adds an entry to a list. */
  add(path: string, fresh: Json): void {
    this.change(path, (document) => {
      if (path === 'estimators') {
        return withEstimators(document, (list) => [...list, newEstimator(list, 'feature')]);
      }
      const list = valueIn(document, path);
      return withValue(document, path, [...(Array.isArray(list) ? list : []), fresh]);
    });
  }

  /** A section as JSON; an empty text removes it. */
  setText(section: string, text: string): void {
    const { state } = this.store;
    if (state.scenarioDocument === null) return;
    this.take(editsWithText(state.scenarioDocument, state.scenarioEdits, section, text));
  }

  /** Takes the changes of some sections back. */
  reset(sections: readonly string[]): void {
    const edits = new Map(this.store.state.scenarioEdits);
    for (const section of sections) edits.delete(section);
    this.take(edits);
  }

  private change(
    path: string,
    apply: (document: JsonObject, base: JsonObject) => JsonObject,
  ): void {
    const { scenarioDocument: base, scenarioEdits } = this.store.state;
    if (base === null) return;
    const changed = apply(draftOf(base, scenarioEdits).document, base);
    this.take(editsWith(base, scenarioEdits, changed, path));
  }

  private take(edits: Map<string, string>): void {
    const { state } = this.store;
    state.scenarioEdits = edits;
    this.editor.check = edits.size === 0 ? 'none' : 'waiting';
    if (edits.size === 0) state.launchErrors = [];
    this.asking.abort();
    this.changed();
    if (edits.size > 0) this.later(() => void this.check(edits), kPause_ms);
    else if (state.scenarioChanged) void this.scenarios.readScenarios();
  }

  // ---- checks ----------------------------------------------------------------------------------

  /** Here first; the server is asked for the rest. Only the last changes count. */
  private async check(edits: Edits): Promise<void> {
    const { state } = this.store;
    const asking = new AbortController();
    this.asking.abort();
    this.asking = asking;
    const current = () => state.scenarioEdits === edits && !asking.signal.aborted;
    if (!current() || state.scenarioDocument === null) return;
    const { document, errors } = draftOf(state.scenarioDocument, edits);
    if (state.scenarioChanged) errors.push(kChangedMeanwhile);
    const schema = await this.readSchema().catch(() => null);
    if (!current()) return;
    if (schema !== null) errors.push(...documentErrors(schema, document));
    if (errors.length > 0) {
      this.answer('done', errors);
      return;
    }
    try {
      const found = await this.rest.checkScenario(document, asking.signal);
      if (current()) this.answer('done', found);
    } catch (error) {
      if (current()) this.answer('browser', isRefusal(error) ? fieldErrorsOf(error) : []);
    }
  }

  private answer(check: ScenarioEditorState['check'], errors: FieldError[]): void {
    this.editor.check = check;
    this.store.state.launchErrors = errors;
    this.changed();
  }

  /** The schema, with the parameters of the native estimators. */
  private async readSchema(): Promise<JsonObject> {
    const { state } = this.store;
    state.scenarioSchema ??= withEstimatorTypes(await this.rest.scenarioSchema());
    return state.scenarioSchema;
  }

  // ---- saving ----------------------------------------------------------------------------------

  /** Saves the changed scenario. @param replace  a saved one of this name, which was asked for */
  async save(name: string, replace: boolean): Promise<void> {
    const { state } = this.store;
    const { editor } = this;
    if (state.scenarioDocument === null || editor.saving) return;
    const { document, errors } = draftOf(state.scenarioDocument, state.scenarioEdits);
    errors.push(...documentErrors(state.scenarioSchema ?? {}, document));
    const entry = state.scenarios?.find((scenario) => scenario.name === name);
    if (!kName.test(name)) {
      this.refuse(
        'A name has 1 to 64 letters, digits, "_" and "-", and begins with a letter or digit.',
      );
    } else if (entry?.saved === false) {
      this.refuse(`${name} is a scenario of the server: choose another name.`);
    } else if (errors.length > 0) {
      state.launchErrors = errors;
      this.refuse('The scenario has errors.');
    } else if (state.scenarioChanged && name === state.scenarioName) {
      this.refuse(kChangedMeanwhile.message);
    } else if (entry !== undefined && !replace) {
      this.ask(name);
    } else {
      await this.send(name, { ...document, name }, replace);
    }
  }

  private async send(name: string, document: JsonObject, replace: boolean): Promise<void> {
    const { editor } = this;
    const edits = () => JSON.stringify([...this.store.state.scenarioEdits]);
    const sent = edits();
    Object.assign(editor, { saving: true, saveError: '', replaces: null });
    this.changed();
    try {
      const isOwn = name === this.store.state.scenarioName && this.store.state.repeatedRun === null;
      const found = replace && isOwn ? await this.scenarios.lookAgain() : 'same';
      if (found !== 'same') {
        if (found === 'changed') this.refuse(kChangedMeanwhile.message);
        else this.notices.error(`${name} was not saved: ${kChosenMeanwhile}`);
        editor.saving = false;
        this.changed();
        return;
      }
      await this.rest.saveScenario(name, document, replace);
      const { state } = this.store;
      // It is no change by somebody else.
      if (state.scenarioName === name && state.repeatedRun === null) {
        state.scenarioDocument = document;
      }
      await this.scenarios.readScenarios();
      // What was typed meanwhile is not in it, and stays.
      const whole = edits() === sent;
      if (whole) {
        this.store.state.scenarioEdits = new Map();
        await this.scenarios.selectScenario(name);
      }
      const rest = whole ? '' : ' without the changes that were made meanwhile';
      this.notices.info(`The scenario is saved as ${name}${rest}.`);
    } catch (error) {
      if (error instanceof RestError && error.status === kConflict) this.ask(name);
      else {
        this.store.state.launchErrors = fieldErrorsOf(error).filter(({ field }) => field !== '');
        this.refuse(errorText(error));
      }
    }
    editor.saving = false;
    this.changed();
  }

  /** Forgets the question and what was wrong: the name is being changed. */
  clearSave(): void {
    if (this.editor.saveError === '' && this.editor.replaces === null) return;
    this.refuse('');
  }

  /** Deletes a saved scenario; the launcher shows the first one of the list. */
  async remove(name: string): Promise<void> {
    try {
      await this.rest.deleteScenario(name);
      const { state } = this.store;
      Object.assign(state, { scenarioName: null, scenarioDocument: null });
      this.take(new Map());
      await this.scenarios.readScenarios();
      this.notices.info(`The scenario ${name} is deleted.`);
    } catch (error) {
      this.refuse(errorText(error));
    }
  }

  private ask(name: string): void {
    Object.assign(this.editor, { replaces: name, saveError: '' });
    this.changed();
  }

  private refuse(saveError: string): void {
    Object.assign(this.editor, { saveError, replaces: null });
    this.changed();
  }

  private get editor(): ScenarioEditorState {
    return this.store.state.scenarioEditor;
  }

  private changed(): void {
    this.store.change('launch');
  }
}

function withEstimators(document: JsonObject, apply: (list: readonly Json[]) => Json[]) {
  const { estimators } = document;
  return { ...document, estimators: apply(Array.isArray(estimators) ? estimators : []) };
}

/** The server read the request and says what is wrong, as opposed to being busy or away. */
function isRefusal(error: unknown): boolean {
  return error instanceof RestError && error.status >= 400 && error.status < 429;
}
