// Trajectories of a run and of an uploaded file, scored against the run's truth on the page for it.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { flyCourse } from './support/flights.mjs';
import { programFile, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kRun = '20260101-000001-scored';
const kTruth = `run:${kRun}/truth`;
const kEstimate = `run:${kRun}/feature`;

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

function fly(runs) {
  flyCourse(runs, kRun, ['duration_s=5', 'flight.course.airspeed_m_s=25']);
  return {};
}

describe('trajectories scored on their page', { skip, timeout: 600_000 }, () => {
  let stage;
  let page;
  let folder;

  before(async () => {
    stage = await openStage({ width: 1600, height: 900 }, fly);
    dashboard = stage.dashboard;
    page = dashboard.page;
    folder = path.join(stage.runs.folder, kRun);
  });

  after(() => stage?.close());

  const choice = (name) => page.locator(`[data-trajectory="${name}"]`);
  const figure = (estimate, alignment, key) =>
    page
      .locator(`.score-table tr[data-estimate="${estimate}"][data-alignment="${alignment}"]`)
      .locator(`[data-figure=${key}]`);

  step('says what to do first', async () => {
    await page.locator('[data-role=open-scores]').click();
    const message = page.locator('[data-role=score-message]');
    await message.filter({ hasText: 'Choose the truth' }).waitFor();
    await choice(kTruth).locator('input[type=radio]').check();
    await message.filter({ hasText: 'Tick the trajectories' }).waitFor();
  });

  step('scores an estimate as overfly evaluate does', async () => {
    await choice(kEstimate).locator('input[type=checkbox]').check();
    await figure(kEstimate, 'sim3', 'position_rmse_m').waitFor();
    const truth = path.join(folder, 'truth.tum');
    const estimate = path.join(folder, 'estimates/feature.tum');
    const files = ['--truth', truth, '--estimate', estimate];
    const modes = ['--alignment', 'sim3', '--alignment', 'init_scale', '--json'];
    const text = execFileSync(programFile(), ['evaluate', ...files, ...modes]).toString();
    const [{ alignments }] = JSON.parse(text).estimates;
    for (const [mode, errors] of Object.entries(alignments)) {
      for (const key of ['position_rmse_m', 'horizontal_rmse_m', 'rotation_rmse_deg']) {
        const shown = await figure(kEstimate, mode, key).innerText();
        // Sim3 of a straight flight does not determine the rotation.
        assert.equal(shown, errors[key]?.toFixed(3) ?? '–', `${mode} ${key}`);
      }
    }
  });

  step('scores an uploaded file with it, and shows both over time', async () => {
    const file = path.join(path.dirname(stage.runs.folder), 'shifted.tum');
    const lines = readFileSync(path.join(folder, 'estimates/feature.tum'), 'utf8').split('\n');
    const shifted = lines.map((line) => {
      const [t, x, ...rest] = line.split(' ');
      return rest.length === 6 ? [t, Number(x) + 0.001, ...rest].join(' ') : line;
    });
    writeFileSync(file, shifted.join('\n'));
    await page.locator('[data-role=score-file]').setInputFiles(file);
    const name = 'file:uploads/shifted.tum';
    await figure(name, 'sim3', 'position_rmse_m').waitFor();
    const plain = await figure(kEstimate, 'sim3', 'position_rmse_m').innerText();
    assert.equal(await figure(name, 'sim3', 'position_rmse_m').innerText(), plain);
    await page.locator('[data-score-group=pose]').click();
    await page.locator('.score-page [data-axis=yaw_deg] canvas').waitFor();
    const legend = page.locator('.score-page [data-role=plot-legend]');
    assert.deepEqual((await legend.innerText()).split('\n').map((name) => name.split('/').at(-1)), ['truth', 'feature', 'shifted.tum']);
    await page.locator('.score-tools', { hasText: '[s]' }).waitFor();
    await dashboard.screenshot('scoring_pose_1600x900');
    await page.locator('[data-score-group=errors]').click();
    await page.locator('.score-page [data-axis=along_m] canvas').waitFor();
    await page.locator('#score-alignment').selectOption('sim3');
    await dashboard.screenshot('scoring_1600x900');
  });

  step('names the line of a file that is no trajectory', async () => {
    const file = path.join(path.dirname(stage.runs.folder), 'broken.tum');
    writeFileSync(file, '0 1 2 3 0 0 0 1\n1 a b\n');
    await page.locator('[data-role=score-file]').setInputFiles(file);
    await page.locator('[data-role=score-message]').filter({ hasText: 'broken.tum' }).waitFor();
    assert.match(await page.locator('[data-role=score-message]').innerText(), /2/);
    const message = await page.locator('[data-role=score-message]').boundingBox();
    const plots = await page.locator('.score-plots').boundingBox();
    assert.ok(message.y + message.height <= plots.y, 'the message is over the plots');
  });

  step('deletes what was uploaded, and nothing else can be deleted', async () => {
    assert.equal(await page.locator('.score-groups button').count(), 1);
    await page.getByLabel('Delete shifted.tum').click();
    await page.getByLabel('Confirm the deletion of shifted.tum').click();
    await choice('file:uploads/shifted.tum').waitFor({ state: 'detached' });
    await figure(kEstimate, 'sim3', 'position_rmse_m').waitFor();
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
