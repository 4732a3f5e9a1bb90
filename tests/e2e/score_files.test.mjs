// Trajectories of files and logs on the score page: dropped, chosen, plotted, explained, copied.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { assertFigures, copyFrom, csvRows } from './support/copied_errors.mjs';
import { dataflashFlight } from './support/log_bytes.mjs';
import { programFile, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';
import { estimated, eurocText, flown, kittiTexts, tumText } from './support/trajectories.mjs';

const kDuration_s = 260;
const kTruth = 'file:uploads/truth.tum';
const kKitti = 'file:uploads/00.tum';
const kEuroc = 'file:uploads/euroc.csv';
const kLog = 'log:uploads/circle.bin';
const kCopy = 'select[aria-label="Copy the scores"]';

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('trajectories of files and logs', { skip, timeout: 600_000 }, () => {
  let stage;
  let page;
  /** Where the same files lie for overfly evaluate. */
  let folder;
  const texts = {
    truth: tumText(flown(kDuration_s)),
    kitti: kittiTexts(flown(kDuration_s, estimated({ scale: 12.5 }))),
    euroc: eurocText(flown(kDuration_s, estimated({ clock_s: 0.4, mount_deg: 7 }))),
  };
  const log = dataflashFlight(60);

  before(async () => {
    stage = await openStage({ width: 1600, height: 900 });
    dashboard = stage.dashboard;
    page = dashboard.page;
    folder = path.join(path.dirname(stage.runs.folder), 'made');
    mkdirSync(path.join(folder, 'kitti'), { recursive: true });
    writeFileSync(path.join(folder, 'truth.tum'), texts.truth);
    writeFileSync(path.join(folder, 'kitti/00.txt'), texts.kitti.poses);
    writeFileSync(path.join(folder, 'kitti/times.txt'), texts.kitti.times);
    writeFileSync(path.join(folder, 'euroc.csv'), texts.euroc);
    writeFileSync(path.join(folder, 'circle.bin'), log);
    await page.locator('[data-role=open-scores]').click();
    await page.locator('.score-page').waitFor();
  });

  after(() => stage?.close());

  const choice = (name) => page.locator(`[data-trajectory="${name}"]`);
  const cell = (estimate, alignment, key) =>
    page
      .locator(`.score-table tr[data-estimate="${estimate}"][data-alignment="${alignment}"]`)
      .locator(`[data-figure=${key}]`);
  const message = (text) =>
    page.locator('[data-role=score-message]').filter({ hasText: text }).waitFor();
  /** Files as a mouse drops them: [name, content]. */
  const drop = async (...files) => {
    const coded = files.map(([name, content]) => [name, Buffer.from(content).toString('base64')]);
    const dataTransfer = await page.evaluateHandle((list) => {
      const transfer = new DataTransfer();
      for (const [name, base64] of list) {
        const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
        transfer.items.add(new File([bytes], name));
      }
      return transfer;
    }, coded);
    await page.locator('.score-page').dispatchEvent('drop', { dataTransfer });
  };
  const evaluate = (truth, ...estimates) => {
    const files = estimates.flatMap((file) => ['--estimate', path.join(folder, file)]);
    const text = execFileSync(programFile(), [
      ...['evaluate', '--truth', path.join(folder, truth), ...files],
      ...['--alignment', 'all', '--find-offsets', '--json'],
    ]);
    return JSON.parse(text.toString()).estimates;
  };
  /** Compares every number of the copied rows. @param printed by the estimate's name */
  const compare = (csv, printed) => {
    const rows = csvRows(csv);
    let numbers = 0;
    for (const [name, { alignments }] of Object.entries(printed)) {
      const own = rows.filter(({ estimate }) => estimate === name);
      assert.deepEqual(own.map(({ alignment }) => alignment).sort(), Object.keys(alignments));
      for (const row of own) {
        numbers += assertFigures(row, alignments[row.alignment], [
          'truth',
          'estimate',
          'alignment',
        ]);
      }
    }
    return { rows, numbers };
  };
  /** Whether a canvas shows anything. */
  const drawn = (selector) =>
    page.evaluate((place) => {
      const canvas = document.querySelector(place);
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return data.some((value) => value > 0);
    }, selector);

  step('takes a dropped file as the truth', async () => {
    await drop(['truth.tum', texts.truth]);
    await choice(kTruth).waitFor();
    await dashboard.until(
      (name) => document.querySelector(`[data-trajectory="${name}"] [type=radio]`).checked,
      kTruth,
    );
    await message('Tick the trajectories');
  });

  step('wants the poses that times belong to', async () => {
    await drop(['times.txt', texts.kitti.times]);
    await message('times.txt: choose the KITTI poses');
    await drop(['times.txt', texts.kitti.times], ['00.txt', texts.kitti.poses.split('\n')[0]]);
    await message(/^00\.txt: 1 poses, but 2600 times/);
  });

  step('joins dropped KITTI poses with their times', async () => {
    await drop(['times.txt', texts.kitti.times], ['00.txt', texts.kitti.poses]);
    await cell(kKitti, 'sim3', 'scale').filter({ hasText: '12.5' }).waitFor();
    assert.ok(await choice(kKitti).locator('[type=checkbox]').isChecked());
    await page.locator('[data-role=score-message]').waitFor({ state: 'hidden' });
  });

  step('takes a EuRoC file from the file chooser, and explains its errors', async () => {
    const offsets = page.locator('[data-role=score-offsets] li');
    assert.equal(await offsets.count(), 0, 'nothing explains the errors of the first');
    await page.locator('[data-role=score-file]').setInputFiles(path.join(folder, 'euroc.csv'));
    await cell(kEuroc, 'sim3', 'scale').waitFor();
    const [, { offsets: printed }] = evaluate('truth.tum', 'kitti/00.txt', 'euroc.csv');
    const [clock, mount] = await offsets.allInnerTexts();
    const early_ms = (1000 * printed.clock.time_offset_s).toFixed(1);
    assert.ok(Math.abs(early_ms - 400) < 1, 'as it was made');
    assert.ok(clock.startsWith(`uploads/euroc.csv: its clock is ${early_ms} ms early`), clock);
    assert.match(clock, /explains 99 % of the position error after sim3/);
    assert.match(clock, new RegExp(`RMSE ${printed.clock.position_rmse_before_m.toFixed(3)} m`));
    assert.ok(mount.includes(`rotation of ${printed.mount.angle_deg.toFixed(2)} deg`), mount);
    assert.ok(mount.includes(`without it ${printed.mount.rotation_rmse_after_deg.toFixed(3)} deg`));
    await dashboard.screenshot('score_files_1600x900');
  });

  step('copies every figure as overfly evaluate prints it', async () => {
    const [kitti, euroc] = evaluate('truth.tum', 'kitti/00.txt', 'euroc.csv');
    const csv = await copyFrom(page, kCopy, 'CSV');
    const { rows, numbers } = compare(csv, { [kKitti]: kitti, [kEuroc]: euroc });
    assert.equal(rows.length, 16);
    // Eight errors, drift over seven lengths, and three intervals between fixes.
    assert.equal(numbers, 16 * (8 + 2 * 7 + 2 * 3));
    const markdown = (await copyFrom(page, kCopy, 'Markdown')).trimEnd().split('\n');
    const latex = await copyFrom(page, kCopy, 'LaTeX');
    assert.match(latex, /^\\begin\{tabular\}\{llr+\}\n.*\\end\{tabular\}\n$/s);
    const lines = latex.split('\n').filter((line) => line.includes('&'));
    assert.equal(markdown.length, rows.length + 2);
    assert.equal(lines.length, rows.length + 1);
    assert.match(lines[0], /Of the path \[\\%\].*Drift in 5000 m \[\\%\]/);
    const shown = await page.evaluate(() =>
      [...document.querySelectorAll('.score-table tbody tr')].map((row) =>
        [...row.querySelectorAll('[data-figure]')].map(({ innerText }) => innerText),
      ),
    );
    shown.forEach((cells, i) => {
      assert.ok(markdown[i + 2].endsWith(`| ${cells.join(' | ')} |`), markdown[i + 2]);
      const plain = cells.map((text) => text.replace('−', '$-$').replace('–', '--'));
      assert.ok(lines[i + 1].endsWith(`& ${plain.join(' & ')} \\\\`), lines[i + 1]);
    });
  });

  step('plots the tracks from above and from the side', async () => {
    await page.locator('#score-alignment').selectOption('sim3');
    await page.locator('.score-plots [data-alignment=sim3]').waitFor();
    await page.locator('[data-score-group=path]').click();
    for (const key of ['xy', 'xz']) {
      await page.locator(`.score-page [data-axis=${key}] canvas`).waitFor();
      await dashboard.until(
        (axis) => document.querySelector(`.score-page [data-axis=${axis}] canvas`).width > 300,
        key,
      );
      await page.evaluate(() => new Promise(requestAnimationFrame));
      assert.ok(await drawn(`.score-page [data-axis=${key}] canvas`), key);
    }
    await dashboard.screenshot('score_files_path_1600x900');
  });

  step('plots the drift over the length of the path, and saves it', async () => {
    await page.locator('[data-score-group=drift]').click();
    await page.locator('.score-page [data-axis=translation_percent] canvas').waitFor();
    const units = await page.locator('.score-page .plot-title .unit').allInnerTexts();
    assert.deepEqual(units, [
      '%, over the length of sub-paths',
      'deg / 100 m, over the length of sub-paths',
    ]);
    await dashboard.screenshot('score_files_drift_1600x900');
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.locator('.score-page .plot-files').selectOption('csv'),
    ]);
    const [head, ...lines] = readFileSync(await download.path(), 'utf8')
      .trimEnd()
      .split('\n');
    assert.equal(head, 'figure,estimate,length_m,value,sub_paths');
    const [{ alignments }] = evaluate('truth.tum', 'kitti/00.txt');
    const saved = lines.filter((line) => line.startsWith('translation_percent,uploads/00.tum,'));
    assert.deepEqual(
      saved.map((line) => Number(line.split(',')[2])),
      alignments.sim3.relative.map(({ length_m }) => length_m),
    );
    saved.forEach((line, i) => {
      const { translation_percent: printed } = alignments.sim3.relative[i];
      assert.ok(Math.abs(Number(line.split(',')[3]) - printed) <= 1e-9 * printed, line);
    });
    await page.locator('[data-score-group=errors]').click();
  });

  step('leaves a trajectory that has diverged out of the axes, and names it', async () => {
    const good = estimated({});
    const burst = (t_s) => {
      const pose = good(t_s);
      const factor = Math.exp(Math.max(0, t_s - 1100) / 5);
      return { ...pose, position: pose.position.map((value) => value * factor) };
    };
    await choice(kKitti).locator('[type=checkbox]').uncheck();
    await page.locator('#score-alignment').selectOption('none');
    await drop(
      ['good.tum', tumText(flown(kDuration_s, good))],
      ['burst.tum', tumText(flown(kDuration_s, burst))],
    );
    await cell('file:uploads/burst.tum', 'none', 'position_rmse_m')
      .filter({ hasText: 'e1' })
      .waitFor();
    const beyond = (axis) => page.locator(`.score-page [data-axis=${axis}] .plot-beyond`);
    const expected = ['position_m', 'along_m', 'across_m', 'up_m'];
    for (const [group, axes] of [
      ['errors', expected],
      ['pose', ['x_m', 'y_m', 'z_m']],
      ['path', ['xy', 'xz']],
      ['drift', ['translation_percent']],
    ]) {
      await page.locator(`[data-score-group=${group}]`).click();
      for (const axis of axes) {
        await beyond(axis)
          .filter({ hasText: /^uploads.burst.tum leaves the plot$/ })
          .waitFor();
      }
      await dashboard.screenshot(`score_diverged_${group}_1600x900`);
    }
    await page.locator('[data-score-group=errors]').click();
    await choice('file:uploads/burst.tum').locator('[type=checkbox]').uncheck();
    await beyond('position_m').filter({ hasText: /^$/ }).waitFor({ state: 'attached' });
    await choice('file:uploads/good.tum').locator('[type=checkbox]').uncheck();
    await choice(kKitti).locator('[type=checkbox]').check();
    await page.locator('#score-alignment').selectOption('sim3');
  });

  step('takes a dropped flight log, as an estimate and as the truth', async () => {
    for (const name of [kKitti, kEuroc]) await choice(name).locator('[type=checkbox]').uncheck();
    await drop(['circle.bin', log]);
    await choice(kLog).locator('[type=checkbox]:checked').waitFor();
    // It was flown at another time than the truth.
    await page.locator(`.score-table .bad`).waitFor();
    await choice(kLog).locator('[type=radio]').check();
    await message('Tick the trajectories');
    const file = path.join(folder, 'converted.tum');
    const log_file = path.join(folder, 'circle.bin');
    execFileSync(programFile(), ['log', 'convert', log_file, '--out', file]);
    const bent = readFileSync(file, 'utf8')
      .split('\n')
      .map((line) => {
        const [t, x, y, ...rest] = line.split(' ');
        return rest.length === 5 ? [t, Number(x) * 1.02, Number(y) + 0.3, ...rest].join(' ') : line;
      });
    writeFileSync(path.join(folder, 'bent.tum'), bent.join('\n'));
    await page.locator('[data-role=score-file]').setInputFiles(path.join(folder, 'bent.tum'));
    await cell('file:uploads/bent.tum', 'sim3', 'position_rmse_m').waitFor();
    const [printed] = evaluate('converted.tum', 'bent.tum');
    const shown = await cell('file:uploads/bent.tum', 'sim3', 'position_rmse_m').innerText();
    assert.equal(shown, printed.alignments.sim3.position_rmse_m.toFixed(3));
    await dashboard.screenshot('score_log_1600x900');
  });

  step('deletes an uploaded log', async () => {
    await page.getByLabel('Delete uploads/circle.bin').click();
    await page.getByLabel('Confirm the deletion of uploads/circle.bin').click();
    await choice(kLog).waitFor({ state: 'detached' });
    await message('Choose the truth');
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
