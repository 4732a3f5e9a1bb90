import { expect, it } from 'vitest';

import type { Context } from '../../../src/views/view';
import { prepareStudy } from '../../../src/views/studies/prepare_study';
import { catalogue, reading } from '../../support/catalogue_bench';

it('prepares no study of a scenario with errors, and shows them', async () => {
  const { store, subject } = catalogue(reading);
  await subject.readScenarios();
  const done: unknown[] = [];
  const context = {
    catalogue: subject,
    store,
    layouts: { show: (panel: string) => done.push(panel) },
    notices: { error: (text: string) => done.push(text) },
    studies: {
      prepare: (kind: string, source: unknown) => done.push([kind, source]),
      close: () => done.push('closed'),
    },
  } as unknown as Context;
  store.state.scenarioEdits = new Map([['pacing', '{']]);
  prepareStudy(context, 'predict');
  expect(done).toEqual(['closed', 'launcher', expect.stringMatching(/Launch shows why/)]);
  expect(store.state.launchErrors.map(({ field }) => field)).toEqual(['pacing']);
  store.state.scenarioEdits = new Map([['seed', '2']]);
  prepareStudy(context, 'hunt');
  expect(done[3]).toMatchObject(['hunt', { scenario: 'course', overrides: { seed: 2 } }]);
  store.state.scenarioDocument = null;
  prepareStudy(context, 'hunt');
  expect(done[6]).toMatch(/choose one in Launch/);
});
