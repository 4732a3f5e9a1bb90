// Answers about an earlier choice of the launcher must not replace a later one.
import { beforeEach, describe, expect, it } from 'vitest';
import { RestClient } from '../../src/connection/rest_client';
import { Catalogue } from '../../src/store/catalogue';
import { Notices } from '../../src/store/notices';
import { Store } from '../../src/store/state';
import { sampleRun } from '../support/samples';
import { unwatchedSession } from '../support/viewing';

let store: Store;
let catalogue: Catalogue;
/** Answers that the test gives, by path. */
let answer: Map<string, (response: Response) => void>;

beforeEach(() => {
  store = new Store();
  answer = new Map();
  const notices = new Notices(store, () => undefined);
  const rest = new RestClient('', (url) => new Promise((resolve) => answer.set(url, resolve)));
  const session = unwatchedSession(store, notices);
  catalogue = new Catalogue(
    store,
    rest,
    session,
    notices,
    () => undefined,
    () => 'key',
  );
});

const settle = () => new Promise((resolve) => setTimeout(resolve, 0));

async function give(url: string, body: object | null): Promise<void> {
  const failure = { error: { code: 'not_found', message: `no ${url}` } };
  answer.get(url)?.(body === null ? Response.json(failure, { status: 404 }) : Response.json(body));
  await settle();
}

const kFlown = { seed: 7 };
const kCourse = { seed: 1 };
const kRun = sampleRun({ id: 'r1', scenario: 'course' });

describe('Catalogue with a slow server', () => {
  it('keeps a scenario, and its edits, that was chosen after a run to be flown again', async () => {
    void catalogue.repeat(kRun);
    void catalogue.selectScenario('course');
    await give('/scenarios/course', kCourse);
    store.state.scenarioEdits = new Map([['seed', '5']]);
    await give('/runs/r1/scenario', kFlown);
    expect(store.state.scenarioDocument).toEqual(kCourse);
    expect(store.state.repeatedRun).toBeNull();
    expect(store.state.scenarioEdits.get('seed')).toBe('5');
  });

  it('says nothing about a run that is not wanted any more', async () => {
    void catalogue.repeat(kRun);
    void catalogue.selectScenario('course');
    await give('/runs/r1/scenario', null);
    expect(store.state.notices).toEqual([]);
  });

  it('shows the last of two runs, whichever is read first', async () => {
    void catalogue.repeat(kRun);
    void catalogue.repeat(sampleRun({ id: 'r2' }));
    await give('/runs/r2/scenario', { seed: 2 });
    await give('/runs/r1/scenario', kFlown);
    expect(store.state.repeatedRun?.id).toBe('r2');
    expect(store.state.scenarioDocument).toEqual({ seed: 2 });
  });

  it('keeps a run against the scenario, or its error, that was chosen before', async () => {
    void catalogue.selectScenario('course');
    void catalogue.repeat(kRun);
    await give('/runs/r1/scenario', kFlown);
    await give('/scenarios/course', null);
    expect(store.state.launchErrors).toEqual([]);
    expect(store.state.scenarioDocument).toEqual(kFlown);
  });

  it('flies nothing, and says so, when another choice is made after the click', async () => {
    const launch = async (choose: () => void) => {
      store.state.notices = [];
      await give('/scenarios/course', kCourse);
      answer.clear();
      const launched = catalogue.launch();
      choose();
      await give('/scenarios/course', kCourse);
      await give('/scenarios/hover', { seed: 2 });
      await give('/runs/r1/scenario', kFlown);
      expect(await launched).toBe(false);
      expect(answer.has('/runs')).toBe(false);
      expect(store.state.launching).toBe(false);
      return store.state.notices.map(({ text }) => text);
    };
    const said = ['Nothing was flown: another choice was made in Launch meanwhile.'];
    void catalogue.selectScenario('course');
    expect(await launch(() => void catalogue.selectScenario('hover'))).toEqual(said);
    expect(store.state.scenarioDocument).toEqual({ seed: 2 });
    void catalogue.selectScenario('course');
    expect(await launch(() => void catalogue.repeat(kRun))).toEqual(said);
    expect(store.state.scenarioDocument).toEqual(kFlown);
  });

  it('does not show the errors of a refused launch at another scenario', async () => {
    const refusal = {
      error: {
        code: 'invalid_scenario',
        message: 'the scenario is invalid',
        faults: [{ field: 'seed', message: 'must be at most 3' }],
      },
    };
    const refusedAfter = async (choose: () => void) => {
      await give('/scenarios/course', kCourse);
      answer.clear();
      const launched = catalogue.launch();
      await give('/scenarios/course', kCourse);
      choose();
      await give('/scenarios/hover', { seed: 2 });
      answer.get('/runs')?.(Response.json(refusal, { status: 422 }));
      expect(await launched).toBe(false);
      return store.state.launchErrors.map(({ field }) => field);
    };
    void catalogue.selectScenario('course');
    expect(await refusedAfter(() => undefined)).toEqual(['seed']);
    expect(store.state.notices).toEqual([]);
    void catalogue.selectScenario('course');
    expect(await refusedAfter(() => void catalogue.selectScenario('hover'))).toEqual([]);
    expect(store.state.notices.map(({ text }) => text)).toEqual([
      'Nothing was flown: the scenario is invalid',
    ]);
  });

  it('takes the scenario if the run cannot be flown again', async () => {
    void catalogue.selectScenario('course');
    void catalogue.repeat(kRun);
    await give('/runs/r1/scenario', null);
    await give('/scenarios/course', kCourse);
    expect(store.state.notices).toHaveLength(1);
    expect(store.state.scenarioDocument).toEqual(kCourse);
  });
});
