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
      buffer: dataflashFlight(60, 40),
    });
    await page.locator('[data-log="uploads/my_flight.bin"][aria-current=true]').waitFor();
    await page.locator('[data-stream=SIM]').waitFor();
    await page.locator('.mode-band[data-mode=AUTO]').waitFor();
    await dashboard.until(() => document.querySelector('[data-role=log-message]').hidden);
    assert.ok(await drawn('.log-track'));
    assert.ok(await drawn('[data-log-plot=height] canvas'));
    const units = await page.locator('[data-log-plot] .unit').allInnerTexts();
    assert.deepEqual(units, ['m above mean sea level', 'm/s', 'deg', 'deg', 'deg', 'm', 'deg']);
  });

  step('follows the mouse on the map and in the plots', async () => {
    await page.locator('#log-rebase').uncheck();
    const box = await page.locator('[data-log-plot=speed] .u-over').boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await dashboard.until(() =>
      document.querySelector('[data-role=log-hint]').textContent.includes(' s'),
    );
    // The places of the recording itself arrive after the box was unchecked.
    const place = page.locator('[data-role=log-place]');
    await place.filter({ hasText: /E -?\d+ m, N -?\d+ m · 4\d\./ }).waitFor();
    assert.match(await page.locator('[data-log-plot=speed] .readout').innerText(), /^\d+\.\d$/);
  });

  step('shows what smoothing leaves, and what it leaves out', async () => {
    await page.locator('[data-tab=residuals]').click();
    await page.locator('[data-role=residuals]').filter({ hasText: '1499 used, 1 left out' }).waitFor();
    assert.match(
      await page.locator('[data-role=jumps]').innerText(),
      /^1 position left out at 40\.000 s: up to 11\d\.\d m off$/,
    );
    assert.ok(await drawn('[data-log-plot=residual_positions] canvas'));
    assert.ok(await drawn('[data-log-plot=residual_attitudes] canvas'));
    const box = await page.locator('[data-log-plot=residual_positions] .u-over').boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page
      .locator('[data-log-plot=residual_positions] .readout')
      .filter({ hasText: /^N −?0\.\d{3}$/ })
      .waitFor();
    assert.deepEqual(await dashboard.cutValues(), []);
    await dashboard.screenshot('logs_residuals_1280x800');
    await page.setViewportSize({ width: 1920, height: 1080 });
    await dashboard.screenshot('logs_residuals_1920x1080');
    await page.setViewportSize({ width: 1280, height: 800 });
    await page.locator('[data-tab=flight]').click();
  });

  step('cancels a smoothing, and begins it again', async () => {
    // The answer comes when the test lets it.
    let release;
    const held = new Promise((resolve) => (release = resolve));
    await page.route('**/residuals?*', async (route) => {
      await held;
      await route.continue().catch(() => {});
    });
    await page.locator('[data-tab=residuals]').click();
    await page.locator('#log-offset').check();
    await page.locator('[data-role=smoothing-work]').waitFor({ state: 'visible' });
    await dashboard.screenshot('logs_smoothing_1280x800');
    await page.locator('[data-role=smoothing-work] button').click();
    const failed = page.locator('[data-role=smoothing-failed]');
    await failed.filter({ hasText: 'Cancelled' }).waitFor();
    release();
    await page.unroute('**/residuals?*');
    await page.locator('#log-offset').uncheck();
    await page.locator('[data-role=residuals]').filter({ hasText: '1499 used' }).waitFor();
    await page.locator('[data-tab=flight]').click();
  });

  step('selects a slice by dragging in a plot', async () => {
    const plot = page.locator('[data-log-plot=height] .u-over');
    await plot.waitFor();
    const box = await plot.boundingBox();
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
    await page.locator('#log-rebase').check();
    await page.locator('#log-agl').fill('-5');
    await page.getByRole('button', { name: 'Fly', exact: true }).click();
    const error = page.locator('.log-form .form-errors');
    await error.waitFor({ state: 'visible' });
    assert.match(await error.innerText(), /rebase\.lowest_agl_m/);
    await page.locator('#log-agl').fill('120');
    // While the field has the focus: otherwise the next click would move what it hits.
    await error.waitFor({ state: 'hidden' });
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

  step('shows the worlds of the server on the map, and the flight moved to the chosen one', async () => {
    // The first flight has made the built-in world.
    await page.locator('[data-role=open-logs]').click();
    const note = page.locator('[data-role=log-map-note]');
    await note.filter({ hasText: /^Moved to / }).waitFor();
    const place = async () => {
      const box = await page.locator('.log-track').boundingBox();
      await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
      return page.locator('[data-role=log-place]').innerText();
    };
    // The built-in airfield is in Indiana.
    assert.match(await place(), /· 39\.\d+°, -86\.\d+°$/);
    await dashboard.screenshot('logs_moved_1280x800');
    await page.locator('#log-rebase').uncheck();
    await note.filter({ hasText: /^At its own place: all outside of / }).waitFor();
    assert.match(await place(), /· 4[67]\.\d+°, 8\.\d+°$/);
    await page.locator('#log-rebase').check();
    await note.filter({ hasText: /^Moved to / }).waitFor();
    await page.setViewportSize({ width: 1920, height: 1080 });
    await dashboard.screenshot('logs_moved_1920x1080');
    await page.setViewportSize({ width: 1280, height: 800 });
    await page.locator('#log-rebase').uncheck();
  });

  step('uploads a mapping with its CSV files as one log', async () => {
    const file = (name, text) => ({ name, mimeType: 'text/plain', buffer: Buffer.from(text) });
    const rows = Array.from({ length: 50 }, (_, i) => `${200 * i},${47 + i * 1e-4},8,500`);
    const mapping = {
      csv_mapping_version: 1,
      pieces: [
        {
          name: 'GPS',
          file: 'gps.csv',
          origin: 'gps',
          time: { column: 'T', unit: 'ms' },
          columns: {
            lat: { column: 'Lat', unit: 'deg' },
            lon: { column: 'Lng', unit: 'deg' },
            alt_msl: { column: 'Alt', unit: 'm' },
          },
        },
      ],
    };
    const picker = page.locator('[data-role=log-file]');
    const text = JSON.stringify(mapping);
    await picker.setInputFiles([file('csv flight.json', text)]);
    const error = page.locator('.log-list .form-errors');
    await error.filter({ hasText: 'choose the CSV files' }).waitFor();
    await picker.setInputFiles([
      file('gps.csv', ['T,Lat,Lng,Alt', ...rows, ''].join('\n')),
      file('csv flight.json', text),
    ]);
    const name = 'uploads/csv_flight/csv_flight.json';
    await page.locator(`[data-log="${name}"][aria-current=true]`).waitFor();
    await page.locator('[data-stream=GPS]').waitFor();
    await dashboard.screenshot('logs_csv_1280x800');
    await page.getByLabel(`Delete ${name}`).click();
    await page.getByLabel(`Confirm the deletion of ${name}`).click();
    await page.locator(`[data-log="${name}"]`).waitFor({ state: 'detached' });
  });

  step('deletes the upload', async () => {
    await page.getByLabel('Delete uploads/my_flight.bin').click();
    await page.getByLabel('Confirm the deletion of uploads/my_flight.bin').click();
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
