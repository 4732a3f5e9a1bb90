// A viewer's session with flight logs: upload, look at, choose a slice, fly.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { dataflashFlight } from './support/log_bytes.mjs';
import { getJson, serverMissing, sourceFile } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kFlightPatience_ms = 300_000;
const kRecorded = path.join(
  process.env.OVERFLY_DATA ?? sourceFile('../shared/data'),
  'sitl/plane25.BIN',
);

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('flight logs', { skip, timeout: 900_000 }, () => {
  let stage;
  let page;
  let folder;

  before(async () => {
    stage = await openStage({ width: 1280, height: 800 }, (runs) => {
      folder = path.dirname(runs);
      mkdirSync(path.join(folder, 'made'));
      writeFileSync(path.join(folder, 'made/broken.bin'), dataflashFlight(20).subarray(0, 470));
      writeFileSync(path.join(folder, 'made/square.bin'), dataflashFlight(60));
      const data = [path.join(folder, 'made'), path.dirname(path.dirname(kRecorded))];
      return { runs, data };
    });
    dashboard = stage.dashboard;
    page = dashboard.page;
    await dashboard.chooseScenario('course');
  });

  after(() => stage?.close());

  const choose = async (name) => {
    await page.locator(`[data-log$="${name}"] .log-choice`).click();
    await dashboard.until(
      () => document.querySelector('[data-role=log-message]').textContent !== 'Reading the log',
    );
  };
  /** Whether a canvas shows anything. */
  const drawn = (selector) =>
    page.evaluate((place) => {
      const canvas = document.querySelector(place);
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return data.some((value) => value > 0);
    }, selector);

  step('are listed, and say what is wrong with them', async () => {
    await page.locator('[data-role=open-logs]').click();
    await page.locator('[data-log="made/square.bin"]').waitFor();
    await choose('made/broken.bin');
    await page.locator('.log-message.failed').waitFor();
    assert.match(await page.locator('.log-message').innerText(), /broken\.bin/);
    assert.ok(await page.getByRole('button', { name: 'Fly', exact: true }).isDisabled());
    await dashboard.screenshot('logs_broken_1280x800');
  });

  step('refuses a file that is no log', async () => {
    await page.locator('[data-role=log-file]').setInputFiles({
      name: 'notes.bin',
      mimeType: 'application/octet-stream',
      buffer: Buffer.from('not a log'),
    });
    const error = page.locator('.log-list .form-errors');
    await error.waitFor({ state: 'visible' });
    assert.match(await error.innerText(), /notes\.bin: .*is not a flight log/);
  });

  step('uploads a log and shows streams, map, plots and modes', async () => {
    await page.locator('[data-role=log-file]').setInputFiles({
      name: 'my flight.bin',
      mimeType: 'application/octet-stream',
      buffer: dataflashFlight(60),
    });
    await page.locator('[data-log="uploads/my_flight.bin"][aria-current=true]').waitFor();
    await page.locator('[data-stream=SIM]').waitFor();
    await page.locator('.mode-band[data-mode=AUTO]').waitFor();
    await dashboard.until(() => document.querySelector('[data-role=log-message]').hidden);
    assert.ok(await drawn('.log-track'));
    assert.ok(await drawn('[data-log-plot=height] canvas'));
    const units = await page.locator('[data-log-plot] .unit').allInnerTexts();
    assert.deepEqual(units, ['m above mean sea level', 'm/s', 'deg', 'deg', 'deg']);
  });

  step('follows the mouse on the map and in the plots', async () => {
    const box = await page.locator('[data-log-plot=speed] .u-over').boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await dashboard.until(() =>
      document.querySelector('[data-role=log-hint]').textContent.includes(' s'),
    );
    assert.match(await page.locator('[data-role=log-place]').innerText(), /E -?\d+ m, N -?\d+ m · 4\d\./);
    assert.match(await page.locator('[data-log-plot=speed] .readout').innerText(), /^\d+\.\d$/);
  });

  step('selects a slice by dragging in a plot', async () => {
    const box = await page.locator('[data-log-plot=height] .u-over').boundingBox();
    const y = box.y + box.height / 2;
    await page.mouse.move(box.x + box.width * 0.1, y);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.3, y, { steps: 5 });
    await page.mouse.move(box.x + box.width * 0.35, y, { steps: 5 });
    await page.mouse.up();
    await dashboard.until(() => document.querySelector('#log-to').value !== '');
    const from = Number(await page.locator('#log-from').inputValue());
    const to = Number(await page.locator('#log-to').inputValue());
    assert.ok(Math.abs(from - 7) < 0.6, `from ${from}`);
    assert.ok(Math.abs(to - 22) < 0.6, `to ${to}`);
    await dashboard.screenshot('logs_slice_1280x800');
    await page.setViewportSize({ width: 1920, height: 1080 });
    await dashboard.screenshot('logs_slice_1920x1080');
    await page.setViewportSize({ width: 1280, height: 800 });
  });

  step('shows a fault of the form at its place', async () => {
    await page.locator('#log-agl').fill('-5');
    await page.getByRole('button', { name: 'Fly', exact: true }).click();
    const error = page.locator('.log-form .form-errors');
    await error.waitFor({ state: 'visible' });
    assert.match(await error.innerText(), /rebase\.lowest_agl_m/);
    await page.locator('#log-agl').fill('120');
  });

  step('flies the slice over the chosen world', async () => {
    await page.locator('[data-log-estimator=feature]').uncheck();
    await page.getByRole('button', { name: 'Fly', exact: true }).click();
    await dashboard.until(() => document.querySelector('[data-panel=logs]').hidden);
    const run = await dashboard.runId();
    await dashboard.untilStatus(run, 'completed', kFlightPatience_ms);
    const { flight, frames } = await getJson(stage.server, `/runs/${run}/manifest`);
    assert.match(flight.description, /my_flight\.bin, SIM .*smoothed, moved/);
    assert.ok(Math.abs(frames - 15 * 31) < 31, `${frames} frames`);
    const modes = page.locator('[data-role=flight-lane] .flight-mode');
    assert.deepEqual(await modes.allInnerTexts(), ['AUTO']);
    await dashboard.screenshot('logs_flown_1280x800');
  });

  step('deletes the upload', async () => {
    await page.locator('[data-role=open-logs]').click();
    await page.locator('[data-log="uploads/my_flight.bin"] .icon-button').click();
    await page.locator('[data-log="uploads/my_flight.bin"]').waitFor({ state: 'detached' });
    assert.equal((await getJson(stage.server, '/logs')).uploads.used_bytes, 0);
  });

  step('shows a recorded flight of a simulator', async (t) => {
    if (!existsSync(kRecorded)) {
      t.skip(`${kRecorded} is missing`);
      return;
    }
    await choose('sitl/plane25.BIN');
    await page.locator('.mode-band[data-mode=AUTO]').waitFor();
    await dashboard.until(() => document.querySelector('[data-role=log-message]').hidden);
    await page.locator('#log-source').selectOption('GPS[0]');
    await page.locator('[data-panel=log-map][data-source="GPS[0]"]').waitFor();
    await dashboard.screenshot('logs_recorded_1280x800');
  });
});
