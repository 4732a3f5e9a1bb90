// Two flights compared: added to each other, shown on one clock in every panel, moved against each
// other, saved to files, and opened again by the address alone.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { assertFigures, copyFrom, csvRows } from './support/copied_errors.mjs';
import { flyCourse } from './support/flights.mjs';
import { getJson, programFile, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kFlights = [
  { id: '20260101-000001-slow', airspeed_m_s: 15, duration_s: 6 },
  { id: '20260101-000002-fast', airspeed_m_s: 25, duration_s: 4 },
];
const [kSlow, kFast] = kFlights.map(({ id }) => id);
const kPanels = ['scene', 'camera', 'plots', 'errors'];

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

function fly(runs) {
  for (const { id, airspeed_m_s, duration_s } of kFlights) {
    const fields = [`flight.course.airspeed_m_s=${airspeed_m_s}`, `duration_s=${duration_s}`];
    flyCourse(runs, id, fields);
  }
  return {};
}

describe('two flights compared', { skip, timeout: 600_000 }, () => {
  let stage;
  let page;

  before(async () => {
    stage = await openStage({ width: 1600, height: 900 }, fly);
    dashboard = stage.dashboard;
    page = dashboard.page;
  });

  after(() => stage?.close());

  const shown = () =>
    page.evaluate(() =>
      [...document.querySelectorAll('[data-shown-run]')].map((entry) => ({
        run: entry.dataset.shownRun,
        main: entry.getAttribute('aria-current') === 'true',
        name: entry.querySelector('.shown-title span').textContent,
      })),
    );
  const readouts = (axis) =>
    page.locator(`[data-panel=plots] [data-axis=${axis}] .readout`).allInnerTexts();
  const group = (name) => page.locator(`.tab[data-group=${name}]`).first().click();

  step('adds a run to the one that is shown', async () => {
    await page.locator(`.run[data-run="${kSlow}"] .run-open`).click();
    await dashboard.untilFrames(kPanels);
    await page.locator(`.run[data-run="${kFast}"] .compare`).click();
    await page.locator(`[data-shown-run="${kFast}"]`).waitFor();
    await dashboard.until(() => document.querySelectorAll('.errors thead th').length === 3);
    const runs = await shown();
    assert.deepEqual(
      runs.map(({ run, main }) => [run, main]),
      [
        [kSlow, true],
        [kFast, false],
      ],
    );
    assert.match(runs[0].name, /15 m\/s/);
    assert.match(runs[1].name, /25 m\/s/);
  });

  step('plots both on one clock, with the errors of both', async () => {
    await dashboard.seekAt('.track .bar', 0.5);
    await dashboard.until(
      () => document.querySelectorAll('[data-panel=plots] [data-axis=x_m] .readout').length === 4,
    );
    const values = await readouts('y_m');
    assert.match(values[0], /^A −?\d/);
    assert.match(values[2], /^B −?\d/);
    const y = values.map((text) => Number(text.slice(2).replace('−', '-')));
    assert.ok(Math.abs(y[0] - y[2]) > 20, `after 3 s they are ${y} m north`);
    await group('errors');
    await page.locator('[data-panel=plots] [data-axis=error_m]').waitFor();
    await dashboard.screenshot('compare_errors_1600x900');
    const { position_rmse_m: rmse } = await dashboard.errors();
    for (const [i, id] of [kSlow, kFast].entries()) {
      const file = path.join(stage.runs.folder, id, 'metrics.json');
      const { estimators } = JSON.parse(readFileSync(file, 'utf8'));
      const expected = estimators.feature.alignments.init_scale.position_rmse_m;
      assert.equal(rmse[i], expected.toFixed(3));
    }
  });

  step('copies every figure of both as overfly evaluate prints it', async () => {
    const texts = ['run', 'title', 'estimator', 'outcome', 'outcome_time_s', 'outcome_distance_m', 'relocalisations', 'relocalised_at_s', 'coverage', 'alignment'];
    const csv = await copyFrom(page, '#copy-errors', 'CSV');
    const rows = csvRows(csv);
    let numbers = 0;
    for (const id of [kSlow, kFast]) {
      const folder = path.join(stage.runs.folder, id);
      const answer = execFileSync(programFile(), [
        ...['evaluate', '--run', folder, '--alignment', 'all', '--json'],
      ]);
      const { flight, estimators } = JSON.parse(answer.toString());
      const { alignments, outcome, coverage } = estimators.feature;
      const own = rows.filter(({ run }) => run === id);
      assert.deepEqual(own.map(({ alignment }) => alignment).sort(), Object.keys(alignments));
      for (const row of own) {
        const errors = alignments[row.alignment];
        const percent_of_path = (100 * errors.position_rmse_m) / flight.path_length_m;
        numbers += assertFigures(row, { ...errors, percent_of_path }, texts);
        assert.equal(row.outcome, outcome);
        assert.equal(Number(row.coverage), coverage);
      }
    }
    assert.ok(numbers > 2 * 7 * 6, `${numbers} numbers`);
    const markdown = await copyFrom(page, '#copy-errors', 'Markdown');
    assert.match(markdown, /^\| Run \| Estimator .*\| Horizontal \[m\] \| Vertical \[m\] \| Of the path \[%\] \|/);
    const shown = await dashboard.errors();
    const [first] = markdown.split('\n').filter((line) => line.includes('| init_scale |'));
    for (const key of ['horizontal_rmse_m', 'vertical_rmse_m', 'percent_of_path']) {
      assert.ok(first.includes(` ${shown[key][0]} `), `${key} in ${first}`);
    }
    const latex = await copyFrom(page, '#copy-errors', 'LaTeX');
    assert.match(latex, /^\\begin\{tabular\}\{l{4}r+\}\n.*Of the path \[\\%\].*\\end\{tabular\}\n$/s);
    assert.equal(latex.split('\n').filter((line) => line.includes('&')).length, rows.length + 1);
  });

  step('shows what differs between them', async () => {
    await page.keyboard.press('Control+k');
    await page.locator('#palette-input').fill('differences');
    await page.keyboard.press('Enter');
    await page.locator('.differences tbody tr').first().waitFor();
    const rows = await page.evaluate(() =>
      [...document.querySelectorAll('.differences tbody tr')].map((row) =>
        [...row.children].map((cell) => cell.innerText),
      ),
    );
    const values = new Map(rows.map(([field, ...own]) => [field, own]));
    assert.deepEqual(values.get('scenario.flight.course.airspeed_m_s'), ['15', '25']);
    assert.deepEqual(values.get('scenario.duration_s'), ['6', '4']);
    assert.ok(!values.has('scenario.seed'), 'the same in both');
    await dashboard.screenshot('compare_differences_1600x900');
    await page.locator('.dv-tab', { hasText: /^Errors$/ }).click();
  });

  step('saves a report of both runs as one file', async () => {
    const saved = page.waitForEvent('download');
    await page.locator('[data-role=report]').click();
    const download = await saved;
    assert.equal(download.suggestedFilename(), 'overfly-report-2-runs.html');
    const html = readFileSync(await download.path(), 'utf8');
    assert.match(html, /<section id="differences">/);
    for (const id of [kSlow, kFast]) assert.ok(html.includes(id), `${id} is in the report`);
    assert.equal(html.match(/data:image\/jpeg;base64,/g)?.length, 2, 'each flight has its map');
    await page.locator('.notice', { hasText: 'Saved as overfly-report-2-runs.html' }).waitFor();
  });

  step('orders the runs by their errors', async () => {
    const { runs } = await getJson(stage.server, '/runs');
    const errors = new Map(runs.map(({ id, results }) => [id, results[0].position_rmse_m]));
    const listed = () =>
      page.evaluate(() => [...document.querySelectorAll('.run')].map((run) => run.dataset.run));
    assert.deepEqual(await listed(), [kFast, kSlow], 'newest first');
    const worst = errors.get(kSlow) > errors.get(kFast) ? kSlow : kFast;
    await page.locator('#run-order').selectOption('largest-error');
    assert.equal((await listed())[0], worst);
    await page.locator('#run-order').selectOption('smallest-error');
    assert.equal((await listed())[1], worst);
    await page.locator('#run-order').selectOption('newest');
  });

  step('keeps the focus on a button whose entry is made again', async () => {
    const focus = () => page.evaluate(() => document.activeElement?.ariaLabel);
    const other = await page.locator('.run:not([aria-current=true])').elementHandle();
    const id = await other.getAttribute('data-run');
    const button = (role) => page.locator(`.run[data-run="${id}"] [data-role=${role}]`);
    const label = await button('compare').getAttribute('aria-label');
    await button('compare').focus();
    await page.keyboard.press('Enter');
    await dashboard.until((before) => document.activeElement?.ariaLabel !== before, label);
    assert.equal(await focus(), await button('compare').getAttribute('aria-label'));
    assert.ok(!(await other.evaluate((element) => element.isConnected)), 'it is another entry');
    await page.keyboard.press('Enter');
    await dashboard.until((before) => document.activeElement?.ariaLabel === before, label);
    // Deletion asks on the same button, and gives up by itself.
    await button('delete').focus();
    await page.keyboard.press('Enter');
    await dashboard.until(() => document.activeElement?.ariaLabel === 'Confirm deletion');
    await dashboard.until(() => document.activeElement?.ariaLabel === 'Delete this run');
  });

  step('keeps tags and a note of a run, and finds it by them', async () => {
    await page.locator(`.run[data-run="${kSlow}"] [data-role=edit-notes]`).click();
    await page.locator('.notes-form [data-role=tags]').fill('wind, for the paper');
    await page.locator('.notes-form [data-role=note]').fill('Fly again in the morning.');
    await dashboard.screenshot('compare_notes_1600x900');
    await page.locator('.notes-form [type=submit]').click();
    await page.locator('.run-notes').waitFor({ state: 'hidden' });
    const tag = page.locator(`.run[data-run="${kSlow}"] .tag`);
    await tag.nth(1).waitFor();
    assert.deepEqual(await tag.allInnerTexts(), ['wind', 'for the paper']);
    const kept = readFileSync(path.join(stage.runs.folder, kSlow, 'notes.json'), 'utf8');
    assert.deepEqual(JSON.parse(kept), {
      tags: ['wind', 'for the paper'],
      note: 'Fly again in the morning.',
    });
    await tag.first().click();
    assert.equal(await page.locator('.run').count(), 1);
    await page.locator('#run-search').fill('morning');
    assert.equal(await page.locator('.run').getAttribute('data-run'), kSlow);
    await dashboard.screenshot('compare_tags_1600x900');
    await page.locator('#run-search').fill('');
    await page.locator('.run').nth(1).waitFor();
  });

  step('leaves the form of another run open when notes are saved late', async () => {
    // The answer comes when the test lets it.
    let release;
    const held = new Promise((resolve) => (release = resolve));
    await page.route('**/notes', async (route) => {
      await held;
      await route.continue();
    });
    const edit = (id) => page.locator(`.run[data-run="${id}"] [data-role=edit-notes]`).click();
    const note = page.locator('.notes-form [data-role=note]');
    await edit(kSlow);
    await page.locator('.notes-form [data-role=tags]').fill('wind, for the paper, late');
    await page.locator('.notes-form [type=submit]').click();
    await edit(kFast);
    await note.fill('Typed meanwhile');
    release();
    await page.locator(`.run[data-run="${kSlow}"] .tag`, { hasText: 'late' }).waitFor();
    assert.equal(await note.inputValue(), 'Typed meanwhile');
    await page.unroute('**/notes');
    await page.locator('.notes-form button', { hasText: 'Cancel' }).click();
    await page.locator('.run-notes').waitFor({ state: 'hidden' });
  });

  step('shows how the errors are distributed over the flights', async () => {
    await page.keyboard.press('Control+k');
    await page.locator('#palette-input').fill('repeated flights');
    await page.keyboard.press('Enter');
    await page.locator('[data-flight]').first().waitFor();
    assert.equal(await page.locator('[data-flight]').count(), 1, 'the other flies faster');
    await page.locator('#repeats-choice').selectOption('all');
    const { runs } = await getJson(stage.server, '/runs');
    const errors = new Map(runs.map(({ id, results }) => [id, results[0].position_rmse_m]));
    const drawn = await page.evaluate(() =>
      [...document.querySelectorAll('[data-flight]')].map((dot) => [
        dot.dataset.flight,
        Number(dot.getAttribute('cx')),
      ]),
    );
    const places = new Map(drawn);
    const [left, right] = [errors.get(kSlow), errors.get(kFast)].sort((a, b) => a - b);
    assert.equal(places.size, 2);
    const slowIsBetter = errors.get(kSlow) < errors.get(kFast);
    assert.equal(places.get(kSlow) < places.get(kFast), slowIsBetter, 'errors grow to the right');
    const summary = await page.locator('[data-box=feature] title').textContent();
    const median = ((left + right) / 2).toFixed(3);
    assert.match(summary, new RegExp(`^feature, 2 flights: median ${median} m`));
    await page.locator('#repeats-choice').selectOption('tag:wind');
    assert.equal(await page.locator('[data-flight]').getAttribute('data-flight'), kSlow);
    await page.locator('#repeats-choice').selectOption('all');
    await dashboard.screenshot('compare_repeats_1600x900');
    await page.locator('.dv-tab', { hasText: /^Errors$/ }).click();
  });

  step('hides a track', async () => {
    await group('pose');
    await page.locator(`[data-shown-run="${kFast}"] .track-button`).first().click();
    await dashboard.until(
      () => document.querySelectorAll('[data-panel=plots] [data-axis=x_m] .readout').length === 3,
    );
    await page.locator(`[data-shown-run="${kFast}"] .track-button`).first().click();
  });

  step('moves a run on the clock: it stands at its beginning before its offset', async () => {
    const offset = page.getByLabel('Offset of run B in seconds');
    await offset.fill('4');
    await offset.press('Enter');
    const truth = await getJson(stage.server, `/runs/${kFast}/trajectories/truth?format=json`);
    const begin = `B ${truth.y_m[0].toFixed(1).replace('-', '−')}`;
    await dashboard.seekAt('.track .bar', 0.25);
    // The plots take the offset a moment after the clock.
    await dashboard.until((text) => {
      const axis = document.querySelector('[data-panel=plots] [data-axis=y_m]');
      const shown = [...axis.querySelectorAll('.readout')];
      return shown.length === 4 && shown[2].innerText === text;
    }, begin);
    const early = await readouts('y_m');
    await dashboard.seekAt('.track .bar', 0.35);
    const later = await readouts('y_m');
    assert.notEqual(later[0], early[0], 'run A flies');
    assert.equal(later[2], early[2], 'run B has not begun');
    const end_s = await page.locator('.track').getAttribute('aria-valuemax');
    assert.ok(Number(end_s) > 7.9, `the clock ends at ${end_s} s`);
  });

  step('shows the pictures of the run that is made the main one', async () => {
    await dashboard.untilStill('camera'); // the whole picture follows the preview of the seek above
    const before = (await dashboard.picture('camera')).digest;
    await page.locator(`[data-shown-run="${kFast}"] .shown-title`).click();
    await dashboard.untilPictureDiffers('camera', before);
    assert.deepEqual(
      (await shown()).map(({ main }) => main),
      [false, true],
    );
  });

  step('plays backwards to the beginning of a range', async () => {
    await dashboard.seekAt('.track .bar', 0.6);
    await page.keyboard.press('[');
    await page.locator('[data-role=range]:not([hidden])').waitFor();
    await dashboard.seekAt('.track .bar', 0.9);
    await page.keyboard.press('r');
    await page.keyboard.press(' ');
    await dashboard.untilPlaying(true);
    await dashboard.untilPlaying(false);
    const { t_ns } = await dashboard.playback();
    assert.ok(Math.abs(t_ns / 1e9 - 4.8) < 0.2, `stopped at ${t_ns} ns`);
    await page.keyboard.press('r');
    await page.keyboard.press('\\');
    await page.locator('[data-role=range]').waitFor({ state: 'hidden' });
  });

  step('saves the plots and the errors', async () => {
    const save = async (format) => {
      const [download] = await Promise.all([
        page.waitForEvent('download'),
        page.locator('.dv-groupview:has([data-panel=plots]) .plot-files').selectOption(format),
      ]);
      return readFileSync(await download.path());
    };
    const csv = (await save('csv')).toString();
    assert.match(csv, /^plot,unit,curve,t_s,value\nx_m,m,A truth,0,/);
    const rows = csv.split('\n').filter((line) => line.startsWith('x_m,m,B truth'));
    assert.equal(rows.length, 4 * 31 + 1, 'all frames of run B');
    assert.ok(rows[0].startsWith('x_m,m,B truth,4,'), rows[0]);
    const svg = (await save('svg')).toString();
    assert.match(svg, /^<svg /);
    assert.equal(svg.match(/time \[s\]/g).length, 6);
    const png = await save('png');
    assert.equal(png.subarray(1, 4).toString(), 'PNG');
    assert.ok(png.length > 10_000, `${png.length} bytes`);
  });

  step('opens the same picture from the address alone', async () => {
    await dashboard.seekAt('.track .bar', 0.75);
    const { frame, t_ns } = await dashboard.playback();
    await dashboard.until(
      (t_s) => location.hash.includes('&main=') && location.hash.endsWith(`&t=${t_s}`),
      t_ns / 1e9,
    );
    const before = await readouts('x_m');
    const address = page.url();
    await page.goto('about:blank');
    await dashboard.open(address);
    await dashboard.untilCursor(frame);
    await dashboard.untilSameInstant();
    await dashboard.until(
      () => document.querySelectorAll('[data-panel=plots] [data-axis=x_m] .readout').length === 4,
    );
    assert.deepEqual(await readouts('x_m'), before);
    assert.deepEqual(
      (await shown()).map(({ run, main }) => [run, main]),
      [
        [kSlow, false],
        [kFast, true],
      ],
    );
    await dashboard.screenshot('compare_1600x900');
  });

  step('leaves the comparison', async () => {
    await page.getByLabel('Remove run A from the comparison').click();
    await dashboard.until(() => document.querySelector('[data-shown-run]') === null);
    assert.equal(await dashboard.runId(), kFast);
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
