// A slow line between server and browser: pictures are reduced, clock and read-outs stay near those of
// the server, nothing piles up, and all is as before when the line is fast again.
import assert from 'node:assert/strict';
import { setTimeout as pause } from 'node:timers/promises';
import { after, before, describe } from 'node:test';
import { browserMissing, openBrowser } from './support/browser.mjs';
import { Dashboard } from './support/dashboard.mjs';
import { flyCourse } from './support/flights.mjs';
import { makeRunsFolder, serverMissing, startServer } from './support/server.mjs';
import { openSlowLink } from './support/slow_link.mjs';
import { makeStep } from './support/steps.mjs';

const kRun = '20260101-000001-slow';
const kFlight_s = 60;
const kRate_hz = 31;
const kLimit_bytes_per_s = 100_000;
const kMostDelay_s = 1;
const kWatched_s = 20;
/** The camera's picture in its panel, unless it is reduced. */
const kFullWidth_px = 640;

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

function fly(runs) {
  const fields = [`duration_s=${kFlight_s}`, 'camera.width_px=640', 'camera.height_px=480', 'estimators=[]'];
  flyCourse(runs, kRun, fields);
}

/** The browser's own samples, ten a second: the process of this test may have to wait. */
function watch(began_ms) {
  window.samples = [];
  window.watching = setInterval(() => {
    const { tNs, frame, playing } = document.querySelector('[data-panel=timeline]').dataset;
    if (playing !== 'true') return;
    const camera = document.querySelector('[data-panel=camera]');
    const rate = camera.querySelector('[data-role=rate]');
    const t_s = Number(tNs) / 1e9;
    window.samples.push({
      t_s,
      delay_s: (Date.now() - began_ms) / 1000 - t_s,
      frame: Number(frame),
      readouts: Number(document.querySelector('[data-panel=plots-image]').dataset.frame),
      camera: Number(camera.dataset.frame),
      width_px: camera.querySelector('canvas.picture').width,
      rate: rate.textContent,
      hint: rate.title,
    });
  }, 100);
}

describe('a slow connection', { skip, timeout: 600_000 }, () => {
  const runs = makeRunsFolder();
  let server;
  let link;
  let browser;
  let page;
  let samples;

  before(async () => {
    fly(runs.folder);
    server = await startServer({ runs: runs.folder });
    link = await openSlowLink(server.port);
    browser = await openBrowser({ width: 1600, height: 900 });
    page = browser.page;
    dashboard = new Dashboard(page);
    // As JPEG, pictures need more than twice the data.
    await page.addInitScript(() => delete globalThis.VideoDecoder);
    await dashboard.open(`http://127.0.0.1:${link.port}/?token=${server.token}#layout=camera&run=${kRun}&t=0`);
    await dashboard.untilFrames(['camera', 'scene', 'depth', 'plots-image']);
    await dashboard.untilSameInstant(['camera', 'scene', 'depth']);
  });

  after(async () => {
    await browser?.close();
    await link?.close();
    await server?.stop();
    runs.remove();
  });

  const toggle = async (playing) => {
    await page.keyboard.press(' ');
    await dashboard.untilPlaying(playing);
  };
  const heap_bytes = async () => {
    const session = await page.context().newCDPSession(page);
    await session.send('HeapProfiler.collectGarbage');
    const { usedSize } = await session.send('Runtime.getHeapUsage');
    await session.detach();
    return usedSize;
  };
  /** The largest one, and that which 95 % do not exceed: on a busy machine the page may have to wait. */
  const largest = (values) => {
    const sorted = [...values].sort((a, b) => a - b);
    return { most: sorted.at(-1), usual: sorted[Math.floor(0.95 * sorted.length)] };
  };

  step('reduces the pictures, and shows the measured rate and the reduction', async () => {
    link.limit(kLimit_bytes_per_s);
    await page.evaluate(watch, Date.now());
    const before_bytes = link.passed_bytes();
    await toggle(true);
    await dashboard.until(() => window.samples.some(({ rate }) => /^\d+(\.\d)? Hz ▾[1-4]$/.test(rate)));
    await dashboard.until((t_s) => window.samples.at(-1).t_s > t_s, kWatched_s / 4, 60_000);
    await dashboard.screenshot('slow_link');
    const heap = await heap_bytes();
    await dashboard.until((t_s) => window.samples.at(-1).t_s > t_s, kWatched_s, 60_000);
    samples = await page.evaluate(() => window.samples);
    const { rate, hint } = samples.findLast((sample) => sample.rate.includes('▾'));
    assert.match(hint, /^Measured: .* Mbit\/s as JPEG\. The connection .* reduced \(step \d of 4\)/);
    const passed = (link.passed_bytes() - before_bytes) / samples.at(-1).t_s;
    console.log(`${(passed / 1000).toFixed(0)} kB/s over the line; the camera at the end: ${rate}, ${samples.at(-1).width_px} px wide`);
    assert.ok(samples.some(({ width_px }) => width_px < kFullWidth_px), 'their size is reduced');
    const grown = (await heap_bytes()) - heap;
    console.log(`the page has grown by ${(grown / 1e6).toFixed(1)} MB in ${(kWatched_s * 3) / 4} s`);
    assert.ok(grown < 5e6, `the page keeps ${grown} bytes more`);
  });

  step("keeps clock, read-outs and pictures near the server's clock", () => {
    const behind_s = (panel) => largest(samples.map((sample) => (sample.frame - sample[panel]) / kRate_hz));
    const clock = largest(samples.map(({ delay_s }) => delay_s));
    const readouts = behind_s('readouts');
    const camera = behind_s('camera');
    const words = ({ most, usual }) => `${usual.toFixed(2)} s, at most ${most.toFixed(2)} s`;
    console.log(`the clock is behind the server by ${words(clock)}; behind the clock are read-outs by ${words(readouts)}, the camera by ${words(camera)}`);
    assert.ok(samples.length > (kWatched_s * 10) / 2, `${samples.length} samples`);
    assert.ok(clock.usual < kMostDelay_s && clock.most < 1.5 * kMostDelay_s);
    assert.ok(readouts.most < kMostDelay_s / 4);
    assert.ok(camera.usual < kMostDelay_s && camera.most < 3 * kMostDelay_s);
  });

  step('answers a seek at once, and then shows the whole picture', async () => {
    await toggle(false);
    const began_ms = Date.now();
    await page.keyboard.press('Home');
    await dashboard.untilCursor(0);
    const answered_s = (Date.now() - began_ms) / 1000;
    console.log(`a seek is answered in ${answered_s.toFixed(2)} s`);
    assert.ok(answered_s < 2 * kMostDelay_s);
    await dashboard.untilSameInstant(['camera', 'scene', 'depth']);
    await dashboard.until((px) => document.querySelector('[data-panel=camera] canvas.picture').width === px, kFullWidth_px);
  });

  step('restores the pictures when the line is fast again', async () => {
    link.limit(Infinity);
    // Few pictures, so that a busy processor is not the limit; in full they need more than the slow line has.
    await page.locator('#speed').selectOption('0.1');
    await dashboard.untilSpeed(0.1);
    await page.evaluate(() => (window.samples = []));
    const began_ms = Date.now();
    await toggle(true);
    await dashboard.until((px) => {
      const { rate, width_px } = window.samples.at(-1) ?? { rate: '' };
      return /^\d+(\.\d)? Hz$/.test(rate) && width_px === px;
    }, kFullWidth_px, 120_000);
    console.log(`restored after ${((Date.now() - began_ms) / 1000).toFixed(0)} s`);
    const before_bytes = link.passed_bytes();
    const before_ms = Date.now();
    await pause(4000);
    const bytes_per_s = ((link.passed_bytes() - before_bytes) * 1000) / (Date.now() - before_ms);
    console.log(`${(bytes_per_s / 1000).toFixed(0)} kB/s over the line`);
    assert.ok(bytes_per_s > 1.2 * kLimit_bytes_per_s);
    await toggle(false);
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
