// A camera calibrated on its page: from a virtual board, a folder, uploads and a live camera; the
// result saved, downloaded and flown.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { startMjpegCamera } from './support/mjpeg_camera.mjs';
import { callServer, getJson, programFile, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kLens = { model: 'radtan', coefficients: [-0.2, 0.05, 0.0005, -0.0004] };
const kCamera = { width_px: 640, height_px: 480, fx_px: 450, fy_px: 449, rate_hz: 8, distortion: kLens };
const kScenario = {
  format_version: 1,
  title: 'A camera with a lens',
  world: { builtin: {} },
  flight: { course: {} },
  duration_s: 1,
  camera: kCamera,
  estimators: [],
};
const kViews = 14;
const kPatience_ms = 120_000;
/** The first ones may be on their way already; then the board has to be held still. */
const kImagesToHold = 5;

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('a camera calibrated on its page', { skip, timeout: 900_000 }, () => {
  let stage;
  let page;
  let camera;
  let photos;

  /** A scenario with the lens, photographs of a board by it, and a camera that may be opened. */
  function prepare(runs) {
    const base = path.dirname(runs);
    const scenarios = path.join(base, 'scenarios');
    photos = path.join(base, 'photos');
    mkdirSync(scenarios);
    const file = path.join(scenarios, 'lens.json');
    writeFileSync(file, JSON.stringify(kScenario));
    const board = ['--board', '9x6', '--square-m', '0.03', '--views', '8', '--quiet'];
    execFileSync(programFile(), ['calibrate', '--scenario', file, ...board, '--save-images', photos]);
    return { scenarios, data: [photos], cameras: [camera.address] };
  }

  before(async () => {
    camera = await startMjpegCamera();
    stage = await openStage({ width: 1600, height: 900 }, prepare);
    dashboard = stage.dashboard;
    page = dashboard.page;
  });

  after(async () => {
    await stage?.close();
    await camera?.stop();
  });

  const role = (name) => page.locator(`.calibration-page [data-role=${name}]`);
  const field = (name) => page.locator(`#calibration-${name}`);
  const cell = async (parameter, column) => {
    const text = await page.locator(`[data-parameter=${parameter}] td`).nth(column).innerText();
    return Number(text.replace('−', '-'));
  };
  const session = async () => (await getJson(stage.server, '/calibration-sessions')).sessions.at(-1);
  const untilSolved = () => role('summary').filter({ hasText: 'RMS' }).waitFor({ timeout: kPatience_ms });
  /** The summary is empty for a moment when another image was taken. */
  const rms = async () => {
    const text = await role('summary').filter({ hasText: 'RMS' }).innerText();
    return Number(/RMS ([\d.]+)/.exec(text)[1]);
  };
  /** Until the server has searched so many more images of an endless source. */
  const untilSearched = async (count) => {
    const { images } = await session();
    const deadline_ms = Date.now() + kPatience_ms;
    while ((await session()).images < images + count) {
      assert.ok(Date.now() < deadline_ms, 'no more images are searched');
      await page.waitForTimeout(100);
    }
  };
  const begin = async (kind) => {
    await field('kind').selectOption(kind);
    const begun = page.waitForResponse(
      (response) =>
        response.request().method() === 'POST' && response.url().endsWith('/calibration-sessions'),
    );
    await role('begin-calibration').click();
    await begun;
  };

  step('refuses a board that looks the same after half a turn, and says why', async () => {
    await page.locator('[data-role=open-calibration]').click();
    await field('cols').fill('7');
    await field('rows').fill('7');
    const reason = page.locator('.calibration-form .calibration-warning');
    await reason.filter({ hasText: 'both numbers are odd' }).waitFor();
    await role('begin-calibration').click();
    await page
      .locator('.calibration-capture .calibration-warning')
      .filter({ hasText: 'half a turn' })
      .waitFor();
    assert.deepEqual(await getJson(stage.server, '/calibration-sessions'), { sessions: [] });
    await field('cols').fill('9');
    await field('rows').fill('6');
    await reason.waitFor({ state: 'hidden' });
  });

  step('calibrates a virtual camera, image by image, and compares with the truth', async () => {
    await field('views').fill(String(kViews));
    await begin('scenario');
    await role('phase').filter({ hasText: `of ${kViews} images` }).waitFor();
    await page.locator('[data-role=newest-image][data-image]:not([data-image=""])').waitFor();
    await untilSolved();
    await dashboard.untilSettled();
    for (const [parameter, truth, limit] of [
      ['fx', 450, 1.5],
      ['cx', 319.5, 1.5],
      ['k1', -0.2, 0.01],
    ]) {
      const error = await cell(parameter, 3);
      assert.equal(await cell(parameter, 2), truth);
      assert.ok(Math.abs(error) < limit, `${parameter}: ${error}`);
    }
    assert.ok((await rms()) < 0.15);
    assert.equal(await page.locator('.coverage-bar').count(), 4);
    await dashboard.screenshot('calibration_1600x900');
  });

  step('shows a view with its residuals, and leaves it out', async () => {
    await page.locator('.residual-column[data-view="2"]').click();
    const view = page.locator('[data-role=last-view]');
    await view.filter({ hasText: 'View 3' }).filter({ hasText: 'residuals' }).waitFor();
    await dashboard.screenshot('calibration_view_1600x900');
    const before = await cell('fx', 0);
    await page.getByLabel('Use view 3').uncheck();
    await role('summary').filter({ hasText: `${kViews - 1} views` }).waitFor();
    assert.notEqual(await cell('fx', 0), before);
    await page.getByLabel('Use view 3').check();
    await role('summary').filter({ hasText: `${kViews} views` }).waitFor();
    assert.equal(await cell('fx', 0), before);
  });

  step('estimates another model from the same views', async () => {
    const radtan = await rms();
    await field('model').selectOption('none');
    await role('estimate').click();
    await page.locator('[data-parameter=k1]').waitFor({ state: 'detached' });
    assert.ok((await rms()) > 3 * radtan);
    await field('model').selectOption('radtan');
    await role('estimate').click();
    await page.locator('[data-parameter=k1]').waitFor();
  });

  step('saves the result and offers it to other programs', async () => {
    await page.locator('#calibration-result-name').fill('front');
    await role('save-calibration').click();
    const saved = page.locator('[data-calibration=front]');
    await saved.waitFor();
    const { fx_px } = await getJson(stage.server, '/calibrations/front');
    for (const [format, text] of [
      ['orb-slam2', 'Camera.fx: '],
      ['dso', 'RadTan '],
      ['svo', 'cam_fx: '],
      ['ros', 'distortion_model: plumb_bob'],
      ['kalibr', 'distortion_model: radtan'],
    ]) {
      const answer = await callServer(stage.server, `/calibrations/front?format=${format}`);
      const content = await answer.text();
      assert.ok(content.includes(text), `${format}: ${content}`);
      // DSO's values are relative to the image's size.
      const focal = format === 'dso' ? fx_px / kCamera.width_px : fx_px;
      assert.ok(content.includes(String(focal).slice(0, 7)), `${format}: ${content}`);
    }
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      saved.locator('select').selectOption('kalibr'),
    ]);
    assert.equal(download.suggestedFilename(), 'front-kalibr.yaml');
    await role('save-calibration').click();
    await page
      .locator('.calibration-capture .calibration-warning')
      .filter({ hasText: 'exists already' })
      .waitFor();
  });

  step('flies with the saved camera', async () => {
    await page.locator('[data-calibration=front]').getByText('Use in next flight').click();
    await page.getByLabel('Close').first().click();
    const run = await dashboard.launch();
    await dashboard.untilStatus(run, 'completed');
    const { cameras } = await getJson(stage.server, `/runs/${run}/manifest`);
    const { fx_px } = await getJson(stage.server, '/calibrations/front');
    assert.equal(cameras[0].fx_px, fx_px);
    await page.locator('[data-role=open-calibration]').click();
  });

  step('calibrates from the images of a folder', async () => {
    await begin('folder');
    await untilSolved();
    assert.equal((await session()).images_total, 8);
    assert.ok((await rms()) < 0.15);
  });

  step('goes on with the session after the page was loaded again', async () => {
    const { id } = await session();
    await dashboard.open(stage.server.url);
    await page.locator('[data-role=open-calibration]').click();
    await untilSolved();
    assert.equal((await session()).id, id);
  });

  step('takes images that are sent, and lists what gives no view', async () => {
    await begin('upload');
    const files = readdirSync(photos).map((name) => path.join(photos, name));
    const text = path.join(path.dirname(photos), 'no_image.png');
    writeFileSync(text, 'no image');
    await role('calibration-file').setInputFiles([...files.slice(0, 5), text]);
    await role('phase').filter({ hasText: '6 images searched, 5 views' }).waitFor();
    assert.match((await session()).without_view[0].reason, /cannot be read/);
    await role('finish').click();
    await untilSolved();
  });

  step('takes useful views of a live camera by itself', async () => {
    const names = readdirSync(photos).sort();
    const jpegs = [];
    // The server's own pictures of the photographs.
    await begin('folder');
    await role('phase').filter({ hasText: '8 of 8 images' }).waitFor({ timeout: kPatience_ms });
    const { id } = await session();
    for (let i = 0; i < names.length; i++) {
      const answer = await callServer(stage.server, `/calibration-sessions/${id}/images/${i}.jpg`);
      jpegs.push(Buffer.from(await answer.arrayBuffer()));
    }
    camera.show(jpegs[0]);
    await begin('camera');
    // The new session has replaced the one of the folder.
    await role('phase').filter({ hasText: 'searched', hasNotText: 'of 8' }).waitFor();
    // Views that are near each other in place, size and tilt add nothing: some of the eight.
    for (const jpeg of jpegs) {
      camera.show(jpeg);
      await untilSearched(kImagesToHold);
    }
    const seen = await session();
    assert.ok(seen.views.length >= 3, `${seen.views.length} views`);
    assert.equal(seen.automatic, true);
    await dashboard.screenshot('calibration_live_1600x900');
    // One that was passed over is taken when it is asked for.
    for (const jpeg of jpegs) {
      if ((await session()).views.length >= seen.views.length + 1) break;
      camera.show(jpeg);
      await untilSearched(kImagesToHold);
      if ((await session()).newest.verdict !== 'nothing new') continue;
      await role('capture').click();
      await untilSearched(kImagesToHold);
    }
    assert.ok((await session()).views.length > seen.views.length);
    assert.equal(camera.viewers(), 1);
    await role('finish').click();
    await role('phase').filter({ hasText: 'no more images' }).waitFor();
    assert.equal(camera.viewers(), 0);
  });

  step('opens no camera that the operator did not allow', async () => {
    const body = {
      source: { kind: 'camera', name: camera.address.replace('video', 'other') },
      board: { cols: 9, rows: 6, square_m: 0.03 },
    };
    const options = { method: 'POST', body: JSON.stringify(body) };
    const answer = await callServer(stage.server, '/calibration-sessions', options);
    assert.equal(answer.status, 404);
    assert.match((await answer.json()).error.message, /--allow-camera/);
    assert.equal(camera.viewers(), 0);
  });

  step('fits a narrow window and the light theme', async () => {
    await page.emulateMedia({ colorScheme: 'light' });
    await page.setViewportSize({ width: 1280, height: 800 });
    await dashboard.screenshot('calibration_light_1280x800');
    await page.setViewportSize({ width: 420, height: 900 });
    await dashboard.screenshot('calibration_420x900');
    const wide = await page.evaluate(
      () => document.querySelector('.calibration-page').scrollWidth > window.innerWidth,
    );
    assert.equal(wide, false);
    await page.setViewportSize({ width: 1600, height: 900 });
  });

  step('closes the calibration and deletes what was saved', async () => {
    await role('end-calibration').click();
    await role('phase').filter({ hasText: 'Choose images' }).waitFor();
    assert.deepEqual(await getJson(stage.server, '/calibration-sessions'), { sessions: [] });
    await page.getByLabel('Delete front').click();
    await page.getByLabel('Confirm the deletion of front').click();
    await page.locator('[data-calibration=front]').waitFor({ state: 'detached' });
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
