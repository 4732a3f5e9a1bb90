// How long the dashboard takes to appear: the first contentful paint, and until the first run is
// listed and shown. Every round has a new browser, whose cache is empty.
// Needs the packages of tests/e2e.
//
// Usage: node tests/bench/first_paint.mjs [ROUNDS]
import { performance } from 'node:perf_hooks';
import { openBrowser } from '../e2e/support/browser.mjs';
import { flyPair } from '../e2e/support/flights.mjs';
import { makeRunsFolder, startServer } from '../e2e/support/server.mjs';

const kRounds = Number(process.argv[2] ?? 10);
const kMarks = {
  'first contentful paint': () => performance.getEntriesByName('first-contentful-paint').length > 0,
  'first run listed': () => document.querySelector('.run') !== null,
  'values at its plots': () => /\d/.test(document.querySelector('[data-panel=plots] .readout')?.textContent),
  'its camera image': () => document.querySelector('[data-panel=camera][data-frame]') !== null,
};

/** Milliseconds since the navigation began, by what happened. */
async function round(server) {
  const browser = await openBrowser({ width: 1600, height: 900 });
  try {
    const { page } = browser;
    await page.addInitScript((marks) => {
      const conditions = Object.entries(marks).map(([name, text]) => [name, (0, eval)(`(${text})`)]);
      window.reached = {};
      const look = () => {
        for (const [name, holds] of conditions) {
          if (!(name in window.reached) && document.body !== null && holds()) {
            window.reached[name] = performance.now();
          }
        }
        if (Object.keys(window.reached).length < conditions.length) requestAnimationFrame(look);
      };
      look();
    }, Object.fromEntries(Object.entries(kMarks).map(([name, holds]) => [name, String(holds)])));
    // The token is exchanged for a cookie by a redirect, which is part of the first visit.
    await page.goto(server.address);
    await page.waitForFunction((count) => Object.keys(window.reached).length === count, Object.keys(kMarks).length);
    const times = await page.evaluate(() => ({
      ...window.reached,
      'first contentful paint': performance.getEntriesByName('first-contentful-paint')[0].startTime,
    }));
    return times;
  } finally {
    await browser.close();
  }
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length % 2 === 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

const runs = makeRunsFolder();
flyPair(runs.folder);
const server = await startServer({ runs: runs.folder, tokenFile: runs.tokenFile });
try {
  const rounds = [];
  const begin_ms = performance.now();
  for (let i = 0; i < kRounds; i += 1) rounds.push(await round(server));
  console.log(`${kRounds} rounds in ${((performance.now() - begin_ms) / 1000).toFixed(0)} s`);
  for (const name of Object.keys(kMarks)) {
    const times = rounds.map((one) => one[name]);
    const [middle, worst] = [median(times), Math.max(...times)].map((ms) => ms.toFixed(0));
    console.log(`${name.padEnd(24)} median ${middle.padStart(5)} ms   worst ${worst.padStart(5)} ms`);
  }
} finally {
  await server.stop();
  runs.remove();
}
