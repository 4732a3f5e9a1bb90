import { describe, expect, it } from 'vitest';

import { WatchedRun } from '../../src/store/watched_run';
import { catalogue, document, kScenario, reading } from '../support/catalogue_bench';
import { sampleRun } from '../support/samples';

describe('Catalogue', () => {
  it('offers the course first, which needs no data', async () => {
    const { store, subject } = catalogue({
      ...reading,
      'GET /scenarios': () => [200, { scenarios: [{ ...kScenario, name: 'autzen' }, kScenario] }],
    });
    await subject.readScenarios();
    expect(store.state.scenarioName).toBe('course');
  });

  it('opens the first scenario that can be flown', async () => {
    const broken = { ...kScenario, error: 'no data' };
    const { store, subject } = catalogue({
      ...reading,
      'GET /scenarios': () => [200, { scenarios: [broken, { ...kScenario, name: 'tour' }] }],
      'GET /scenarios/tour': () => [200, document],
    });
    await subject.readScenarios();
    expect(store.state.scenarioName).toBe('tour');
    expect(store.state.scenarioDocument).toEqual(document);
  });

  it('says why a scenario cannot be flown', async () => {
    const broken = { ...kScenario, error: 'no data' };
    const { store, subject } = catalogue({
      ...reading,
      'GET /scenarios': () => [200, { scenarios: [broken] }],
    });
    await subject.readScenarios();
    await subject.selectScenario('course');
    expect(store.state.launchErrors).toEqual([{ field: '', message: 'no data' }]);
  });

  it('reads a scenario again that could not be read while the server was away', async () => {
    let away = true;
    let asked = 0;
    const { store, subject } = catalogue({
      ...reading,
      'GET /runs': () => [200, { runs: [] }],
      'GET /scenarios/course': () => {
        ++asked;
        return away ? [503, { error: { code: 'busy', message: 'busy' } }] : [200, document];
      },
    });
    await subject.readScenarios();
    expect(store.state.launchErrors).toEqual([{ field: '', message: 'busy' }]);
    away = false;
    await subject.readRuns();
    expect(store.state).toMatchObject({ scenarioDocument: document, launchErrors: [] });
    await subject.readRuns();
    expect(asked).toBe(2);
  });

  it('launches a run, lists it and watches it', async () => {
    const { store, socket, subject } = catalogue({
      ...reading,
      'POST /runs': () => [201, sampleRun({ id: 'new', status: 'running' })],
    });
    await subject.readScenarios();
    store.state.scenarioEdits = new Map([['seed', '2']]);
    expect(await subject.launch()).toBe(true);
    expect(store.state.runs?.map(({ id }) => id)).toEqual(['new']);
    expect(socket.sent.find(({ type }) => type === 'watch')).toMatchObject({ run: 'new' });
    expect(store.state.launching).toBe(false);
  });

  it("shows the server's field errors in the form", async () => {
    const message = 'seed = -1: must be at least 0';
    const { store, subject } = catalogue({
      ...reading,
      'POST /runs': () => [
        400,
        { error: { code: 'invalid_argument', message, faults: [{ field: 'seed', message }] } },
      ],
    });
    await subject.readScenarios();
    store.state.scenarioEdits = new Map([['seed', '-1']]);
    expect(await subject.launch()).toBe(false);
    expect(store.state.launchErrors).toEqual([{ field: 'seed', message: 'must be at least 0' }]);
    expect(store.state.runId).toBeNull();
  });

  it('flies a run again with changes', async () => {
    const sent: unknown[] = [];
    const flown = { seed: 7, pacing: 'lockstep', estimators: [], camera: { fx_px: 900 } };
    const { store, subject } = catalogue({
      ...reading,
      'GET /runs/r1/scenario': () => [200, flown],
      'POST /runs': (body) => {
        sent.push(JSON.parse(body));
        return [201, sampleRun({ id: 'new', status: 'running' })];
      },
    });
    await subject.readScenarios();
    await subject.repeat(sampleRun({ id: 'r1', scenario: 'of_a_file' }));
    expect(store.state.scenarioDocument).toEqual(flown);
    expect(store.state.scenarioName).toBe('course');
    store.state.scenarioEdits = new Map([['seed', '8']]);
    await subject.launch();
    expect(sent).toEqual([{ document: { ...flown, seed: 8 } }]);
    expect(store.state.runId).toBe('new');
    await subject.selectScenario('course');
    expect(store.state.scenarioEdits.size).toBe(0);
    store.state.scenarioEdits = new Map([['seed', '8']]);
    await subject.launch();
    expect(sent[1]).toEqual({ scenario: 'course', overrides: { seed: 8 } });
  });

  it('sends the whole scenario where a section was removed, which overrides cannot say', async () => {
    const sent: unknown[] = [];
    const { store, subject } = catalogue({
      ...reading,
      'POST /runs': (body) => {
        sent.push(JSON.parse(body));
        return [201, sampleRun({ id: 'new', status: 'running' })];
      },
    });
    await subject.readScenarios();
    store.state.scenarioEdits = new Map([['estimators', '']]);
    expect(subject.asked()).toMatchObject({ document: { seed: 1, pacing: 'lockstep' } });
    await subject.launch();
    expect(sent).toEqual([{ document: { seed: 1, pacing: 'lockstep' } }]);
  });

  it('does not ask the server to fly what is known to be wrong', async () => {
    const { store, subject } = catalogue(reading);
    await subject.readScenarios();
    store.state.scenarioSchema = { properties: { seed: { type: 'integer' } } };
    store.state.scenarioEdits = new Map([
      ['seed', '1.5'],
      ['pacing', '{'],
    ]);
    expect(await subject.launch()).toBe(false);
    expect(store.state.launchErrors.map(({ field }) => field)).toEqual(['pacing', 'seed']);
    expect(subject.asked()).toBeNull();
  });

  it('keeps the form if what a run flew cannot be read', async () => {
    const { store, subject } = catalogue({
      ...reading,
      'GET /runs/r1/scenario': () => [404, { error: { code: 'not_found', message: 'no run r1' } }],
    });
    await subject.readScenarios();
    await subject.repeat(sampleRun({ id: 'r1' }));
    expect(store.state.notices.map(({ text }) => text)).toEqual(['no run r1']);
    expect(store.state.repeatedRun).toBeNull();
    expect(store.state.scenarioDocument).toEqual(document);
  });

  it('says once which flights ended, but not those that the viewer stopped', async () => {
    const running = ['a', 'b', 'c', 'd'].map((id) =>
      sampleRun({ id, title: id, status: 'running' }),
    );
    let runs = running;
    const { store, subject } = catalogue({ 'GET /runs': () => [200, { runs }] });
    await subject.readRuns();
    expect(store.state.notices).toEqual([]);
    runs = [
      sampleRun({ id: 'a', title: 'a', status: 'completed' }),
      sampleRun({ id: 'b', title: 'b', status: 'failed', error: 'no imagery' }),
      sampleRun({ id: 'c', title: 'c', status: 'cancelled' }),
      sampleRun({ id: 'd', title: 'd', status: 'running' }),
    ];
    await subject.readRuns();
    const said = store.state.notices.map(({ level, text }) => [level, text]);
    expect(said).toEqual([
      ['info', 'a: the flight is complete.'],
      ['error', 'b: the flight failed. no imagery'],
    ]);
    await subject.readRuns();
    expect(store.state.notices).toHaveLength(2);
  });

  it('says that a watched flight ended although the stream told it first, and takes its results', async () => {
    let runs = [sampleRun({ status: 'running' })];
    const { store, session, socket, subject } = catalogue({ 'GET /runs': () => [200, { runs }] });
    await subject.readRuns();
    session.selectRun('r1');
    socket.receive({ type: 'run', run: sampleRun({ frames: 7 }) });
    expect(store.state.runs?.[0]?.status).toBe('completed');
    const results = [
      { estimator: 'feature', outcome: 'LOST', position_rmse_m: 2, position_rmse_percent: 1 },
    ];
    runs = [sampleRun({ results, tags: ['wind'], note: 'again' })];
    store.take();
    await subject.readRuns();
    expect(store.state.notices.map(({ text }) => text)).toEqual([
      'The course: the flight is complete.',
    ]);
    expect(store.state.run).toEqual({ ...runs[0], frames: 7 });
    expect(store.take().has('run')).toBe(true);
    await subject.readRuns();
    expect(store.state.notices).toHaveLength(1);
    expect(store.take().has('run')).toBe(false);
  });

  it('says once that somebody deleted a shown run, and not that of a run of a sweep', async () => {
    let runs = [sampleRun(), sampleRun({ id: 'r2' })];
    const { store, session, subject } = catalogue({
      'GET /runs': () => [200, { runs }],
      'DELETE /runs/r2': () => [204, null],
    });
    await subject.readRuns();
    session.showRuns(
      ['r1', 'sweep.0123', 'r2'].map((id) => ({ id, offset_ns: 0 })),
      null,
      null,
    );
    runs = [sampleRun({ id: 'r2' })];
    await subject.readRuns();
    runs = [];
    await subject.remove('r2');
    await subject.readRuns();
    expect(store.state.notices.map(({ text }) => text)).toEqual([
      'The course (r1) was deleted from the server. It is shown as far as it was read.',
    ]);
    expect(store.state.watched.map(({ id, deleted }) => [id, deleted])).toEqual([
      ['r1', true],
      ['sweep.0123', false],
    ]);
  });

  it('says that a flight of this page ended that no list has shown before', async () => {
    const { store, subject } = catalogue({
      ...reading,
      'POST /runs': () => [201, sampleRun({ status: 'running' })],
      'GET /runs': () => [200, { runs: [sampleRun(), sampleRun({ id: 'of another' })] }],
    });
    await subject.readScenarios();
    await subject.launch();
    await subject.readRuns();
    expect(store.state.notices).toHaveLength(1);
  });

  it('keeps what came while an older list was on its way', async () => {
    const early = sampleRun({ id: 'a', status: 'running', frames: 0, frames_total: 0, flight: '' });
    const flying = { ...early, frames: 7, frames_total: 40, flight: 'course' };
    let meanwhile = () => {};
    const { store, subject } = catalogue({
      ...reading,
      'GET /runs': () => {
        meanwhile();
        return [200, { runs: [{ ...early, note: 'windy' }] }];
      },
    });
    store.state.runs = [early];
    // As the stream and a launch do it.
    meanwhile = () => {
      store.state.runs = [sampleRun({ id: 'new', status: 'queued' }), flying];
    };
    await subject.readRuns();
    expect(store.state.runs.map(({ id }) => id)).toEqual(['new', 'a']);
    expect(store.state.runs[1]).toEqual({ ...flying, note: 'windy' });
    meanwhile = () => {};
    await subject.readRuns();
    expect(store.state.runs).toEqual([{ ...early, note: 'windy' }]);
  });

  it('asks for a list after it has taken the one before', async () => {
    const taken: number[] = [];
    const { store, subject } = catalogue({
      ...reading,
      'GET /runs': () => {
        taken.push(store.state.runs?.length ?? 0);
        return [200, { runs: [sampleRun({ id: 'a' })] }];
      },
    });
    await Promise.all([subject.readRuns(), subject.readRuns()]);
    expect(taken).toEqual([0, 1]);
  });

  it('reports a run that cannot be deleted', async () => {
    const { store, subject } = catalogue({
      'DELETE /runs/r1': () => [409, { error: { code: 'conflict', message: 'it still runs' } }],
      'GET /runs': () => [200, { runs: [sampleRun()] }],
    });
    await subject.remove('r1');
    expect(store.state.notices.map(({ text }) => text)).toEqual(['it still runs']);
  });

  it('says why a viewer may not stop a run', async () => {
    const message = 'this address only lets you look';
    const { store, subject } = catalogue({
      'POST /runs/r1/cancel': () => [403, { error: { code: 'read_only', message } }],
      'GET /runs': () => [200, { runs: [sampleRun({ status: 'running' })] }],
    });
    await subject.cancel('r1');
    expect(store.state.notices).toMatchObject([{ level: 'error', text: message }]);
  });

  it('shows the newest run at the first visit, but no other than the one of a link', async () => {
    const routes = {
      'GET /scenarios': () => [200, { scenarios: [] }] as [number, unknown],
      'GET /runs': () =>
        [200, { runs: [sampleRun({ id: 'new' }), sampleRun()] }] as [number, unknown],
    };
    const first = catalogue(routes);
    first.subject.start(true);
    await expect.poll(() => first.store.state.runId).toBe('new');
    const linked = catalogue(routes);
    linked.subject.start(false);
    await expect.poll(() => linked.store.state.runs?.length).toBe(2);
    expect(linked.store.state.runId).toBeNull();
  });

  it('leaves a run that it deletes', async () => {
    const { store, subject } = catalogue({
      'DELETE /runs/r1': () => [204, null],
      'GET /runs': () => [200, { runs: [] }],
    });
    const watched = new WatchedRun('r1');
    store.state.watched.push(watched);
    store.state.main = watched;
    await subject.remove('r1');
    expect(store.state.runId).toBeNull();
    expect(store.state.runs).toEqual([]);
  });

  it('asks no more once the server does not take the token', async () => {
    const locked = { error: { code: 'unauthorized', message: 'the token is missing' } };
    const { store, subject, timers } = catalogue({
      'GET /scenarios': () => [401, locked],
      'GET /runs': () => [401, locked],
    });
    store.state.connection = { status: 'locked' };
    subject.start(false);
    await expect.poll(() => store.state.listError).toBe('the token is missing');
    await expect.poll(() => timers.waiting.size).toBe(0);
    store.state.connection = { status: 'waiting', attempt: 1, delay_ms: 500 };
    subject.start(false);
    await expect.poll(() => timers.waiting.size).toBe(1);
  });

  it('keeps the list and reports that the server is unreachable', async () => {
    const { store, subject } = catalogue({});
    store.state.runs = [sampleRun()];
    await subject.readRuns();
    expect(store.state.runs).toHaveLength(1);
    expect(store.state.listError).toBe('the server does not answer');
  });
});
