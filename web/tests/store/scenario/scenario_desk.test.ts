import { describe, expect, it } from 'vitest';
import schemaText from '../../../../scenarios/scenario.schema.json?raw';
import courseText from '../../../../scenarios/course.json?raw';
import { RestError } from '../../../src/connection/rest_error';
import type { FieldError } from '../../../src/protocol/field_errors';
import type { JsonObject } from '../../../src/protocol/rest_types';
import { Notices } from '../../../src/store/notices';
import type { ShownScenario } from '../../../src/store/scenario/draft';
import { kChangedMeanwhile } from '../../../src/store/scenario/draft';
import { ScenarioDesk } from '../../../src/store/scenario/scenario_desk';
import { Store } from '../../../src/store/state';

const kEntry = {
  name: 'course',
  title: 'Course',
  description: '',
  error: null,
  flight: 'course',
  saved: false,
};

function desk() {
  const store = new Store();
  store.state.scenarioDocument = JSON.parse(courseText) as JsonObject;
  store.state.scenarioName = 'course';
  store.state.scenarios = [kEntry, { ...kEntry, name: 'mine', saved: true }];
  const waiting: (() => void)[] = [];
  const later = (callback: () => void) => void waiting.push(callback);
  const asked: { document: JsonObject; answer: (errors: FieldError[] | Error) => void }[] = [];
  const saved: [string, JsonObject, boolean][] = [];
  const chosen: string[] = [];
  const readings: (JsonObject | null)[] = [];
  const elsewhere: { found: ShownScenario } = { found: 'same' };
  const rest = {
    scenarioSchema: () => Promise.resolve(JSON.parse(schemaText) as JsonObject),
    checkScenario: (document: JsonObject, signal: AbortSignal) =>
      new Promise<FieldError[]>((resolve, reject) => {
        signal.addEventListener('abort', () => reject(new Error('aborted')));
        asked.push({
          document,
          answer: (result) => {
            if (result instanceof Error) reject(result);
            else resolve(result);
          },
        });
      }),
    saveScenario: (name: string, document: JsonObject, replace: boolean) => {
      if (name === 'taken' && !replace) {
        return Promise.reject(new RestError(409, 'conflict', 'it exists'));
      }
      saved.push([name, document, replace]);
      return Promise.resolve();
    },
    deleteScenario: () => Promise.resolve(),
  };
  const scenarios = {
    readScenarios: () => {
      readings.push(store.state.scenarioDocument);
      return Promise.resolve();
    },
    selectScenario: (name: string) => {
      chosen.push(name);
      return Promise.resolve();
    },
    lookAgain: () => Promise.resolve(elsewhere.found),
  };
  const subject = new ScenarioDesk(store, rest, scenarios, new Notices(store, () => {}), later);
  const pause = async () => {
    for (const callback of waiting.splice(0)) callback();
    for (let i = 0; i < 5; i += 1) await Promise.resolve();
  };
  const { state } = store;
  const settle = () => new Promise((done) => setTimeout(done, 0));
  return { subject, store, state, pause, asked, saved, chosen, readings, elsewhere, settle };
}

describe('changes of the scenario', () => {
  it('are checked here, and only then by the server, when they pause', async () => {
    const { subject, state, pause, asked, settle } = desk();
    subject.setValue('camera.width_px', 5);
    expect(state.scenarioEditor.check).toBe('waiting');
    expect(state.launchErrors).toEqual([]);
    await pause();
    expect(state.launchErrors).toEqual([
      { field: 'camera.width_px', message: 'must be in [16, 8192]' },
    ]);
    expect(asked).toHaveLength(0);
    subject.setValue('camera.width_px', 320);
    await pause();
    expect(asked[0]?.document).toMatchObject({ camera: { width_px: 320, height_px: 960 } });
    asked[0]?.answer([{ field: 'camera.height_px', message: 'is too tall' }]);
    await settle();
    expect(state.scenarioEditor.check).toBe('done');
    expect(state.launchErrors).toEqual([{ field: 'camera.height_px', message: 'is too tall' }]);
  });

  it('ask once for many, and the last answer wins', async () => {
    const { subject, state, pause, asked, settle } = desk();
    subject.setValue('seed', 1.5);
    subject.setValue('seed', 2);
    await pause();
    expect(asked).toHaveLength(1);
    subject.setValue('seed', 3);
    await pause();
    expect(asked).toHaveLength(2);
    asked[0]?.answer([{ field: 'seed', message: 'of the old question' }]);
    asked[1]?.answer([]);
    await settle();
    expect(state.launchErrors).toEqual([]);
    expect(state.scenarioEditor.check).toBe('done');
  });

  it('say if the server does not answer, and go on', async () => {
    const { subject, state, pause, asked, settle } = desk();
    subject.setValue('seed', 2);
    await pause();
    asked[0]?.answer(new RestError(0, 'unreachable', 'the server does not answer'));
    await settle();
    expect(state.scenarioEditor.check).toBe('browser');
    expect(state.launchErrors).toEqual([]);
  });

  it('are forgotten with their errors when a section is reset', async () => {
    const { subject, state, pause } = desk();
    subject.setText('camera', '{"width_px": 5}');
    await pause();
    expect(state.launchErrors).toHaveLength(1);
    subject.reset(['camera']);
    expect(state.scenarioEdits.size).toBe(0);
    expect(state.launchErrors).toEqual([]);
    expect(state.scenarioEditor.check).toBe('none');
  });

  it('are refused of a scenario that was changed meanwhile, until all are taken back', async () => {
    const { subject, state, pause, readings } = desk();
    subject.setValue('seed', 2);
    state.scenarioChanged = true;
    subject.setValue('seed', 3);
    await pause();
    expect(state.launchErrors).toEqual([kChangedMeanwhile]);
    expect(readings).toEqual([]);
    subject.reset(['seed']);
    expect(readings).toHaveLength(1);
  });

  it('add estimators, change their type and remove them', () => {
    const { subject, state } = desk();
    const estimators = () => JSON.parse(state.scenarioEdits.get('estimators') ?? '[]') as unknown;
    subject.add('estimators', {});
    subject.setValue('estimators.1.parameters', { features: 500 });
    expect(estimators()).toEqual([
      { name: 'feature', type: 'feature' },
      { name: 'feature_2', type: 'feature', parameters: { features: 500 } },
    ]);
    subject.setValue('estimators.1.type', 'drifting');
    expect(estimators()).toEqual([
      { name: 'feature', type: 'feature' },
      { name: 'drifting', type: 'drifting' },
    ]);
    subject.setValue('estimators.1', undefined);
    expect(state.scenarioEdits.size).toBe(0);
  });
});

describe('saving a scenario', () => {
  it('saves it under its new name, and chooses it', async () => {
    const { subject, saved, chosen, state } = desk();
    subject.setValue('title', 'A small camera');
    await subject.save('small', false);
    expect(saved.map(([name, document, replace]) => [name, document['title'], replace])).toEqual([
      ['small', 'A small camera', false],
    ]);
    expect(saved[0]?.[1]['name']).toBe('small');
    expect(chosen).toEqual(['small']);
    expect(state.scenarioEdits.size).toBe(0);
    expect(state.notices.map(({ text }) => text)).toEqual(['The scenario is saved as small.']);
  });

  it('keeps what is typed while it is saved', async () => {
    const { subject, saved, chosen, state } = desk();
    subject.setValue('title', 'First');
    const saving = subject.save('small', false);
    subject.setValue('title', 'Second');
    await saving;
    expect(saved[0]?.[1]['title']).toBe('First');
    expect(chosen).toEqual([]);
    expect(state.scenarioEdits.get('title')).toBe('"Second"');
    expect(state.notices.at(-1)?.text).toMatch(/without the changes that were made meanwhile/u);
  });

  it('goes on with what it has saved under the same name', async () => {
    const { subject, saved, state, readings } = desk();
    state.scenarioName = 'mine';
    subject.setValue('title', 'First');
    const saving = subject.save('mine', true);
    subject.setValue('title', 'Second');
    await saving;
    expect(readings).toEqual([saved[0]?.[1]]);
    expect(state.scenarioDocument?.['title']).toBe('First');
  });

  it('asks the server whether somebody else has saved it before it is replaced', async () => {
    const { subject, state, saved, elsewhere } = desk();
    state.scenarioName = 'mine';
    elsewhere.found = 'changed';
    await subject.save('mine', true);
    expect(saved).toEqual([]);
    expect(state.scenarioEditor.saving).toBe(false);
    expect(state.scenarioEditor.saveError).toMatch(/changed on the server/);
    elsewhere.found = 'same';
    await subject.save('mine', true);
    expect(saved.map(([name]) => name)).toEqual(['mine']);
  });

  it('does not replace it once another one is chosen, and says no word of a change', async () => {
    const { subject, state, saved, elsewhere } = desk();
    state.scenarioName = 'mine';
    elsewhere.found = 'left';
    await subject.save('mine', true);
    expect(saved).toEqual([]);
    expect(state.scenarioEditor).toMatchObject({ saving: false, saveError: '' });
    expect(state.notices.map(({ text }) => text)).toEqual([
      'mine was not saved: another choice was made in Launch meanwhile.',
    ]);
  });

  it('does not replace one that was changed meanwhile', async () => {
    const { subject, saved, state } = desk();
    Object.assign(state, { scenarioName: 'mine', scenarioChanged: true });
    await subject.save('mine', true);
    expect(state.scenarioEditor.saveError).toBe(kChangedMeanwhile.message);
    await subject.save('small', false);
    expect(saved.map(([name]) => name)).toEqual(['small']);
  });

  it('shows nothing of a scenario that was deleted', async () => {
    const { subject, state } = desk();
    subject.setValue('title', 'First');
    await subject.remove('mine');
    expect(state.scenarioName).toBeNull();
    expect(state.scenarioDocument).toBeNull();
    expect(state.scenarioEdits.size).toBe(0);
  });

  it('asks before it replaces a saved one, also one that it did not know of', async () => {
    const { subject, saved, state } = desk();
    await subject.save('mine', false);
    expect(state.scenarioEditor.replaces).toBe('mine');
    expect(saved).toEqual([]);
    await subject.save('mine', true);
    expect(saved.map(([name, , replace]) => [name, replace])).toEqual([['mine', true]]);
    await subject.save('taken', false);
    expect(state.scenarioEditor.replaces).toBe('taken');
    subject.clearSave();
    expect(state.scenarioEditor.replaces).toBeNull();
  });

  it('refuses names that are none, or the server’s, and scenarios with errors', async () => {
    const { subject, saved, state } = desk();
    await subject.save('two words', false);
    expect(state.scenarioEditor.saveError).toMatch(/letters, digits/u);
    await subject.save('course', false);
    expect(state.scenarioEditor.saveError).toMatch(/scenario of the server/u);
    await subject.openEditor();
    subject.setText('camera', '{');
    await subject.save('small', false);
    expect(state.scenarioEditor.saveError).toBe('The scenario has errors.');
    expect(saved).toEqual([]);
  });
});
