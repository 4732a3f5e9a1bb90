// Measures how long the dashboard takes from a click on the time line to the correct pictures: a run of ten
// minutes with three estimators, headless Chromium on the server's machine. Needs the packages of tests/e2e.
//
// Usage: node tests/bench/seek_time.mjs [--runs FOLDER] [--seeks N] [--rounds N] [--pause-ms MS] [--record]
//   --runs FOLDER  keeps the flown run here, or uses the one that is here
//   --rounds N     seeks the same instants N times: the median of the slowest instant tells whether an instant is slow
//                  in general, the longest seek whether any seek was
//   --pause-ms MS  between the pictures of one seek and the click of the next; 0 clicks while the server still
//                  draws the pictures of the last seek in full
//   --record       flies with recorded images, so that the camera's picture is read instead of rendered
import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { openBrowser } from '../e2e/support/browser.mjs';
import { Dashboard } from '../e2e/support/dashboard.mjs';
import { flyCourse } from '../e2e/support/flights.mjs';
import { makeRunsFolder, startServer } from '../e2e/support/server.mjs';

const kDuration_s = 600;
const kFirstLook_ms = 5000;
const kLength_m = 3300; // of the course
const kLong_ms = 150; // longer seeks are printed one by one
const kPanels = ['timeline', 'camera', 'scene'];

const { values: options } = parseArgs({
  options: {
    runs: { type: 'string' },
    seeks: { type: 'string', default: '60' },
    rounds: { type: 'string', default: '1' },
    'pause-ms': { type: 'string', default: '700' },
    record: { type: 'boolean', default: false },
  },
});

/** Numbers in [0, 1) that are the same in every call (Park and Miller 1988). */
function randoms(seed) {
  let state = seed;
  return () => (state = (state * 16807) % 2147483647) / 2147483647;
}

function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}

/** Processor time that the virtual machine's host has taken away, of all processors [ms] (proc_stat(5), `steal`). */
function stolen_ms() {
  const cpu = readFileSync('/proc/stat', 'utf8').split('\n')[0].split(/\s+/);
  return 10 * Number(cpu[8]);
}

function fly(runs) {
  const id = options.record ? '20260101-000002-recorded' : '20260101-000001-rendered';
  if (existsSync(path.join(runs, id))) return id;
  const drifting = (name, drift) => ({ name, type: 'drifting', parameters: { drift } });
  flyCourse(runs, id, [
    `duration_s=${kDuration_s}`,
    `flight.course.airspeed_m_s=${kLength_m / kDuration_s}`,
    `estimators=${JSON.stringify([0.01, 0.02, 0.03].map((drift, i) => drifting(`estimator_${i + 1}`, drift)))}`,
    ...(options.record ? ['recording={"frames":true}'] : []),
  ]);
  return id;
}

/** Clicks on the time line. @return milliseconds until each panel shows the new frame */
async function seek(page, share) {
  const line = page.locator('.track .bar').first();
  const box = await line.boundingBox();
  await page.evaluate((panels) => {
    const frameOf = (name) => document.querySelector(`[data-panel="${name}"]`).dataset.frame;
    const before = frameOf('timeline');
    const clicked = new Promise((resolve) =>
      addEventListener('pointerdown', () => resolve(performance.now()), {
        once: true,
        capture: true,
      }),
    );
    globalThis.arrived = clicked.then(
      (clicked_ms) =>
        new Promise((resolve) => {
          const found = {};
          const look = () => {
            const frame = frameOf('timeline');
            for (const name of panels) {
              if (frame !== before && found[name] === undefined && frameOf(name) === frame) {
                found[name] = performance.now() - clicked_ms;
              }
            }
            if (Object.keys(found).length === panels.length) resolve(found);
            else requestAnimationFrame(look);
          };
          look();
        }),
    );
  }, kPanels);
  await page.mouse.click(box.x + box.width * share, box.y + box.height / 2);
  return page.evaluate(() => globalThis.arrived);
}

const temporary = makeRunsFolder();
const folder = options.runs ? path.resolve(options.runs) : temporary.folder;
mkdirSync(folder, { recursive: true });
const id = fly(folder);
const server = await startServer({ runs: folder, tokenFile: temporary.tokenFile });
const browser = await openBrowser({ width: 1280, height: 800 });
try {
  const dashboard = new Dashboard(browser.page);
  await dashboard.open(`${server.address}#layout=fly&run=${id}&t=10`);
  await dashboard.untilSameInstant(['scene', 'camera']);
  // As somebody who looks at the page first: meanwhile the server reads the ground below the flight.
  await browser.page.waitForTimeout(kFirstLook_ms);
  const random = randoms(1);
  const shares = Array.from({ length: Number(options.seeks) }, () => 0.02 + 0.96 * random());
  const times = shares.map(() => []); // by instant, then by round
  for (let round = 0; round < Number(options.rounds); ++round) {
    for (const [i, share] of shares.entries()) {
      const before_ms = stolen_ms();
      const time = await seek(browser.page, share);
      times[i].push(time);
      if (Math.max(...Object.values(time)) > kLong_ms) {
        const texts = kPanels.map((name) => `${name} ${time[name].toFixed(0)} ms`).join(', ');
        console.log(`seek ${i + 1}: ${texts}; stolen by the host: ${stolen_ms() - before_ms} ms`);
      }
      await dashboard.untilSameInstant(['scene', 'camera']);
      await browser.page.waitForTimeout(Number(options['pause-ms']));
    }
  }
  for (const name of kPanels) {
    const all = times.flat().map((time) => time[name]);
    const instants = times.map((rounds) =>
      quantile(
        rounds.map((time) => time[name]),
        0.5,
      ),
    );
    const figures = [
      quantile(all, 0.5),
      quantile(all, 0.95),
      Math.max(...all),
      Math.max(...instants),
    ];
    const [median, p95, most, slowest] = figures.map((value) => `${value.toFixed(0)} ms`);
    console.log(
      `${name}: median ${median}, 95 % ${p95}, longest ${most}; median of the slowest instant ${slowest}`,
    );
  }
} finally {
  await browser.close();
  await server.stop();
  temporary.remove();
}
