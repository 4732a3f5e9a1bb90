// The pictures of a camera: image, depth, errors and debug image of the same instant, zoomed together,
// with what the pixel under the mouse shows; and those of two runs side by side.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { flyCourse } from './support/flights.mjs';
import { getJson, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kDuration_s = 6;
const kFlights = [
  { id: '20260101-000001-clean', fields: [] },
  { id: '20260101-000002-noisy', fields: ['camera.sensor={"read_noise_e":40,"vignette":[-0.2,0,0]}'] },
];
const [kClean, kNoisy] = kFlights.map(({ id }) => id);
const kOfCamera = ['camera', 'depth', 'image-error'];

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

function fly(runs) {
  for (const { id, fields } of kFlights) {
    flyCourse(runs, id, [`duration_s=${kDuration_s}`, ...fields]);
  }
  return {};
}

describe('pictures of a camera', { skip, timeout: 600_000 }, () => {
  let stage;
  let page;

  before(async () => {
    stage = await openStage({ width: 1600, height: 900 }, fly);
    dashboard = stage.dashboard;
    page = dashboard.page;
  });

  after(() => stage?.close());

  const view = (panel, run = kNoisy) =>
    page.locator(`[data-panel="${panel}"] .picture-view[data-run="${run}"]`);
  /** Left edge and width of a picture, in shares of the place that it has. */
  const placeOf = (panel) =>
    view(panel).evaluate((root) => {
      const area = root.getBoundingClientRect();
      const { left, width } = root.querySelector('canvas').getBoundingClientRect();
      return [(left - area.left) / area.width, width / area.width];
    });
  const moveTo = async (panel, x, y) => {
    const box = await view(panel).locator('canvas').boundingBox();
    await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
  };
  const readout = (panel, part) =>
    view(panel).locator('.picture-readout span').filter({ hasText: part }).innerText();

  step('shows image, depth and error of the same frame', async () => {
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.address}#layout=camera&run=${kNoisy}&t=4`);
    await dashboard.untilSameInstant(['scene', ...kOfCamera]);
    for (const panel of kOfCamera) {
      await dashboard.untilPictured(panel);
    }
    const legend = await view('depth').locator('.colour-legend').innerText();
    assert.match(legend, /Depth \[m\]/);
    const ticks = await view('depth').locator('.legend-ticks span').allInnerTexts();
    assert.ok(ticks.length >= 2 && ticks.every((text) => Number(text) >= 100), ticks.join(' '));
    assert.match(await view('image-error').locator('.colour-legend').innerText(), /grey levels/);
  });

  step('reads out the pixel under the mouse, and marks it in the other pictures', async () => {
    await moveTo('camera', 0.25, 0.75);
    await view('camera').locator('.picture-readout span').filter({ hasText: 'range' }).waitFor();
    const { frame } = await dashboard.playback();
    const shown = await readout('camera', 'px');
    const [, x_px, y_px] = /x ([\d.]+) +y ([\d.]+) px/.exec(shown);
    assert.ok(Math.abs(x_px - 0.25 * 1280) < 4 && Math.abs(y_px - 0.75 * 960) < 4, shown);
    const query = `x_px=${x_px}&y_px=${y_px}`;
    const pixel = await getJson(stage.server, `/runs/${kNoisy}/frames/${frame}/pixel?${query}`);
    assert.equal(await readout('camera', 'grey'), `grey ${pixel.grey}`);
    const [lat, lon] = (await readout('camera', '°')).match(/[\d.]+/g).map(Number);
    assert.ok(Math.abs(lat - Math.abs(pixel.ground.lat_deg)) < 2e-6, `latitude ${lat}`);
    assert.ok(Math.abs(lon - Math.abs(pixel.ground.lon_deg)) < 2e-6, `longitude ${lon}`);
    assert.equal(await readout('camera', 'height'), `height ${pixel.ground.alt_ellipsoid_m.toFixed(1)} m`);
    for (const panel of kOfCamera) {
      const at = await view(panel).evaluate((root) => {
        const canvas = root.querySelector('canvas').getBoundingClientRect();
        const cross = root.querySelector('.picture-cross').getBoundingClientRect();
        return [
          (cross.left + cross.width / 2 - canvas.left) / canvas.width,
          (cross.top + cross.height / 2 - canvas.top) / canvas.height,
        ];
      });
      assert.ok(Math.abs(at[0] - 0.25) < 0.01 && Math.abs(at[1] - 0.75) < 0.01, `${panel}: ${at}`);
    }
    await moveTo('image-error', 0.5, 0.5);
    await view('image-error').locator('.picture-readout span').filter({ hasText: 'difference' }).waitFor();
    await dashboard.screenshot('pictures_pixel');
  });

  step('zooms all pictures of the camera with the wheel, moves them by dragging', async () => {
    await moveTo('camera', 0.3, 0.4);
    await page.mouse.wheel(0, -800);
    await dashboard.until(() => document.querySelectorAll('.picture-view.zoomed').length >= 3);
    const zoomed = await placeOf('camera');
    assert.ok(zoomed[1] > 2, `width ${zoomed[1]}`);
    // The whole image has twice the pixels of the one that fitted the panel.
    await dashboard.until(
      () => document.querySelector('[data-panel=camera] canvas').width === 1280,
    );
    await moveTo('camera', 0.3, 0.4);
    await page.mouse.down();
    const box = await view('camera').boundingBox();
    await page.mouse.move(box.x + box.width * 0.1, box.y + box.height * 0.5, { steps: 5 });
    await page.mouse.up();
    assert.notEqual((await placeOf('camera'))[0], zoomed[0]);
    const scales = await Promise.all(
      kOfCamera.map(async (panel) => {
        const [, width] = await placeOf(panel);
        return width;
      }),
    );
    // The panels have different shapes, but the same magnification of the fitted picture.
    assert.ok(scales.every((scale) => scale > 1), scales.join(' '));
    await dashboard.screenshot('pictures_zoomed');
    await view('depth').dblclick();
    await dashboard.until(() => document.querySelector('.picture-view.zoomed') === null);
  });

  step('zooms and moves by the keyboard, without steering the playback', async () => {
    const { t_ns } = await dashboard.playback();
    await view('camera').focus();
    for (const key of ['+', '+', '+', 'ArrowRight']) await page.keyboard.press(key);
    await dashboard.until(() => document.querySelector('.picture-view.zoomed') !== null);
    const [left] = await placeOf('camera');
    await page.keyboard.press('ArrowLeft');
    // It is drawn in the next frame of the page.
    for (const late = Date.now() + 10_000; (await placeOf('camera'))[0] <= left; ) {
      assert.ok(Date.now() < late, `the picture stays at ${left}`);
    }
    await page.keyboard.press('0');
    await dashboard.until(() => document.querySelector('.picture-view.zoomed') === null);
    assert.equal((await dashboard.playback()).t_ns, t_ns);
    // After a click into it the keys are for the playback again.
    const { frame } = await dashboard.playback();
    await view('camera').click();
    await page.keyboard.press('ArrowRight');
    await dashboard.untilCursor(frame + 1);
    await page.keyboard.press('ArrowLeft');
    await dashboard.untilCursor(frame);
  });

  step("shows how far off an estimate's view is", async () => {
    const before = (await dashboard.picture('image-error')).digest;
    await page.locator('#image-error-of').selectOption('feature');
    // The picture may change before: the one of the whole image comes after the zoom has ended.
    await view('image-error').locator('.colour-legend').filter({ hasText: 'Estimate − truth' }).waitFor();
    await dashboard.untilPictureDiffers('image-error', before);
  });

  step('shows two runs side by side at the same instant of the clock', async () => {
    await page.goto('about:blank');
    await dashboard.open(
      `${stage.server.address}#layout=camera&run=${kClean}&run=${kNoisy}@0.5&t=4`,
    );
    await dashboard.until(
      ([clean, noisy]) => {
        const frame = (run) =>
          document.querySelector(`[data-panel=camera] .picture-view[data-run="${run}"]`)?.dataset
            .frame;
        return frame(clean) === '124' && frame(noisy) === '108';
      },
      [kClean, kNoisy],
    );
    const titles = await page.locator('[data-panel=camera] .picture-title').allInnerTexts();
    assert.deepEqual(titles, ['A', 'B']);
    const boxes = await page.locator('[data-panel=camera] .picture-view').all();
    const [a, b] = await Promise.all(boxes.map((box) => box.boundingBox()));
    assert.ok(a.x + a.width <= b.x && a.y === b.y, 'side by side');
    await dashboard.screenshot('pictures_two_runs');
    await page.locator('[data-panel=camera]').page().locator('[data-role=side-by-side]').first().click();
    await dashboard.until(
      () => document.querySelectorAll('[data-panel=camera] .picture-view').length === 1,
    );
  });

  step('asks only for the pictures of panels on the screen', async () => {
    const asked = [];
    page.on('websocket', (socket) =>
      socket.on('framesent', ({ payload }) => {
        const message = JSON.parse(payload);
        if (message.type === 'subscribe') asked.push(message.pictures.map(({ name }) => name).sort());
      }),
    );
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.address}#layout=fly&run=${kNoisy}&t=4`);
    await dashboard.untilSameInstant();
    assert.deepEqual(asked.at(-1), ['camera', 'debug/feature', 'scene']);
    const hide = (title) => page.getByLabel(`Hide ${title}`).click();
    await hide('Camera');
    await hide('Estimator');
    await dashboard.until(() => document.querySelector('[data-panel=camera]') === null);
    await page.evaluate(() => new Promise(requestAnimationFrame));
    assert.deepEqual(asked.at(-1), ['scene']);
    // The enlarged panel hides all others.
    await page.locator('.group-actions .enlarge').last().click();
    await dashboard.until(() => document.querySelector('.enlarge[aria-pressed=true]') !== null);
    await page.evaluate(() => new Promise(requestAnimationFrame));
    assert.deepEqual(asked.at(-1), []);
    await page.keyboard.press('Escape');
    await dashboard.until(() => document.querySelector('.enlarge[aria-pressed=true]') === null);
    await dashboard.until(
      () => document.querySelector('[data-panel=scene] canvas.picture') !== null,
    );
    assert.deepEqual(asked.at(-1), ['scene']);
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
