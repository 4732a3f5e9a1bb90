// Takes the pictures of docs/DASHBOARD.md and README.md: flies short flights, opens each layout and
// page, and saves what it shows. Run by scripts/screenshots. Arguments are names of pictures; without
// any, all are taken.
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { browserMissing } from './support/browser.mjs';
import { flyCourse } from './support/flights.mjs';
import { dataflashFlight } from './support/log_bytes.mjs';
import { programFile, serverMissing, sourceFile } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { startVehicle } from './support/vehicle.mjs';

const kFolder = sourceFile('docs/images');
const kSize = { width: 1600, height: 900 };
const kFlights = [
  { id: '20260101-000001-calm', fields: ['flight.course.airspeed_m_s=15'] },
  { id: '20260101-000002-fast', fields: ['flight.course.airspeed_m_s=25'] },
];
const kSmall = ['camera.width_px=320', 'camera.height_px=240', 'camera.rate_hz=16'];
/** A flight whose estimator is lost. */
const kLost = {
  id: '20260101-000000-lost',
  fields: [
    'title=A blackout in the turn',
    'duration_s=8',
    'flight.course.leg_length_m=100',
    ...kSmall,
    'camera.sensor.shot_noise=true',
    'camera.sensor.motion_blur=true',
    'faults=[{"kind":"blackout","at_s":4,"duration_s":3}]',
  ],
};
/** The same flight with other noise in each. */
const kRepeats = Array.from({ length: 24 }, (_, i) => ({
  id: `20260102-0000${String(i + 1).padStart(2, '0')}-repeat`,
  fields: [
    'title=A noisy camera',
    'duration_s=8',
    `seed=${i + 1}`,
    'flight.course.height_agl_m=120',
    ...kSmall,
    'camera.sensor.shot_noise=true',
    'camera.sensor.read_noise_e=400',
    'estimators=[{"name":"feature","type":"feature"},{"name":"homography","type":"baseline_homography"}]',
  ],
}));
const kDuration_s = 70;
const kInstant_s = 55;
const kAt = `t=${kInstant_s}`;
const [slow, fast] = kFlights.map(({ id }) => id);

const missing = serverMissing() || browserMissing();
if (missing) throw new Error(missing);

let vehicle;

async function prepare() {
  vehicle = await startVehicle();
  return (runs) => {
    for (const { id, fields } of kFlights) {
      flyCourse(runs, id, [...fields, `duration_s=${kDuration_s}`, 'pacing=lockstep']);
    }
    flyCourse(runs, kLost.id, kLost.fields);
    const logs = path.join(path.dirname(runs), 'recorded');
    mkdirSync(logs);
    writeFileSync(path.join(logs, 'field_test.bin'), dataflashFlight(60));
    return { data: [logs], links: [`tcp:${vehicle.address}`], allowCommands: true };
  };
}

/** A small sweep that shows where an estimator fails. */
function flySweep(runs) {
  const folder = path.join(path.dirname(runs), 'sweeps');
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

const stage = await openStage(kSize, await prepare());
const { page } = stage.dashboard;
const role = (name) => page.locator(`[data-role=${name}]`);
const rest = () => page.waitForTimeout(1000);

/** Opens a link, and waits until the panels show its instant. */
async function open(hash, theme = 'dark') {
  await page.goto('about:blank');
  await page.emulateMedia({ colorScheme: theme });
  await stage.dashboard.open(`${stage.server.address}#${hash}`);
  await page.locator('.panel[data-frame], [data-panel][data-frame]').first().waitFor();
  await stage.dashboard.until((t_s) => {
    const { frame, tNs } = document.querySelector('[data-panel=timeline]').dataset;
    const names = ['scene', 'camera', 'depth', 'image-error', 'plots'];
    const panels = names
      .map((name) => document.querySelector(`[data-panel="${name}"]`))
      .filter((panel) => panel?.checkVisibility());
    return (
      Math.abs(Number(tNs) / 1e9 - t_s) < 0.1 &&
      panels.length > 0 &&
      panels.every(({ dataset }) => dataset.frame === frame)
    );
  }, kInstant_s);
  // Pictures of other runs and in full quality, and plots, which are drawn at most 15 times a second.
  await page.waitForTimeout(2000);
}

async function command(words) {
  await page.keyboard.press('Control+k');
  await page.locator('#palette-input').fill(words);
  await page.keyboard.press('Enter');
}

/** Gives a panel the place of all. */
async function enlarge(panel) {
  await page.locator(`.dv-groupview:has([data-panel="${panel}"]) .enlarge`).click();
  await rest();
}

/** Makes the column of a panel at the right wider. */
async function widen(panel, by_px) {
  const column = page.locator(`.dv-groupview:has([data-panel="${panel}"])`);
  const { x, y, height } = await column.boundingBox();
  await page.mouse.move(x - 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x - by_px, y + height / 2, { steps: 8 });
  await page.mouse.up();
  // Under the mouse the edge is marked.
  await page.mouse.move(1, 1);
  await rest();
}

/** What shows each picture; flights and pages of the later ones are not in the earlier ones. */
const kPictures = {
  dashboard: () => open(`layout=fly&run=${fast}&${kAt}`),
  dashboard_compare: () => open(`layout=compare&run=${slow}&run=${fast}&${kAt}`),
  dashboard_estimator: () => open(`layout=estimator&run=${fast}&${kAt}`, 'light'),
  async dashboard_camera() {
    await open(`layout=camera&run=${fast}&${kAt}`);
    const camera = await page.locator('[data-panel=camera] .picture-view canvas').boundingBox();
    await page.mouse.move(camera.x + camera.width * 0.62, camera.y + camera.height * 0.4);
    await page.locator('.picture-readout span').filter({ hasText: 'range' }).first().waitFor();
  },
  async dashboard_pictures() {
    await open(`layout=camera&run=${slow}&run=${fast}&${kAt}`);
    await page.locator('#image-error-of').selectOption('feature');
    await page.waitForTimeout(2000);
  },
  async dashboard_scene() {
    const shown = 'show=aircraft,ribbons,labels,errors,frustum,footprint,image';
    await open(`layout=fly&run=${slow}&run=${fast}&view=orbit,250.0,42.0,620&${shown}&${kAt}`);
    await role('scene-show').click();
  },
  async dashboard_plot3d() {
    await open(`layout=compare&run=${slow}&run=${fast}&${kAt}`);
    await page.locator('.dv-tab', { hasText: /^3D plot$/ }).click();
    await enlarge('plot3d');
    await page.getByLabel('Exaggeration of heights').selectOption('2');
    await page.locator('[data-panel=plot3d][data-tracks="4"]').waitFor();
    await page.locator('[data-view3d=oblique]').click();
    await rest();
  },
  async dashboard_differences() {
    await open(`layout=compare&run=${fast}&run=${kLost.id}&${kAt}`, 'light');
    await command('differences');
    await page.locator('.differences tbody tr').first().waitFor();
    await widen('differences', 260);
  },
  async dashboard_editor() {
    await open(`layout=fly&run=${fast}&${kAt}`, 'light');
    await stage.dashboard.chooseScenario('camera_faults');
    await role('edit-json').click();
    await page.locator('[data-section=estimators]').click();
    await page.locator('[id="edit-estimators.0.parameters.features"]').fill('1200');
    await page.locator('[id="edit-estimators.0.parameters.scale_factor"]').fill('2.5');
    await page.locator('.row-error:visible').waitFor();
  },
  async dashboard_scores() {
    await open(`layout=fly&run=${fast}&${kAt}`, 'light');
    await role('open-scores').click();
    await page.locator(`[data-trajectory="run:${fast}/truth"] input[type=radio]`).check();
    await page.locator(`[data-trajectory="run:${fast}/feature"] input[type=checkbox]`).check();
    await page.locator('.score-table tr[data-alignment=sim3]').first().waitFor();
    await rest();
  },
  async dashboard_calibration() {
    await open(`layout=fly&run=${fast}&${kAt}`);
    await role('open-calibration').click();
    await page.locator('#calibration-name').selectOption('camera_faults');
    await page.locator('#calibration-camera').selectOption('oblique');
    await page.locator('#calibration-model').selectOption('equidistant');
    await role('begin-calibration').click();
    await page.locator('[data-parameter=fx]').waitFor({ timeout: 180_000 });
    await page.locator('.residual-column').nth(4).click();
    await role('last-view').filter({ hasText: 'View 5' }).waitFor();
    await rest();
  },
  async dashboard_missions() {
    await open(`layout=fly&run=${fast}&${kAt}`);
    await role('open-missions').click();
    await page.locator('[data-role=mission-map][data-world="builtin:1"]').waitFor();
    await page.locator('#mission-open').selectOption('airfield_mission');
    await role('profile-readout').filter({ hasText: 'landing' }).waitFor();
    await page.locator('[data-role=mission-items] .mission-item').nth(2).click();
    await page.waitForTimeout(2000);
  },
  async dashboard_logs() {
    await open(`layout=fly&run=${fast}&${kAt}`);
    await role('open-logs').click();
    // The recorded flight of an autopilot where it is at hand.
    const logs = page.locator('[data-log$="plane25.BIN"], [data-log$="field_test.bin"]');
    await logs.first().locator('.log-choice').click();
    await page.locator('.mode-band[data-mode=AUTO]').first().waitFor();
    await page.locator('[data-log-plot=speed] canvas').waitFor();
    await rest();
    const plot = await page.locator('[data-log-plot=speed] .u-over').boundingBox();
    await page.mouse.move(plot.x + plot.width * 0.62, plot.y + plot.height / 2);
    await rest();
  },
  async dashboard_sweeps() {
    await open(`layout=fly&run=${fast}&${kAt}`);
    flySweep(stage.runs.folder);
    await role('open-sweeps').click();
    await page.locator('.sweep-cell').nth(6).click();
    await rest();
  },
  async dashboard_studies() {
    await open(`layout=fly&run=${fast}&${kAt}`);
    await page.locator(`.run[data-run="${kLost.id}"] [data-role=explain]`).click();
    await role('start-study').click();
    await role('study-causes').waitFor({ timeout: 600_000 });
    await rest();
  },
  async dashboard_repeats() {
    for (const { id, fields } of kRepeats) flyCourse(stage.runs.folder, id, fields);
    await open(`layout=compare&run=${fast}&${kAt}`);
    await page.locator(`.run[data-run="${kRepeats[0].id}"] .run-open`).click();
    const bar = await page.locator('.track .bar').boundingBox();
    await page.mouse.click(bar.x + bar.width * 0.7, bar.y + bar.height / 2);
    await command('repeated flights');
    await page.locator(`[data-flight="${kRepeats.at(-1).id}"]`).first().waitFor();
    await widen('repeats', 220);
    await page.waitForTimeout(2000);
  },
  async dashboard_connect() {
    await open(`layout=fly&run=${fast}&${kAt}`);
    await stage.dashboard.chooseScenario('course');
    await role('open-connect').click();
    await page.locator('#connect-kind').selectOption('tcp');
    await page.locator('#connect-port').fill(vehicle.address.split(':')[1]);
    await rest();
  },
  async dashboard_vehicle() {
    await kPictures.dashboard_connect();
    await vehicle.takeOff();
    await page.locator('.connect .primary').click();
    await stage.dashboard.until(
      () =>
        Number(document.querySelector('[data-panel=plots]')?.dataset.frame ?? -1) > 200 &&
        document.querySelector('[data-role=vehicle-link]')?.textContent === 'connected',
      undefined,
      300_000,
    );
  },
};

try {
  mkdirSync(kFolder, { recursive: true });
  const wanted = process.argv.slice(2);
  const unknown = wanted.find((name) => !(name in kPictures));
  if (unknown !== undefined) {
    throw new Error(`no picture ${unknown}; there are ${Object.keys(kPictures).join(', ')}`);
  }
  for (const [name, show] of Object.entries(kPictures)) {
    if (wanted.length > 0 && !wanted.includes(name)) continue;
    await show();
    const file = path.join(kFolder, `${name}.jpg`);
    await page.screenshot({ path: file, type: 'jpeg', quality: 82 });
  }
} finally {
  await stage.close();
  vehicle.stop();
}
