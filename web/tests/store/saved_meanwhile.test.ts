// Scenarios that others save or delete while the launcher shows them.
import { describe, expect, it } from 'vitest';

import { kChangedMeanwhile } from '../../src/store/scenario/draft';
import { catalogue, document, kScenario, reading } from '../support/catalogue_bench';
import { sampleRun } from '../support/samples';

describe('Catalogue', () => {
  it('takes the scenario that was saved meanwhile, unless a run is flown again', async () => {
    let saved = document;
    const { store, subject } = catalogue({
      ...reading,
      'GET /scenarios/course': () => [200, saved],
      'GET /runs/r1/scenario': () => [200, document],
    });
    await subject.readScenarios();
    saved = { ...document, seed: 2 };
    store.take();
    await subject.readScenarios();
    expect(store.state.scenarioDocument).toEqual(saved);
    expect(store.take().has('launch')).toBe(true);
    await subject.repeat(sampleRun());
    await subject.readScenarios();
    expect(store.state.scenarioDocument).toEqual(document);
  });

  it('does not fly changes of a scenario that was saved meanwhile', async () => {
    let saved = document;
    const { store, subject } = catalogue({
      ...reading,
      'GET /scenarios/course': () => [200, saved],
    });
    await subject.readScenarios();
    saved = { ...document, seed: 2 };
    store.state.scenarioEdits = new Map([['pacing', '"real_time"']]);
    await subject.readScenarios();
    await subject.readScenarios();
    expect(store.state.launchErrors).toEqual([kChangedMeanwhile]);
    expect(store.state.scenarioDocument).toEqual(document);
    expect(await subject.launch()).toBe(false);
    expect(subject.asked()).toBeNull();
    expect(store.state.launchErrors).toEqual([kChangedMeanwhile]);
    store.state.scenarioEdits = new Map();
    await subject.readScenarios();
    expect(store.state.launchErrors).toEqual([]);
    expect(store.state.scenarioDocument).toEqual(saved);
    expect(subject.asked()).not.toBeNull();
  });

  it('looks before a flight whether the scenario is still the one that is shown', async () => {
    let saved = document;
    let flights = 0;
    const { store, subject } = catalogue({
      ...reading,
      'GET /scenarios/course': () => [200, saved],
      'POST /runs': () => {
        flights += 1;
        return [202, sampleRun()];
      },
    });
    await subject.readScenarios();
    saved = { ...document, seed: 2 };
    expect(await subject.launch()).toBe(false);
    expect(store.state.scenarioDocument).toEqual(saved);
    expect(store.state.notices.map(({ text }) => text)).toEqual([
      'The scenario was changed on the server: Launch shows the new one.',
    ]);
    store.state.scenarioEdits = new Map([['pacing', '"real_time"']]);
    saved = { ...document, seed: 3 };
    expect(await subject.launch()).toBe(false);
    expect(store.state.launchErrors).toEqual([kChangedMeanwhile]);
    expect(store.state.launching).toBe(false);
    expect(flights).toBe(0);
    store.state.scenarioEdits = new Map();
    await subject.readScenarios();
    expect(await subject.launch()).toBe(true);
    expect(flights).toBe(1);
  });

  it('leaves a scenario that was deleted', async () => {
    let names = ['mine', 'course'];
    const { store, subject } = catalogue({
      ...reading,
      'GET /scenarios': () => [200, { scenarios: names.map((name) => ({ ...kScenario, name })) }],
      'GET /scenarios/mine': () => [200, { ...document, seed: 3 }],
    });
    await subject.readScenarios();
    await subject.selectScenario('mine');
    names = ['course'];
    await subject.readScenarios();
    expect(store.state.scenarioName).toBe('course');
    expect(store.state.scenarioDocument).toEqual(document);
    expect(store.state.notices.map(({ text }) => text)).toEqual([
      'The scenario mine is no longer on the server.',
    ]);
    names = [];
    await subject.readScenarios();
    expect(store.state.scenarioName).toBeNull();
    expect(store.state.scenarioDocument).toBeNull();
  });
});
