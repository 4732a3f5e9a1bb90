// A sweep that is flown beside the server: its matrix fills, and a cell opens its flight.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import {
  callServer,
  programFile,
  serverMissing,
  sourceFile,
  startServer,
} from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kPatience_ms = 300_000;

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

const kSweep = {
  format_version: 1,
  title: 'Two heights, two airspeeds and a blackout',
  scenario: sourceFile('scenarios/course.json'),
  set: { duration_s: 4, 'camera.width_px': 320, 'camera.height_px': 240 },
  axes: [
    {
      path: 'flight.course.height_agl_m',
      label: 'Height',
      unit: 'm',
      values: [100, 300],
    },
    {
      name: 'light',
      variants: [
        { value: 'day', set: {} },
        { value: 'blackout', set: { faults: [{ kind: 'blackout', at_s: 0 }] } },
      ],
    },
    { path: 'flight.course.airspeed_m_s', label: 'Airspeed', unit: 'm/s', values: [20, 25] },
  ],
  estimators: [
    { name: 'feature', type: 'feature' },
    { name: 'hold', type: 'baseline_hold' },
  ],
};

/** Started from the dashboard; more flights than are over when it is cancelled. */
const kStarted = {
  format_version: 1,
  title: 'Six heights',
  scenario: 'course',
  set: { duration_s: 4, 'camera.width_px': 320, 'camera.height_px': 240 },
  axes: [
    {
      path: 'flight.course.height_agl_m',
      label: 'Height',
      unit: 'm',
      from: 100,
      to: 300,
      step: 40,
    },
  ],
  estimators: [{ name: 'feature', type: 'feature' }],
};

/** Without the sun from an instant on: the estimator survives if it comes after the end of the flight. */
const kBorder = {
  format_version: 1,
  title: 'When may the light go out?',
  scenario: 'course',
  set: {
    duration_s: 4,
    'camera.width_px': 320,
    'camera.height_px': 240,
    faults: [{ kind: 'blackout', at_s: 0 }],
  },
  axes: [
    { path: 'faults.0.at_s', label: 'Blackout', unit: 's', values: [0, 1, 2, 6, 8, 10] },
    { path: 'flight.course.airspeed_m_s', label: 'Airspeed', unit: 'm/s', values: [20, 25] },
  ],
  estimators: [{ name: 'feature', type: 'feature' }],
};

/** Processes whose command line has this text. */
function processesOf(text) {
  return readdirSync('/proc').filter((id) => {
    if (!/^\d+$/.test(id) || Number(id) === process.pid) return false;
    try {
      return readFileSync(`/proc/${id}/cmdline`, 'utf8').includes(text);
    } catch {
      return false;
    }
  });
}

async function until(condition) {
  const late = Date.now() + kPatience_ms;
  while (!condition()) {
    assert.ok(Date.now() < late, String(condition));
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

describe('sweeps', { skip, timeout: 900_000 }, () => {
  let stage;
  let page;
  let folder;
  let flown;

  before(async () => {
    stage = await openStage({ width: 1280, height: 800 }, (runs) => {
      folder = path.join(path.dirname(runs), 'sweeps');
      mkdirSync(folder);
      return { sweeps: folder };
    });
    dashboard = stage.dashboard;
    page = dashboard.page;
  });

  after(() => stage?.close());

  const matrix = (estimator) => page.locator(`.sweep-matrix[data-estimator="${estimator}"]`);

  step('says how to fly the first one', async () => {
    await page.locator('[data-role=open-sweeps]').click();
    await page.locator('[data-role=sweep-message]', { hasText: 'no sweeps yet' }).waitFor();
    await dashboard.screenshot('no_sweeps_1280x800');
    await page.locator('.sweep-page [aria-label=Close]').click();
  });

  step('shows a sweep while it flies', async () => {
    const file = path.join(path.dirname(folder), 'night.json');
    writeFileSync(file, JSON.stringify(kSweep));
    const args = ['sweep', file, '--out', path.join(folder, 'night'), '--jobs', '1', '--quiet'];
    const child = spawn(programFile(), args, { stdio: 'ignore' });
    flown = new Promise((resolve) => child.on('exit', resolve));
    await page.locator('[data-role=open-sweeps]').click();
    await page.locator('[data-sweep=night]').waitFor({ timeout: kPatience_ms });
    await matrix('feature').locator('.sweep-cell').first().waitFor({ timeout: kPatience_ms });
    assert.equal(await flown, 0);
    await page.waitForFunction(
      () => document.querySelectorAll('.sweep-matrix .sweep-cell').length === 16,
      null,
      { timeout: kPatience_ms },
    );
  });

  step('shows outcomes, rates and errors of each cell', async () => {
    const texts = () => matrix('feature').locator('.sweep-cell').allInnerTexts();
    const days = (await texts()).filter((text) => text === 'ok').length;
    assert.equal(days, 4, (await texts()).join());
    assert.equal((await texts()).filter((text) => text === 'no start').length, 4);
    await page.locator('[data-role=sweep-figure]').selectOption('success');
    await matrix('feature').locator('.sweep-cell', { hasText: '100' }).first().waitFor();
    assert.deepEqual((await texts()).sort(), [...Array(4).fill('0'), ...Array(4).fill('100')]);
    await page.locator('[data-role=sweep-figure]').selectOption('paper_position');
    await matrix('feature').locator('.sweep-cell', { hasText: 'X' }).first().waitFor();
    assert.equal((await texts()).filter((text) => text === 'X').length, 4);
    await page.locator('[data-role=sweep-rows]').selectOption('flight.course.height_agl_m');
    // The axes change places.
    await dashboard.until(
      () => document.querySelector('[data-role=sweep-columns]').value === 'light',
    );
  });

  step('shows the values of a third axis side by side, or one of them', async () => {
    const values = () =>
      page
        .locator('.sweep-matrix[data-estimator=feature]')
        .evaluateAll((all) => all.map((one) => one.dataset.panelValue ?? ''));
    assert.deepEqual(await values(), ['Airspeed 20 m/s', 'Airspeed 25 m/s']);
    await dashboard.screenshot('sweep_three_axes_1280x800');
    await page.locator('[data-role=sweep-panels]').selectOption('');
    await dashboard.until(
      () => document.querySelectorAll('.sweep-matrix[data-estimator=feature]').length === 1,
    );
    await page
      .locator('[data-role="sweep-fix-flight.course.airspeed_m_s"]')
      .selectOption({ label: '25 m/s' });
    await page.locator('[data-role=sweep-panels]').selectOption({ label: 'Airspeed' });
    await page.locator('[data-panel-value="Airspeed 25 m/s"]').first().waitFor();
  });

  const state = (text) =>
    page.locator('[data-role=sweep-state]', { hasText: text }).waitFor({ timeout: kPatience_ms });
  const cells = () => matrix('feature').locator('.sweep-cell');

  step('names the fields at fault of a sweep that is prepared', async () => {
    await page.locator('[data-role=new-sweep]').click();
    const text = page.locator('[data-role=sweep-text]');
    await page.locator('[data-role=sweep-file]').selectOption('quick');
    await page
      .locator('[data-role=sweep-cost]', { hasText: '6 cells' })
      .waitFor({ timeout: kPatience_ms });
    assert.equal(await page.locator('[data-role=sweep-name]').inputValue(), 'quick');
    await dashboard.screenshot('new_sweep_1280x800');
    await text.fill(JSON.stringify({ ...kStarted, scenario: '/etc/passwd' }, null, 2));
    await page
      .locator('[data-role=sweep-errors]', {
        hasText: "must be a file inside of the server's data folders",
      })
      .waitFor({ timeout: kPatience_ms });
    assert.ok(await page.locator('[data-role=start-sweep]').isDisabled());
    await dashboard.screenshot('sweep_at_fault_1280x800');
  });

  step('starts a sweep, whose cells fill', async () => {
    const text = page.locator('[data-role=sweep-text]');
    await text.fill(JSON.stringify(kStarted, null, 2));
    await page.locator('[data-role=sweep-name]').fill('started');
    await page.locator('[data-role=sweep-jobs]').fill('1');
    await page
      .locator('[data-role=sweep-cost]', { hasText: 'at most 6 flights' })
      .waitFor({ timeout: kPatience_ms });
    await page.locator('[data-role=start-sweep]').click();
    await state('flying');
    await cells().first().waitFor({ timeout: kPatience_ms });
    await dashboard.screenshot('sweep_flying_1280x800');
  });

  step('cancels it after a confirmation, and keeps the results', async () => {
    const cancel = page.locator('[data-role=cancel-sweep]');
    await cancel.click();
    assert.equal(await cancel.innerText(), 'Cancel the sweep?');
    await cancel.click();
    await state('stopped');
    const known = await cells().count();
    assert.ok(known >= 1 && known < 6, `${known} cells`);
    await dashboard.screenshot('sweep_stopped_1280x800');
  });

  step('continues it after the server was killed while it flew', async () => {
    const { server } = stage;
    const go = (what, body) =>
      callServer(server, `/sweeps/started/${what}`, {
        method: 'POST',
        headers: { 'content-type': 'application/json' },
        body: JSON.stringify(body),
      });
    assert.equal((await go('continue', { jobs: 1 })).status, 202);
    const flights = () => processesOf(path.join(folder, 'started'));
    await until(() => flights().length > 0);
    await server.kill();
    await until(() => flights().length === 0);
    stage.server = await startServer({
      runs: stage.runs.folder,
      tokenFile: stage.runs.tokenFile,
      port: server.port,
      sweeps: folder,
    });
    await page.locator('[data-sweep=started]').click();
    await state('stopped');
    await page.locator('[data-role=continue-sweep]').click();
    await state('complete');
    assert.equal(await cells().count(), 6);
    const notice = page.locator('.notice', { hasText: 'the sweep is complete' }).first();
    await notice.waitFor();
    const isOnTop = await notice.evaluate((element) => {
      const { left, top, width, height } = element.getBoundingClientRect();
      return element.contains(document.elementFromPoint(left + width / 2, top + height / 2));
    });
    assert.ok(isOnTop, 'the notice is seen over the page');
    await dashboard.screenshot('sweep_complete_1280x800');
    await page.emulateMedia({ colorScheme: 'dark' });
    await dashboard.screenshot('sweep_complete_dark_1280x800');
    await page.locator('[data-role=extend-sweep]').click();
    await page
      .locator('[data-role=sweep-cost]', { hasText: 'about' })
      .waitFor({ timeout: kPatience_ms });
    await dashboard.screenshot('extend_sweep_dark_1280x800');
    await page.emulateMedia({ colorScheme: 'light' });
    await page.locator('.sweep-form button', { hasText: 'Close' }).click();
    await page.locator('[data-sweep=night]').click();
    await matrix('hold').first().waitFor();
  });

  step('flies only the border along an axis', async () => {
    await page.locator('[data-role=new-sweep]').click();
    await page.locator('[data-role=sweep-cost]', { hasText: 'cells' }).waitFor({ timeout: kPatience_ms });
    await page.locator('[data-role=sweep-name]').fill('border');
    await page.locator('[data-role=sweep-text]').fill(JSON.stringify(kBorder, null, 2));
    await page
      .locator('[data-role=sweep-cost]', { hasText: '12 cells' })
      .waitFor({ timeout: kPatience_ms });
    await page.locator('[data-role=sweep-border]').selectOption('faults.0.at_s');
    await page.locator('[data-role=sweep-cost]', { hasText: 'only the cells at the border' }).waitFor();
    await dashboard.screenshot('new_border_1280x800');
    await page.locator('[data-role=start-sweep]').click();
    await state('border found');
    const lines = page.locator('.sweep-envelope tbody tr');
    assert.deepEqual(await lines.allInnerTexts(), ['20\t6 s\t2 s', '25\t6 s\t2 s']);
    const flown = await cells().count();
    assert.ok(flown < 12, `${flown} of 12 cells`);
    assert.match(await page.locator('.sweep-envelope').innerText(), /\d of 12 cells were needed/);
    assert.equal(await page.locator('[data-role=continue-sweep]').innerText(), 'Fly the other cells');
    await page.locator('[data-sweep=border]').waitFor();
    await page.locator('.sweep-envelope').scrollIntoViewIfNeeded();
    await dashboard.screenshot('border_found_1280x800');
    await page.locator('[data-sweep=night]').click();
    await matrix('hold').first().waitFor();
  });

  step('saves its tables, next to published errors', async () => {
    const save = async (format) => {
      const saved = page.waitForEvent('download');
      await page.locator(`.sweep-files [data-format=${format}]`).click();
      const download = await saved;
      return {
        name: download.suggestedFilename(),
        text: readFileSync(await download.path(), 'utf8'),
      };
    };
    const { name, text } = await save('markdown');
    assert.equal(name, 'night.md');
    assert.match(text, /^# Two heights, two airspeeds and a blackout/);
    assert.doesNotMatch(text, /published/i);
    await page.locator('[data-role=sweep-published]').selectOption('paper');
    await page.locator('[data-role=counterparts]').fill('feature=ORB-SLAM2');
    assert.match(
      (await save('markdown')).text,
      /No cell of this sweep is published in: Virtual Testbed/,
    );
    assert.match((await save('html')).text, /<table/);
    assert.equal((await save('latex')).name, 'night.tex');
    assert.match((await save('csv')).text, /feature/);
  });

  step('compares it with another sweep, flight by flight', async () => {
    // The same flights, in one of which the estimator was lost.
    cpSync(path.join(folder, 'night'), path.join(folder, 'baseline'), { recursive: true });
    const results = path.join(folder, 'baseline/results.jsonl');
    const lines = readFileSync(results, 'utf8')
      .trim()
      .split('\n')
      .map((line) => JSON.parse(line));
    lines.find(
      ({ estimator, outcome }) => estimator === 'feature' && outcome === 'COMPLETED',
    ).outcome = 'LOST';
    writeFileSync(results, lines.map((line) => `${JSON.stringify(line)}\n`).join(''));
    await page.locator('[data-role=compare-baseline] option[value=baseline]').waitFor({
      state: 'attached',
      timeout: 60_000,
    });
    await page.locator('[data-role=compare-baseline]').selectOption('baseline');
    await page.locator('[data-role=compare-estimator]').selectOption('feature');
    await page
      .locator('[data-role=compare-conditions]')
      .fill('success_rate < baseline\nmedian(position_rmse_m) >= baseline\nmedian(nothing) > 1');
    await page.locator('[data-role=compare-sweeps]').click();
    const answer = page.locator('[data-role=comparison]');
    await answer.locator('.bad', { hasText: 'nothing' }).waitFor();
    await page
      .locator('[data-role=compare-conditions]')
      .fill('success_rate < baseline\nmedian(position_rmse_m) >= baseline');
    await page.locator('[data-role=compare-sweeps]').click();
    await answer.locator('p', { hasText: '8 flights in both sweeps; 0 without a pair' }).waitFor();
    const row = answer.locator('[data-quantity=success_rate] td');
    assert.deepEqual(await row.allInnerTexts(), ['8', '50 %', '38 %']);
    assert.deepEqual(await answer.locator('li .chip').allInnerTexts(), ['passed', 'failed']);
    await answer.locator('li').last().scrollIntoViewIfNeeded();
    await dashboard.screenshot('sweep_comparison_1280x800');
  });

  step('opens the flight of a cell', async () => {
    await matrix('feature').locator('.sweep-cell').first().click();
    const open = page.locator('.sweep-flights tr[data-estimator=feature] [data-run]');
    const id = await open.getAttribute('data-run');
    assert.match(id, /^night\.[0-9a-f]{20}$/);
    await dashboard.screenshot('sweep_1280x800');
    await open.click();
    await page.locator('.sweep-page').waitFor({ state: 'hidden' });
    await page.locator('[data-role=status]', { hasText: 'completed' }).waitFor();
    await dashboard.until((run) => location.hash.includes(run), id);
    await page.locator('[data-panel=errors] th', { hasText: 'feature' }).waitFor();
  });

  step('deletes a sweep with its flights after a confirmation', async () => {
    await page.locator('[data-role=open-sweeps]').click();
    await page.locator('[data-sweep=started]').click();
    const bin = page.locator('[data-role=delete-sweep][data-of=started]');
    await bin.click();
    assert.equal(await bin.innerText(), 'Delete the sweep?');
    await dashboard.screenshot('sweep_deletion_1280x800');
    assert.ok(existsSync(path.join(folder, 'started')));
    await bin.click();
    await page.locator('[data-sweep=started]').waitFor({ state: 'detached' });
    assert.ok(!existsSync(path.join(folder, 'started')));
    await page.locator('[data-sweep=night]').waitFor();
  });
});
