// Takes the pictures of docs/DASHBOARD.md and README.md: flies three short flights, opens each layout
// and page, and saves what it shows. Run by scripts/screenshots.
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { browserMissing } from './support/browser.mjs';
import { flyCourse } from './support/flights.mjs';
import { programFile, serverMissing, sourceFile } from './support/server.mjs';
import { openStage } from './support/stage.mjs';

const kFolder = sourceFile('docs/images');
const kSize = { width: 1600, height: 900 };
const kFlights = [
  { id: '20260101-000001-calm', fields: ['flight.course.airspeed_m_s=15'] },
  { id: '20260101-000002-fast', fields: ['flight.course.airspeed_m_s=25'] },
];
/** A flight whose estimator is lost. */
const kLost = {
  id: '20260101-000000-lost',
  fields: [
    'title=A blackout in the turn',
    'duration_s=8',
    'flight.course.leg_length_m=100',
    'camera.width_px=320',
    'camera.height_px=240',
    'camera.rate_hz=16',
    'camera.sensor.shot_noise=true',
    'camera.sensor.motion_blur=true',
    'faults=[{"kind":"blackout","at_s":4,"duration_s":3}]',
  ],
};
const kDuration_s = 70;
const kInstant_s = 55;

const missing = serverMissing() || browserMissing();
if (missing) throw new Error(missing);

function fly(runs) {
  for (const { id, fields } of kFlights) {
    const all = [...fields, `duration_s=${kDuration_s}`, 'pacing=lockstep'];
    flyCourse(runs, id, all);
  }
  flyCourse(runs, kLost.id, kLost.fields);
  return {};
}

/** A small sweep that shows where an estimator fails. */
function flySweep() {
  const folder = path.join(path.dirname(stage.runs.folder), 'sweeps');
  const file = path.join(path.dirname(folder), 'lens.json');
  mkdirSync(folder, { recursive: true });
  const small = { 'camera.width_px': 320, 'camera.height_px': 240 };
  const sweep = {
    format_version: 1,
    title: 'Noise and defocus',
    description: 'Which images the estimators survive at 25 m/s and 120 m.',
    scenario: sourceFile('scenarios/course.json'),
    set: {
      duration_s: 6,
      'flight.course.height_agl_m': 120,
      'camera.sensor.shot_noise': true,
      ...small,
    },
    axes: [
      {
        path: 'camera.sensor.defocus_sigma_px',
        label: 'Defocus',
        unit: 'px',
        values: [0, 2, 4, 6],
      },
      {
        path: 'camera.sensor.read_noise_e',
        label: 'Read noise',
        unit: 'electrons',
        values: [10, 300, 600, 1200],
      },
    ],
    estimators: [
      { name: 'feature', type: 'feature' },
      { name: 'homography', type: 'baseline_homography' },
    ],
  };
  writeFileSync(file, JSON.stringify(sweep));
  execFileSync(programFile(), ['sweep', file, '--out', path.join(folder, 'lens'), '--quiet']);
}

const [slow, fast] = kFlights.map(({ id }) => id);
const stage = await openStage(kSize, fly);
try {
  const { page } = stage.dashboard;
  const save = async (name) => {
    mkdirSync(kFolder, { recursive: true });
    await page.screenshot({
      path: path.join(kFolder, `${name}.jpg`),
      type: 'jpeg',
      quality: 82,
    });
  };
  const open = async (hash, theme = 'dark') => {
    await page.goto('about:blank');
    await page.emulateMedia({ colorScheme: theme });
    await stage.dashboard.open(`${stage.server.address}#${hash}`);
    await page.locator('.panel[data-frame], [data-panel][data-frame]').first().waitFor();
    await stage.dashboard.until((t_s) => {
      const { frame, tNs } = document.querySelector('[data-panel=timeline]').dataset;
      const panels = [...document.querySelectorAll('[data-panel][data-frame]')];
      return (
        Math.abs(Number(tNs) / 1e9 - t_s) < 0.1 &&
        panels.some(({ dataset }) => dataset.frame === frame)
      );
    }, kInstant_s);
    // Pictures of the last panels, and plots, which are drawn at most 15 times a second.
    await page.waitForTimeout(2000);
  };
  const instant = `t=${kInstant_s}`;
  await open(`layout=fly&run=${fast}&${instant}`);
  await save('dashboard');
  await open(`layout=compare&run=${slow}&run=${fast}&${instant}`);
  await save('dashboard_compare');
  await open(`layout=estimator&run=${fast}&${instant}`, 'light');
  await save('dashboard_estimator');
  await open(`layout=camera&run=${fast}&${instant}`);
  const camera = await page.locator('[data-panel=camera] .picture-view canvas').boundingBox();
  await page.mouse.move(camera.x + camera.width * 0.62, camera.y + camera.height * 0.4);
  await page.locator('.picture-readout span').filter({ hasText: 'range' }).first().waitFor();
  await save('dashboard_camera');
  await open(`layout=camera&run=${slow}&run=${fast}&${instant}`);
  await page.locator('#image-error-of').selectOption('feature');
  await page.waitForTimeout(2000);
  await save('dashboard_pictures');
  const shown = 'show=aircraft,ribbons,labels,errors,frustum,footprint,image';
  await open(`layout=fly&run=${slow}&run=${fast}&view=orbit,250.0,42.0,620&${shown}&${instant}`);
  await page.locator('[data-role=scene-show]').click();
  await save('dashboard_scene');
  await open(`layout=fly&run=${fast}&${instant}`, 'light');
  await page.locator('[data-role=open-scores]').click();
  await page.locator(`[data-trajectory="run:${fast}/truth"] input[type=radio]`).check();
  await page.locator(`[data-trajectory="run:${fast}/feature"] input[type=checkbox]`).check();
  await page.locator('.score-table tr[data-alignment=sim3]').first().waitFor();
  await page.waitForTimeout(1000);
  await save('dashboard_scores');
  await page.keyboard.press('Escape');
  await page.emulateMedia({ colorScheme: 'dark' });
  await page.locator('[data-role=open-calibration]').click();
  await page.locator('#calibration-name').selectOption('camera_faults');
  await page.locator('#calibration-camera').selectOption('oblique');
  await page.locator('#calibration-model').selectOption('equidistant');
  await page.locator('[data-role=begin-calibration]').click();
  await page.locator('[data-parameter=fx]').waitFor({ timeout: 180_000 });
  await page.locator('.residual-column').nth(4).click();
  await page.locator('[data-role=last-view]').filter({ hasText: 'View 5' }).waitFor();
  await page.waitForTimeout(1000);
  await save('dashboard_calibration');
  await page.keyboard.press('Escape');
  await page.locator('[data-role=open-missions]').click();
  await page.locator('[data-role=mission-map][data-world="builtin:1"]').waitFor();
  await page.locator('#mission-open').selectOption('airfield_mission');
  await page.locator('[data-role=profile-readout]').filter({ hasText: 'landing' }).waitFor();
  await page.locator('[data-role=mission-items] .mission-item').nth(2).click();
  await page.waitForTimeout(2000);
  await save('dashboard_missions');
  await page.keyboard.press('Escape');
  flySweep();
  await page.locator('[data-role=open-sweeps]').click();
  await page.locator('.sweep-cell').nth(6).click();
  await page.waitForTimeout(500);
  await save('dashboard_sweeps');
  await page.keyboard.press('Escape');
  await page.locator(`.run[data-run="${kLost.id}"] [data-role=explain]`).click();
  await page.locator('[data-role=start-study]').click();
  await page.locator('[data-role=study-causes]').waitFor({ timeout: 600_000 });
  await page.waitForTimeout(500);
  await save('dashboard_studies');
} finally {
  await stage.close();
}
