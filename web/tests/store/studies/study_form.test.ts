import { beforeEach, describe, expect, it, vi } from 'vitest';
import { RestClient } from '../../../src/connection/rest_client';
import { StudyClient } from '../../../src/connection/study_client';
import type { JsonObject } from '../../../src/protocol/rest_types';
import { Store } from '../../../src/store/state';
import { failedEstimators, plainScenario, StudyForm } from '../../../src/store/studies/study_form';
import { scoredRun } from '../../support/studies';

const kCourse: JsonObject = {
  flight: { course: { airspeed_m_s: 20, height_agl_m: 100 } },
  estimators: [{ name: 'feature', type: 'feature' }],
};

let store: Store;
let sent: JsonObject[];
let refusal: object | null;
const started = vi.fn(() => Promise.resolve());
let form: StudyForm;

beforeEach(() => {
  store = new Store();
  store.state.runs = [
    scoredRun('good', { feature: 'COMPLETED' }),
    scoredRun('bad', { hold: 'COMPLETED', feature: 'LOST', orb: 'RESET' }),
  ];
  store.state.scenarioName = 'course';
  sent = [];
  refusal = null;
  started.mockClear();
  const rest = new RestClient('api', (url, init) => {
    if (init?.method === 'GET') {
      if (url.endsWith('/course')) return Promise.resolve(Response.json(kCourse));
      const error = { code: 'not_found', message: 'no such scenario' };
      return Promise.resolve(Response.json({ error }, { status: 404 }));
    }
    if (refusal !== null) {
      return Promise.resolve(Response.json({ error: refusal }, { status: 400 }));
    }
    sent.push(JSON.parse(init?.body as string) as JsonObject);
    return Promise.resolve(Response.json({ name: 'new' }, { status: 201 }));
  });
  form = new StudyForm(store, new StudyClient(rest), rest, started);
});

const state = () => {
  const { form: shown } = store.state.studyPage;
  if (shown === null) throw new Error('no form');
  return shown;
};

describe('StudyForm', () => {
  it('knows which estimators failed', () => {
    expect(store.state.runs?.map(failedEstimators)).toEqual([[], ['feature', 'orb']]);
    const flying = { ...scoredRun('bad', { feature: 'LOST' }), status: 'running' as const };
    expect(failedEstimators(flying)).toEqual([]);
  });

  it('explains the newest run that failed, all causes as needed', async () => {
    form.openExplain(null);
    expect(state()).toMatchObject({ run: 'bad', estimator: 'feature' });
    form.set('estimator', 'orb');
    form.setNumber('flights', '20');
    expect(await form.start()).toBe(true);
    expect(sent).toEqual([{ kind: 'explain', run: 'bad', estimator: 'orb', flights: 20 }]);
    expect(started).toHaveBeenCalledWith('new');
    expect(store.state.studyPage.form).toBeNull();
  });

  it('can explain nothing where no estimator of a completed run failed', async () => {
    form.openExplain(null);
    expect(form.canStart(state())).toBe(true);
    const failed = { ...scoredRun('failed', { feature: 'LOST' }), status: 'failed' as const };
    store.state.runs = [failed];
    form.openExplain(failed);
    expect(form.canStart(state())).toBe(false);
    await form.openScenario('predict', plainScenario('course'));
    expect(form.canStart(state())).toBe(true);
  });

  it('tries only the causes that are ticked', async () => {
    form.openExplain(null);
    form.setCause('blur', true);
    form.setCause('noise', true);
    form.setCause('blur', false);
    await form.start();
    expect(sent[0]?.['causes']).toEqual(['noise']);
  });

  it('offers a run that is not in the list, such as one of a sweep', () => {
    const run = scoredRun('night.0123456789abcdef0123', { feature: 'LOST' });
    form.openExplain(run);
    expect(form.runsOf(state()).map(({ id }) => id)).toEqual([run.id, 'bad']);
    form.chooseRun('bad');
    expect(state()).toMatchObject({ run: 'bad', estimator: 'feature' });
  });

  it('predicts the scenario with the changes of the launcher', async () => {
    const overrides = { 'flight.course.airspeed_m_s': 30 };
    await form.openScenario('predict', {
      scenario: 'course',
      overrides,
      document: null,
      title: 'Course',
    });
    form.setFlag('map', false);
    form.setNumber('rate_hz', ' 4 ');
    await form.start();
    expect(sent).toEqual([
      { kind: 'predict', scenario: 'course', overrides, map: false, rate_hz: 4 },
    ]);
  });

  it('sends a whole document, with its changes, of a flight that is flown again', async () => {
    await form.openScenario('predict', {
      scenario: '',
      overrides: { seed: 3 },
      document: kCourse,
      title: 'Again',
    });
    await form.start();
    expect(sent[0]?.['document']).toEqual({ ...kCourse, seed: 3 });
    expect(sent[0]).not.toHaveProperty('scenario');
  });

  it('hunts within the limits of fields that the scenario has', async () => {
    await form.openScenario('hunt', plainScenario('course'));
    expect(state().axes.map(({ path }) => path)).toEqual([
      'flight.course.height_agl_m',
      'flight.course.airspeed_m_s',
    ]);
    form.removeAxis(1);
    form.setAxis(0, { to: '150', step: '10' });
    form.addAxis();
    form.setAxis(1, { path: 'flight.course.bank_max_deg' });
    form.setFlag('all', true);
    await form.start();
    expect(sent).toEqual([
      {
        kind: 'hunt',
        scenario: 'course',
        all: true,
        axes: [
          {
            path: 'flight.course.height_agl_m',
            from: 60,
            to: 150,
            step: 10,
            label: 'Height AGL',
            unit: 'm',
          },
          {
            path: 'flight.course.bank_max_deg',
            from: 20,
            to: 55,
            label: 'Bank limit',
            unit: 'deg',
          },
        ],
      },
    ]);
  });

  it('names fields that are no numbers before it asks', async () => {
    await form.openScenario('hunt', plainScenario('course'));
    form.setAxis(0, { from: 'low', to: '' });
    form.setNumber('flights', 'many');
    expect(await form.start()).toBe(false);
    expect(state().errors).toEqual([
      { field: 'flights', message: 'must be a number' },
      { field: 'axes.0.from', message: 'must be a number' },
      { field: 'axes.0.to', message: 'must be a number' },
    ]);
    expect(sent).toEqual([]);
    form.setNumber('flights', '');
    form.removeAxis(0);
    form.removeAxis(0);
    expect(await form.start()).toBe(false);
    expect(state().errors.map(({ field }) => field)).toEqual(['axes']);
  });

  it("shows the server's errors at their fields, and stays open", async () => {
    form.openExplain(null);
    const message = 'flights = 99: must be in [1, 60]';
    refusal = { code: 'invalid_argument', message, faults: [{ field: 'flights', message }] };
    expect(await form.start()).toBe(false);
    expect(state()).toMatchObject({
      starting: false,
      errors: [{ field: 'flights', message: 'must be in [1, 60]' }],
    });
    form.setNumber('flights', '9');
    expect(state().errors).toEqual([]);
  });

  it('says that a scenario is gone', async () => {
    await form.openScenario('hunt', plainScenario('course'));
    await form.chooseScenario('gone');
    expect(state().errors).toEqual([{ field: '', message: 'no such scenario' }]);
    expect(state().document).toBeNull();
  });
});
