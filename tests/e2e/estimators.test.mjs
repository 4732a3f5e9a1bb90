// One flight, three estimators: a native one, one behind the process door, and one whose program is
// not there. How each fares is told live and after.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { callServer, getJson, serverMissing, sourceFile } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kFlightPatience_ms = 300_000;
const kEstimators = [
  { name: 'feature', type: 'feature', throttle_hz: 5 },
  {
    name: 'shift',
    type: 'process',
    command: ['python3', sourceFile('vo_bridges/examples/shift_odometry.py')],
  },
  { name: 'absent', type: 'process', command: ['./not/there'] },
];

function writeScenario(folder) {
  const scenarios = path.join(folder, 'scenarios');
  mkdirSync(scenarios);
  const course = JSON.parse(readFileSync(sourceFile('scenarios/course.json'), 'utf8'));
  const doors = {
    ...course,
    name: 'doors',
    duration_s: 8,
    camera: { width_px: 320, height_px: 240, rate_hz: 10 },
    pacing: 'real_time',
    estimators: kEstimators,
  };
  writeFileSync(path.join(scenarios, 'doors.json'), JSON.stringify(doors));
  return { runs: path.join(folder, 'runs'), scenarios };
}

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('a flight with estimators behind doors', { skip, timeout: 600_000 }, () => {
  let stage;
  let run;

  before(async () => {
    stage = await openStage({ width: 1280, height: 800 }, writeScenario);
    dashboard = stage.dashboard;
    await dashboard.chooseScenario('doors');
  });

  after(() => stage?.close());

  const cell = (name, column) =>
    dashboard.page
      .locator(`[data-status-of="${name}"] [data-column="${column}"]`)
      .innerText();

  step('shows during the flight that an estimator has ended, and why', async () => {
    run = await dashboard.launch();
    await dashboard.until(
      () => document.querySelector('.tab[data-attention]') !== null,
      undefined,
      kFlightPatience_ms,
    );
    await dashboard.page.locator('.tab[data-group=estimators]').click();
    assert.equal(await cell('absent', 'state'), 'CRASHED');
    const reason = await dashboard.page.locator('.statuses .crash').innerText();
    assert.match(reason, /did not start/);
    assert.match(reason, /not\/there/);
  });

  step('shows dropped frames, latency and resource use of the others', async () => {
    await dashboard.untilStatus(run, 'completed', kFlightPatience_ms);
    await dashboard.until(
      () =>
        document.querySelector('[data-status-of=shift] [data-column=memory]').textContent !== '–',
    );
    assert.match(await cell('feature', 'dropped'), /^\d+ \(\d+\.\d %\)$/);
    assert.equal(await cell('feature', 'hashes'), 'equal');
    assert.equal(await cell('shift', 'hashes'), 'equal');
    assert.match(await cell('shift', 'latency'), /^[\d.]+ \/ [\d.]+$/);
    assert.ok(Number(await cell('shift', 'memory')) > 1);
    assert.ok(Number(await cell('feature', 'memory')) > 0);
    const { estimators } = await getJson(stage.server, `/runs/${run}/estimators`);
    assert.equal(estimators.absent.state, 'CRASHED');
    assert.equal(estimators.shift.resources.measured, 'process');
    assert.equal(estimators.feature.resources.measured, 'own_account');
    await dashboard.screenshot('estimators_1280x800');
  });

  step('shows every value next to the plots completely', async () => {
    await dashboard.page.locator('.tab[data-group=pose]').click();
    await dashboard.seekAt('.track .bar', 0.9);
    await dashboard.page.locator('[data-axis=x_m] .readout').first().waitFor();
    assert.equal(await dashboard.page.locator('[data-axis=x_m] .readout').count(), 4);
    assert.deepEqual(await dashboard.cutValues(), []);
    await dashboard.screenshot('pose_of_three_1280x800');
    // Narrow plots: the values need more rows.
    await dashboard.page.setViewportSize({ width: 1000, height: 800 });
    assert.deepEqual(await dashboard.cutValues(), []);
    await dashboard.page.setViewportSize({ width: 1280, height: 800 });
  });

  step('refuses a command that no scenario file has', async () => {
    const answer = await callServer(stage.server, '/runs', {
      method: 'POST',
      headers: { 'content-type': 'application/json' },
      body: JSON.stringify({
        scenario: 'doors',
        overrides: { 'estimators.1.command': ['/bin/true'] },
      }),
    });
    assert.equal(answer.status, 403);
    assert.match((await answer.json()).error.message, /--allow-commands/);
  });
});
