// A flight with two cameras and faults, edited as JSON: each camera can be watched, and what was
// wrong with a frame is told wherever the frame is shown.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kFlight_s = 5;
const kFlightPatience_ms = 300_000;
const kFaults = [
  { kind: 'blackout', at_s: 2, duration_s: 0.5, camera: 'down' },
  { kind: 'stamp_offset', at_s: 3, duration_s: 1, offset_ms: 25, camera: 'down' },
];

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('a flight with two cameras and faults', { skip, timeout: 600_000 }, () => {
  let stage;
  let run;

  before(async () => {
    stage = await openStage({ width: 1280, height: 800 });
    dashboard = stage.dashboard;
    await dashboard.chooseScenario('camera_faults');
  });

  after(() => stage?.close());

  async function typeFaults(text) {
    await dashboard.page.locator('[data-role=edit-json]').click();
    await dashboard.page.locator('[data-section=faults]').click();
    await dashboard.page.locator('[data-role=as-json]').click();
    await dashboard.page.getByLabel('Section as JSON').fill(text);
  }

  step('names what is wrong with a section while it is typed', async () => {
    await typeFaults(JSON.stringify([{ kind: 'blackout', at_s: 'two' }]));
    const errors = dashboard.page.locator('.editor-errors');
    await errors.filter({ hasText: 'at_s' }).waitFor();
    await dashboard.screenshot('scenario_editor');
    await dashboard.closeEditor();
  });

  step('flies what was typed', async () => {
    await typeFaults(JSON.stringify(kFaults));
    await dashboard.page.locator('[data-check=done]').waitFor();
    await dashboard.closeEditor();
    await dashboard.field('duration_s').fill(String(kFlight_s));
    run = await dashboard.launch();
    await dashboard.untilStatus(run, 'completed', kFlightPatience_ms);
    const file = path.join(stage.runs.folder, run, 'scenario.json');
    const { faults } = JSON.parse(readFileSync(file, 'utf8'));
    assert.deepEqual(
      faults.map(({ kind }) => kind),
      kFaults.map(({ kind }) => kind),
    );
  });

  step('marks the faults on the time line and on their frames', async () => {
    await dashboard.until(
      () => document.querySelector('.track').dataset.faults === 'blackout stamp_offset',
    );
    await dashboard.seekAt('.track .bar', 2.25 / kFlight_s);
    await dashboard.until(
      () => document.querySelector('[data-panel=camera]').dataset.faults === 'blackout',
    );
    assert.ok((await dashboard.picture('camera')).mean < 2, 'a blackout is black');
    assert.deepEqual(await dashboard.cutValues(), []);
    await dashboard.screenshot('blackout');
    await dashboard.seekAt('.track .bar', 3.5 / kFlight_s);
    await dashboard.until(
      () => document.querySelector('[data-panel=camera]').dataset.faults === 'stamp_offset',
    );
    const exposure = await dashboard.page.locator('[data-figure=exposure]').innerText();
    assert.match(exposure, /3/);
  });

  step('shows the camera that is chosen, with its lens', async () => {
    const before = (await dashboard.picture('camera')).digest;
    await dashboard.page.locator('#camera').selectOption('oblique');
    await dashboard.page.locator('[data-role=lens]').filter({ hasText: 'equidistant' }).waitFor();
    await dashboard.untilPictureDiffers('camera', before);
    assert.ok((await dashboard.picture('camera')).deviation > 5, 'the camera image is empty');
    await dashboard.screenshot('oblique_camera');
  });

  step('shows what the estimator draws that is chosen', async () => {
    const before = (await dashboard.picture('debug')).digest;
    await dashboard.page.locator('#debug-of').selectOption('oblique');
    await dashboard.untilPictureDiffers('debug', before);
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
