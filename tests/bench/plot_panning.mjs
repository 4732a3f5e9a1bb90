// Measures how smoothly the plots over time are panned: four runs of ten minutes with four estimators each, so that
// every plot has 20 curves of 20 000 points, headless Chromium. Needs the packages of tests/e2e.
//
// Usage: node tests/bench/plot_panning.mjs [--runs FOLDER] [--seconds S] [--rounds N] [--count RUNS] [--zoom NOTCHES] [--group NAME]
//   --runs FOLDER   keeps the flown runs here, or uses those that are here
//   --seconds S     pans for so long in each round
//   --count RUNS    shows so many: a run adds five curves to each plot
//   --zoom NOTCHES  of the wheel before panning: 5 show about half of the flight
//   --group NAME    of the panel's tabs: pose (6 plots), errors, estimates
import { cpSync, existsSync, mkdirSync, readFileSync } from 'node:fs';
import { setTimeout as pause } from 'node:timers/promises';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { openBrowser } from '../e2e/support/browser.mjs';
import { Dashboard } from '../e2e/support/dashboard.mjs';
import { flyCourse } from '../e2e/support/flights.mjs';
import { makeRunsFolder, startServer } from '../e2e/support/server.mjs';

const kFrames = 20_000;
const kDuration_s = kFrames / 31;
const kLength_m = 3300; // of the course
const kEstimators = 4;
const kNotch_px = 100;
const kMove_ms = 12; // between two movements of the mouse
const kStroke = 0.6; // the mouse goes over this share of a plot's width, and back

const { values: options } = parseArgs({
  options: {
    runs: { type: 'string' },
    seconds: { type: 'string', default: '6' },
    rounds: { type: 'string', default: '3' },
    count: { type: 'string', default: '4' },
    zoom: { type: 'string', default: '5' },
    group: { type: 'string', default: 'pose' },
  },
});

function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}

/** Programs that ran or waited for a processor over the last minute. */
function load() {
  return readFileSync('/proc/loadavg', 'utf8').split(' ')[0];
}

/** One flight, stored under several names. */
function fly(runs) {
  const ids = Array.from({ length: Number(options.count) }, (_, i) => `20260101-00000${i + 1}-long`);
  const [first] = ids;
  const estimators = Array.from({ length: kEstimators }, (_, i) => ({
    name: `estimator_${i + 1}`,
    type: 'drifting',
    parameters: { drift: 0.005 * (i + 1) },
  }));
  if (!existsSync(path.join(runs, first))) {
    flyCourse(runs, first, [
      `duration_s=${kDuration_s}`,
      `flight.course.airspeed_m_s=${kLength_m / kDuration_s}`,
      'camera.width_px=64',
      'camera.height_px=48',
      `estimators=${JSON.stringify(estimators)}`,
    ]);
  }
  for (const id of ids.slice(1)) {
    if (!existsSync(path.join(runs, id))) cpSync(path.join(runs, first), path.join(runs, id), { recursive: true });
  }
  return ids;
}

/** Counts the rows of poses that the page receives. */
function countRows(page) {
  const counted = { rows: 0 };
  page.on('websocket', (socket) =>
    socket.on('framereceived', ({ payload }) => {
      if (typeof payload !== 'string' || !payload.includes('"rows"')) return;
      const { type, columns } = JSON.parse(payload);
      if (type === 'rows' && columns.x_m !== undefined) counted.rows += columns.t_ns.length;
    }),
  );
  return counted;
}

/** Opens the plots alone on the page, and waits for all points. @return number of plots */
async function openPlots(dashboard, server, ids) {
  const { page } = dashboard;
  const counted = countRows(page);
  await dashboard.open(`${server.address}#layout=fly&${ids.map((id) => `run=${id}`).join('&')}&t=300`);
  await dashboard.untilFrames(['plots']);
  while (counted.rows < ids.length * (1 + kEstimators) * kFrames) await pause(200);
  await dashboard.untilSettled();
  await page.locator('.dv-groupview:has([data-panel=plots]) .enlarge').click();
  await page.locator(`.tab[data-group=${options.group}]`).first().click();
  await dashboard.untilSettled();
  console.log(`${counted.rows} poses received`);
  return page.locator('[data-panel=plots] .plot').count();
}

/**
 * Drags with Shift, to and fro. @return number of animation frames, milliseconds from frame to frame of those that show
 * another part of the flight, and seconds that the page's main thread computed
 */
async function pan(page, box, seconds) {
  const stroke_px = kStroke * box.width;
  const [left, y] = [box.x + (box.width - stroke_px) / 2, box.y + box.height / 2];
  await page.mouse.move(left, y);
  await page.keyboard.down('Shift');
  await page.mouse.down();
  await page.evaluate(() => {
    const part = document.querySelector('[data-role=plotted]');
    const found = { all: 0, frames_ms: [] };
    globalThis.panning = found;
    let before_ms = performance.now();
    let place = part.style.left;
    const look = (now_ms) => {
      if (globalThis.panning !== found) return;
      found.all += 1;
      // A frame without a new picture is no measure of how long one takes.
      if (part.style.left !== place) found.frames_ms.push(now_ms - before_ms);
      place = part.style.left;
      before_ms = now_ms;
      requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
  const client = await page.context().newCDPSession(page);
  await client.send('Performance.enable');
  const processor_s = async () => {
    const { metrics } = await client.send('Performance.getMetrics');
    return metrics.find(({ name }) => name === 'TaskDuration').value;
  };
  const begin_s = await processor_s();
  const sent = [];
  const begin_ms = performance.now();
  for (let i = 0; performance.now() - begin_ms < 1000 * seconds; i += 1) {
    const phase = ((performance.now() - begin_ms) / 1500) % 2;
    // Not awaited: a slow page gets the next movement anyway.
    sent.push(page.mouse.move(left + stroke_px * (phase < 1 ? phase : 2 - phase), y));
    await pause(kMove_ms);
  }
  await Promise.all(sent);
  const task_s = (await processor_s()) - begin_s;
  await client.detach();
  const found = await page.evaluate(() => {
    const { panning } = globalThis;
    globalThis.panning = null;
    return panning;
  });
  await page.mouse.up();
  await page.keyboard.up('Shift');
  return { ...found, task_s };
}

const temporary = makeRunsFolder();
const folder = options.runs ? path.resolve(options.runs) : temporary.folder;
mkdirSync(folder, { recursive: true });
const ids = fly(folder);
const server = await startServer({ runs: folder, tokenFile: temporary.tokenFile });
const browser = await openBrowser({ width: 1280, height: 800 });
try {
  const { page } = browser;
  const plots = await openPlots(new Dashboard(page), server, ids);
  console.log(`${plots} plots of ${ids.length * (1 + kEstimators)} curves`);
  const box = await page.locator('[data-panel=plots] .u-over').first().boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  for (let i = 0; i < Number(options.zoom); i += 1) await page.mouse.wheel(0, -kNotch_px);
  await page.locator('[data-role=plotted]:not([hidden])').waitFor({ state: 'attached' });
  for (let round = 1; round <= Number(options.rounds); round += 1) {
    const { all, frames_ms, task_s } = await pan(page, box, Number(options.seconds));
    const figures = [quantile(frames_ms, 0.5), quantile(frames_ms, 0.95), Math.max(...frames_ms)];
    const [median, p95, longest] = figures.map((value) => `${value.toFixed(1)} ms`);
    console.log(
      `round ${round}: ${frames_ms.length} of ${all} frames moved; median ${median}, 95 % ${p95}, longest ${longest}; ` +
        `main thread ${((1000 * task_s) / frames_ms.length).toFixed(1)} ms for each; load ${load()}`,
    );
  }
} finally {
  await browser.close();
  await server.stop();
  temporary.remove();
}
