// Edits in the launcher while another scenario, or a run to be flown again, is shown.
import { describe, expect, it } from 'vitest';

import { catalogue, document, kScenario, reading } from '../support/catalogue_bench';
import { sampleRun } from '../support/samples';

async function bench() {
  const files = { course: document, tour: { ...document, seed: 5 } };
  const made = catalogue({
    ...reading,
    'GET /scenarios': () => [200, { scenarios: [kScenario, { ...kScenario, name: 'tour' }] }],
    'GET /scenarios/course': () => [200, files.course],
    'GET /scenarios/tour': () => [200, files.tour],
    'GET /runs/r1/scenario': () => [200, document],
  });
  await made.subject.readScenarios();
  return { ...made, files, state: made.store.state };
}

describe('Catalogue', () => {
  it('keeps the edits of each scenario while another one is shown', async () => {
    const { state, subject } = await bench();
    state.scenarioEdits = new Map([['seed', '2']]);
    await subject.selectScenario('tour');
    expect(state.scenarioEdits.size).toBe(0);
    state.scenarioEdits = new Map([['seed', '6']]);
    await subject.selectScenario('course');
    expect([...state.scenarioEdits]).toEqual([['seed', '2']]);
    // Taken back, they do not return.
    state.scenarioEdits = new Map();
    await subject.selectScenario('tour');
    expect([...state.scenarioEdits]).toEqual([['seed', '6']]);
    await subject.selectScenario('course');
    expect(state.scenarioEdits.size).toBe(0);
  });

  it('keeps them while a run is flown again, whose edits are its own', async () => {
    const { state, subject } = await bench();
    state.scenarioEdits = new Map([['seed', '2']]);
    await subject.repeat(sampleRun());
    expect(state.scenarioEdits.size).toBe(0);
    state.scenarioEdits = new Map([['seed', '3']]);
    await subject.selectScenario('course');
    expect([...state.scenarioEdits]).toEqual([['seed', '2']]);
    await subject.repeat(sampleRun());
    expect([...state.scenarioEdits]).toEqual([['seed', '3']]);
  });

  it('says that they are lost if the scenario is another meanwhile', async () => {
    const { state, subject, files } = await bench();
    state.scenarioEdits = new Map([['seed', '2']]);
    await subject.selectScenario('tour');
    files.course = { ...document, seed: 9 };
    await subject.selectScenario('course');
    expect(state.scenarioEdits.size).toBe(0);
    expect(state.notices.map(({ text }) => text)).toEqual([
      'The scenario was changed on the server: your changes of it are not kept.',
    ]);
  });
});
