// The main flows in Firefox: a finished flight, its pictures, plots and playback, the pages, the themes;
// and the pictures where the browser has no WebCodecs.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { FirefoxDashboard, firefoxMissing, openFirefox } from './support/firefox.mjs';
import { flyCourse } from './support/flights.mjs';
import { callServer, makeRunsFolder, serverMissing, startServer } from './support/server.mjs';
import { makeStep } from './support/steps.mjs';

const kRun = '20260101-000001-fox';
const kFlight_s = 10;
const kRate_hz = 31;
const kSweep = {
  format_version: 1,
  title: 'Two heights',
  scenario: 'course',
  set: { duration_s: 3, 'camera.width_px': 320, 'camera.height_px': 240 },
  axes: [{ path: 'flight.course.height_agl_m', label: 'Height', unit: 'm', values: [100, 300] }],
  estimators: [{ name: 'feature', type: 'feature' }],
};
const kPages = ['calibration', 'missions', 'sweeps', 'scores'];

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || firefoxMissing();

function fly(runs) {
  flyCourse(runs, kRun, [`duration_s=${kFlight_s}`, 'camera.width_px=640', 'camera.height_px=480']);
}

describe('the dashboard in Firefox', { skip, timeout: 600_000 }, () => {
  const runs = makeRunsFolder();
  let server;
  let browser;
  let page;

  before(async () => {
    fly(runs.folder);
    server = await startServer({ runs: runs.folder });
    browser = await openFirefox({ width: 1280, height: 800 });
    console.log(`tested with ${browser.version}`);
    page = browser.page;
    dashboard = new FirefoxDashboard(page);
  });

  after(async () => {
    await browser?.close();
    await server?.stop();
    runs.remove();
  });

  const text = (selector) => page.$eval(selector, (part) => part.textContent);
  /** Clicks at a share of the width of a part. */
  const clickAt = async (selector, share) => {
    const box = await (await page.$(selector)).boundingBox();
    await page.mouse.click(box.x + box.width * share, box.y + box.height / 2);
  };
  const poses = () =>
    page.evaluate(() => {
      const all = [...document.querySelectorAll('.plot[data-axis=y_m] .readout')];
      return all.map((readout) => readout.textContent);
    });
  /** Pixels of a canvas that are neither transparent nor of its first pixel's colour. */
  const drawnPixels = (selector) =>
    page.$eval(selector, (canvas) => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 0; i < data.length; i += 4) {
        const same = data[i] === data[0] && data[i + 1] === data[1] && data[i + 2] === data[2];
        if (data[i + 3] > 0 && !(same && data[i + 3] === data[3])) count += 1;
      }
      return count;
    });
  const toggle = async (playing) => {
    await page.keyboard.press(' ');
    await dashboard.untilPlaying(playing);
  };
  const play = async () => {
    await page.keyboard.press('Home');
    await dashboard.untilCursor(0);
    await toggle(true);
    // The rate is shown only while pictures move; a busy machine may reach the end of the flight late.
    const badge = '[data-panel=camera] [data-role=rate]';
    await dashboard.until((selector) => document.querySelector(selector).title !== '', badge);
    const rate = await page.$eval(badge, ({ textContent, title }) => ({ textContent, title }));
    await dashboard.untilFrames(['timeline', 'camera', 'scene'], 2 * kRate_hz);
    await toggle(false);
    await dashboard.untilSameInstant();
    return rate;
  };

  step('opens with the token, which leaves the address bar', async () => {
    await dashboard.open(server.address);
    assert.doesNotMatch(page.url(), /token/);
  });

  step('lists the flight and shows it after a click', async () => {
    await page.waitForSelector(`.run[data-run="${kRun}"][data-status=completed]`);
    await page.locator(`.run[data-run="${kRun}"]`).click();
    await dashboard.untilSameInstant();
    assert.equal(await dashboard.runId(), kRun);
    assert.equal(await text('[data-role=status]'), 'completed');
    await dashboard.until(() => document.querySelector('.errors .good, .errors .bad') !== null);
    const { position_rmse_m } = await dashboard.errors();
    assert.match(position_rmse_m[0], /^\d+\.\d{3}$/);
  });

  step('shows the pictures, the 3D view and the curves of the same instant after a seek', async () => {
    const before = await poses();
    await clickAt('.track .bar', 0.5);
    await dashboard.until(() => Number(document.querySelector('[data-panel=timeline]').dataset.frame) > 100);
    await dashboard.untilSameInstant();
    const { frame } = await dashboard.playback();
    assert.ok(Math.abs(frame - (kFlight_s * kRate_hz) / 2) < 12, `frame ${frame}`);
    assert.notDeepEqual(await poses(), before);
    await dashboard.untilPictured('camera');
    await dashboard.untilPictured('scene');
    for (const panel of ['camera', 'scene']) {
      const { deviation } = await dashboard.picture(panel);
      assert.ok(deviation > 5, `${panel}: deviation ${deviation}`);
    }
    const plots = await page.$$eval('.plot canvas', (list) => list.length);
    assert.ok(plots >= 6, `${plots} plots`);
    assert.ok((await drawnPixels('.plot[data-axis=y_m] canvas')) > 500);
    await dashboard.screenshot('firefox_1280x800');
  });

  step('seeks by a click in a plot', async () => {
    await clickAt('.plot[data-axis=y_m] .u-over', 0.8);
    await dashboard.until((low) => Number(document.querySelector('[data-panel=timeline]').dataset.frame) > low, 0.7 * kFlight_s * kRate_hz);
    await dashboard.untilSameInstant();
  });

  step('plays, with video only where it decodes it exactly, and pauses', async () => {
    // Over a plot the mouse would choose the instant that is read out.
    await page.mouse.move(2, 2);
    const before = await poses();
    const { digest } = await dashboard.picture('camera');
    const { textContent, title } = await play();
    assert.match(textContent, /^\d+(\.\d)? Hz/);
    assert.match(title, /Mbit\/s as (VP8 video|JPEG)/);
    console.log(`camera while playing: ${title}`);
    assert.notDeepEqual(await poses(), before);
    assert.notEqual((await dashboard.picture('camera')).digest, digest);
  });

  step('turns the 3D view with the mouse', async () => {
    const { digest } = await dashboard.picture('scene');
    const box = await (await page.$('[data-panel=scene] .panel-body')).boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 120, y + 10, { steps: 4 });
    await page.mouse.up();
    await dashboard.untilPictureDiffers('scene', digest);
    const turned = (await dashboard.picture('scene')).digest;
    await page.mouse.wheel({ deltaY: -300 });
    await dashboard.untilPictureDiffers('scene', turned);
  });

  step('reads out the pixel under the mouse', async () => {
    const box = await (await page.$('[data-panel=camera] canvas.picture')).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await dashboard.until(() => /grey \d+/.test(document.querySelector('[data-panel=camera] .picture-readout')?.textContent ?? ''));
    await page.mouse.move(2, 2);
  });

  for (const name of kPages) {
    step(`opens the page ${name} and closes it`, async () => {
      await page.locator(`[data-role=open-${name}]`).click();
      const panel = name === 'scores' ? 'scoring' : name;
      await page.waitForSelector(`.overlay[data-panel=${panel}]:not([hidden]) h2`);
      // The map comes as pictures.
      if (name === 'missions') await page.waitForNetworkIdle();
      await dashboard.screenshot(`firefox_${name}`);
      const { over, shown } = await page.$eval(`.overlay[data-panel=${panel}]`, (overlay) => ({
        over: overlay.scrollWidth - overlay.clientWidth,
        shown: overlay.textContent.length,
      }));
      assert.ok(over <= 0 && shown > 100, `${over} px too wide, ${shown} letters`);
      await page.locator(`.overlay[data-panel=${panel}] [aria-label=Close]`).click();
      await page.waitForSelector(`.overlay[data-panel=${panel}]`, { hidden: true });
    });
  }

  step('changes the layout and the theme', async () => {
    const back = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await page.select('#theme', 'dark');
    const dark = await back();
    await page.select('#theme', 'light');
    assert.notEqual(await back(), dark);
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('[data-choose-layout=camera]').click();
    await page.waitForSelector('.menu[data-layout=camera]');
    await dashboard.untilSameInstant(['camera', 'depth', 'scene']);
    // The 3D view is drawn again in its new size.
    await dashboard.until(() => {
      const canvas = document.querySelector('[data-panel=scene] canvas.picture');
      return Math.abs(canvas.width - canvas.parentElement.clientWidth) <= 2;
    });
    await dashboard.screenshot('firefox_camera_light');
    // The address is written a few times a second.
    await dashboard.until(() => location.hash.includes('layout=camera'));
    await page.reload();
    await page.waitForSelector('.menu[data-layout=camera]');
    assert.notEqual(await back(), dark);
  });

  step('launches a flight and compares it with the first', async () => {
    await page.goto('about:blank');
    await dashboard.open(`${server.url}/#run=${kRun}&layout=fly&t=1`);
    await dashboard.untilSameInstant();
    await page.waitForSelector('#scenario option[value=course]');
    await page.select('#scenario', 'course');
    await page.waitForSelector('.fields[data-scenario=course]');
    await page.locator('[id="field-duration_s"]').fill('3');
    await page.locator('aria/Launch flight').click();
    await dashboard.until(
      (first) => {
        const runs = [...document.querySelectorAll('.run')].filter((run) => run.dataset.run !== first);
        return runs.some((run) => run.dataset.status === 'completed');
      },
      kRun,
      120_000,
    );
    const flown = await page.$$eval('.run', (runs) => runs.map((run) => run.dataset.run));
    const [launched] = flown.filter((id) => id !== kRun);
    await page.locator(`.run[data-run="${kRun}"] .run-open`).click();
    await dashboard.until((id) => location.hash.includes(id), kRun);
    await page.locator(`.run[data-run="${launched}"] .compare`).click();
    await page.waitForSelector(`[data-shown-run="${launched}"]`);
    await dashboard.until(() => document.querySelectorAll('.errors [data-state-of]').length === 2);
    await dashboard.untilSameInstant();
    await dashboard.screenshot('firefox_compared');
  });

  step('scores a file of its own', async () => {
    const answer = await callServer(server, `/runs/${kRun}/trajectories/truth`);
    assert.equal(answer.status, 200);
    const file = path.join(runs.folder, '../mine.tum');
    writeFileSync(file, await answer.text());
    await page.locator('[data-role=open-scores]').click();
    const input = await page.waitForSelector('[data-role=score-file]');
    await input.uploadFile(file);
    await dashboard.until(() => document.querySelector('.overlay[data-panel=scoring]').textContent.includes('mine.tum'));
    await page.locator('.overlay[data-panel=scoring] [aria-label=Close]').click();
  });

  step('flies a sweep', async () => {
    await page.locator('[data-role=open-sweeps]').click();
    await page.locator('[data-role=new-sweep]').click();
    await dashboard.until(() => document.querySelector('[data-role=sweep-cost]').textContent.includes('cell'));
    await page.locator('[data-role=sweep-name]').fill('fox');
    await page.locator('[data-role=sweep-text]').fill(JSON.stringify(kSweep));
    await dashboard.until(() => document.querySelector('[data-role=sweep-cost]').textContent.startsWith('2 cells'));
    await page.locator('[data-role=start-sweep]').click();
    await dashboard.until(
      () => document.querySelector('[data-role=sweep-state]')?.textContent === 'complete',
      undefined,
      120_000,
    );
    assert.equal(await page.$$eval('.sweep-matrix .sweep-cell', (cells) => cells.length), 2);
    await dashboard.screenshot('firefox_sweep');
    await page.locator('.overlay[data-panel=sweeps] [aria-label=Close]').click();
  });

  step('shows JPEGs where the browser has no WebCodecs', async () => {
    const { identifier } = await page.evaluateOnNewDocument(() => delete globalThis.VideoDecoder);
    await page.goto('about:blank');
    await dashboard.open(`${server.url}/#run=${kRun}&layout=fly&t=1`);
    await dashboard.untilSameInstant();
    const { title } = await play();
    assert.match(title, /Mbit\/s as JPEG/);
    assert.ok((await dashboard.picture('camera')).deviation > 5);
    await page.removeScriptToEvaluateOnNewDocument(identifier);
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
