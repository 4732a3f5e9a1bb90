// One viewer's session with the real server: launch, watch, pause, seek, change the speed, read
// the error, come back.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { getJson, serverMissing, startServer } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kFlight_s = 20;
const kRate_hz = 31;
// Rendering and estimating in software on two busy cores; a fast machine needs a tenth.
const kFlightPatience_ms = 300_000;
// Debug images are recorded at 5 Hz: one at or before the instant is at most 7 frames old.
const kDebugGap = Math.ceil(kRate_hz / 5);
const kSizes = [
  { width: 1280, height: 800 },
  { width: 1920, height: 1080 },
];

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('the dashboard', { skip, timeout: 900_000 }, () => {
  let stage;
  let run;

  before(async () => {
    stage = await openStage(kSizes[0]);
    dashboard = stage.dashboard;
  });

  after(() => stage?.close());

  step('says what to do when there are no runs', async () => {
    await dashboard.until(() =>
      document.querySelector('[data-panel=runs]').innerText.includes('No runs yet'),
    );
    await dashboard.chooseScenario('course');
    await dashboard.screenshot('empty_1280x800');
  });

  step("shows the server's limit at the field that breaks it", async () => {
    await dashboard.field('flight.course.airspeed_m_s').fill('999');
    await dashboard.page.getByRole('button', { name: 'Launch flight' }).click();
    const error = dashboard.page.locator('[data-error-of="flight.course.airspeed_m_s"]');
    await error.waitFor({ state: 'visible' });
    assert.match(await error.innerText(), /must be/);
    assert.equal((await getJson(stage.server, '/runs')).runs.length, 0);
    await dashboard.field('flight.course.airspeed_m_s').fill('25');
  });

  step('launches a flight and shows it live', async () => {
    await dashboard.field('duration_s').fill(String(kFlight_s));
    await dashboard.chooseEstimators('feature');
    run = await dashboard.launch();
    // The first flight ever over the built-in world has to make that world.
    await dashboard.untilFrames(['scene', 'camera', 'plots'], 5, kFlightPatience_ms);
    assert.ok((await dashboard.picture('camera')).deviation > 5, 'the camera image is empty');
    assert.ok((await dashboard.picture('scene')).deviation > 5, 'the 3D view is empty');
    const seen = await dashboard.frame('camera');
    await dashboard.untilFrames(['camera'], seen + 5);
    await dashboard.screenshot('live_1280x800');
  });

  step('finishes the flight and shows its outcome', async () => {
    await dashboard.untilStatus(run, 'completed', kFlightPatience_ms);
    await dashboard.until(() => document.querySelector('.errors .good, .errors .bad') !== null);
    const { frames } = await getJson(stage.server, `/runs/${run}`);
    assert.ok(Math.abs(frames - kFlight_s * kRate_hz) <= 1, `${frames} frames`);
  });

  step('shows the same instant in every panel after a seek on the time line', async () => {
    await dashboard.seekAt('.track .bar', 0.5);
    const { frame, t_ns } = await dashboard.playback();
    assert.ok(Math.abs(frame - (kFlight_s * kRate_hz) / 2) < 20, `frame ${frame}`);
    assert.equal(t_ns, Math.round((frame * 1e9) / kRate_hz));
    // The debug image arrives after the others.
    await dashboard.until(
      ([low, high]) => {
        const debug = Number(document.querySelector('[data-panel=debug]').dataset.frame);
        return debug > low && debug <= high;
      },
      [frame - kDebugGap - 1, frame],
    );
  });

  step('seeks by a click in a plot', async () => {
    await dashboard.seekAt('.plot[data-axis=y_m] .u-over', 0.8);
    assert.ok(Math.abs((await dashboard.frame('camera')) - kFlight_s * kRate_hz * 0.8) < 20);
    for (const size of kSizes) {
      await dashboard.page.setViewportSize(size);
      await dashboard.untilSameInstant();
    }
  });

  step("shows the truth's and the estimate's pose at the cursor", async () => {
    // Over a plot the mouse would choose the instant that is read out.
    await dashboard.page.mouse.move(1, 1);
    const { frame } = await dashboard.playback();
    const shown = await dashboard.page.locator('.plot[data-axis=y_m] .readout').allInnerTexts();
    for (const [i, name] of ['truth', 'feature'].entries()) {
      const columns = await getJson(stage.server, `/runs/${run}/trajectories/${name}?format=json`);
      const y_m = columns.y_m[columns.frame.indexOf(frame)];
      assert.equal(shown[i].replace('−', '-'), y_m.toFixed(1), name);
    }
  });

  step('steps frame by frame and second by second', async () => {
    const { page } = dashboard;
    const { frame } = await dashboard.playback();
    await page.keyboard.press('ArrowRight');
    await dashboard.untilCursor(frame + 1);
    await page.keyboard.press('ArrowLeft');
    await dashboard.untilCursor(frame);
    await page.locator('button[aria-label^="One frame back"]').click();
    await dashboard.untilCursor(frame - 1);
    await page.keyboard.press('Shift+ArrowLeft');
    await dashboard.untilCursor(frame - 1 - kRate_hz);
    await page.keyboard.press('Home');
    await dashboard.untilCursor(0);
    await dashboard.untilSameInstant();
    await page.keyboard.press('End');
    await dashboard.until(
      () => Number(document.querySelector('[data-panel=timeline]').dataset.frame) > 600,
    );
    await dashboard.untilSameInstant();
  });

  step('plays, changes the speed and pauses', async () => {
    const { page } = dashboard;
    await page.keyboard.press('Home');
    await dashboard.untilCursor(0);
    await page.locator('#speed').selectOption('0.5');
    await dashboard.untilSpeed(0.5);
    await page.keyboard.press('+');
    await page.keyboard.press('+');
    await dashboard.untilSpeed(2);
    await page.keyboard.press('Space');
    await dashboard.untilPlaying(true);
    await dashboard.untilFrames(['timeline', 'camera', 'scene'], 20);
    await page.keyboard.press('Space');
    await dashboard.untilPlaying(false);
    await dashboard.untilSameInstant();
    await page.keyboard.press('-');
    await dashboard.untilSpeed(1);
  });

  step('turns, zooms and switches the 3D view', async () => {
    const { page } = dashboard;
    const changed = async (act) => {
      const { digest } = await dashboard.picture('scene');
      await act();
      const deadline = Date.now() + 30_000;
      while ((await dashboard.picture('scene')).digest === digest) {
        assert.ok(Date.now() < deadline, 'the 3D view stays as it was');
        await page.evaluate(() => new Promise(requestAnimationFrame));
      }
    };
    await changed(() => page.keyboard.press('2'));
    await changed(() => page.keyboard.press('3'));
    await changed(() => page.keyboard.press('f'));
    await changed(() => page.keyboard.press('1'));
    const box = await page.locator('[data-panel=scene] .panel-body').boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await changed(async () => {
      await page.mouse.move(x, y);
      await page.mouse.down();
      await page.mouse.move(x + 120, y + 10, { steps: 4 });
      await page.mouse.up();
    });
    await changed(() => page.mouse.wheel(0, -300));
  });

  step('shows the figures of metrics.json for every alignment', async () => {
    const metrics = await getJson(stage.server, `/runs/${run}/metrics`);
    const { alignments, coverage, dropped_frames, outcome } = metrics.estimators.feature;
    const modes = Object.keys(alignments);
    assert.ok(modes.includes('init_scale'));
    const plain = (text) => text.replace('−', '-');
    const fixed = (value, digits) => (typeof value === 'number' ? value.toFixed(digits) : '–');
    for (const mode of modes) {
      await dashboard.page.locator('#alignment').selectOption(mode);
      const figures = alignments[mode];
      await dashboard.page.locator(`.errors[data-alignment="${mode}"]`).waitFor();
      const rows = await dashboard.errors();
      assert.equal(plain(rows.scale[0]), fixed(figures.scale, 4), mode);
      assert.equal(plain(rows.position_rmse_m[0]), fixed(figures.position_rmse_m, 3), mode);
      assert.equal(
        plain(rows.position_rmse_hold_m[0]),
        fixed(figures.position_rmse_hold_m, 3),
        mode,
      );
      assert.equal(plain(rows.rotation_rmse_deg[0]), fixed(figures.rotation_rmse_deg, 3), mode);
      assert.equal(
        plain(rows.rotation_euler_norm_rmse_deg[0]),
        fixed(figures.rotation_euler_norm_rmse_deg, 3),
        mode,
      );
      assert.equal(rows.coverage[0], `${(coverage * 100).toFixed(1)} %`);
      assert.equal(rows.dropped_frames[0], String(dropped_frames));
      assert.ok(rows.outcome[0].startsWith(outcome));
    }
    await dashboard.page.locator('#alignment').selectOption('init_scale');
  });

  step('fits both screens without scrolling', async () => {
    await dashboard.seekAt('.track .bar', 0.9);
    await dashboard.page.mouse.move(2, 2);
    for (const { width, height } of kSizes) {
      await dashboard.page.setViewportSize({ width, height });
      await dashboard.until(
        ([w, h]) => {
          const canvas = document.querySelector('[data-panel=scene] canvas.picture');
          const body = canvas.parentElement.getBoundingClientRect();
          return (
            window.innerWidth === w &&
            window.innerHeight === h &&
            Math.abs(canvas.width - body.width) <= 2
          );
        },
        [width, height],
      );
      await dashboard.untilSettled();
      await dashboard.untilSameInstant();
      const overflow = await dashboard.page.evaluate(() => {
        const { scrollWidth, scrollHeight } = document.documentElement;
        const outside = [...document.querySelectorAll('.panel, .timeline, .header-bar')].filter(
          (part) => {
            const box = part.getBoundingClientRect();
            return (
              box.right > window.innerWidth + 1 ||
              box.bottom > window.innerHeight + 1 ||
              box.height < 20
            );
          },
        );
        return [scrollWidth - window.innerWidth, scrollHeight - window.innerHeight, outside.length];
      });
      assert.deepEqual(overflow, [0, 0, 0]);
      await dashboard.screenshot(`flight_${width}x${height}`);
    }
    await dashboard.page.setViewportSize(kSizes[0]);
  });

  step('opens the help and closes it', async () => {
    await dashboard.page.keyboard.press('?');
    await dashboard.page.locator('.help').waitFor({ state: 'visible' });
    await dashboard.page.keyboard.press('Escape');
    await dashboard.page.locator('.help').waitFor({ state: 'hidden' });
  });

  step('gives the keyboard to a page over it, and back to what opened the page', async () => {
    const { page } = dashboard;
    const opener = page.locator('[data-role=open-sweeps]');
    const { frame } = await dashboard.playback();
    await opener.focus();
    await page.keyboard.press('Enter');
    await page.locator('.sweep-page:focus').waitFor();
    await page.keyboard.press('ArrowRight');
    for (let i = 0; i < 12; i += 1) {
      await page.keyboard.press('Tab');
      const reached = await page.evaluate(
        () => document.activeElement.closest('.header-bar, .frame, .timeline')?.className,
      );
      assert.equal(reached, undefined);
    }
    await page.keyboard.press('Escape');
    await page.locator('[data-role=open-sweeps]:focus').waitFor();
    assert.equal((await dashboard.playback()).frame, frame);
    await page.keyboard.press('ArrowLeft');
    await dashboard.untilCursor(frame - 1);
    await page.keyboard.press('ArrowRight');
    await dashboard.untilCursor(frame);
  });

  step('shows the same run and instant again from a copied address', async () => {
    const { frame, t_ns } = await dashboard.playback();
    await dashboard.until((t) => location.hash.endsWith(`t=${t / 1e9}`), t_ns);
    await dashboard.page.reload();
    await dashboard.untilCursor(frame);
    await dashboard.untilSameInstant();
    assert.equal(await dashboard.runId(), run);
  });

  step('comes back by itself after the server was away', async () => {
    const { frame } = await dashboard.playback();
    await stage.server.stop();
    await dashboard.until(
      () => document.querySelector('[data-role=connection]').dataset.status === 'waiting',
    );
    const { folder: runs, tokenFile } = stage.runs;
    stage.server = await startServer({ runs, tokenFile, port: stage.server.port });
    await dashboard.until(
      () => document.querySelector('[data-role=connection]').dataset.status === 'open',
    );
    await dashboard.untilCursor(frame);
    await dashboard.page.keyboard.press('ArrowLeft');
    await dashboard.untilCursor(frame - 1);
    await dashboard.untilSameInstant();
  });

  step('stops a running flight in real time and deletes it', async () => {
    // Long enough to fly until it is stopped, on a busy machine too.
    await dashboard.field('duration_s').fill('120');
    await dashboard.field('pacing').selectOption('real_time');
    await dashboard.chooseEstimators();
    const second = await dashboard.launch();
    await dashboard.untilFrames(['camera', 'scene'], 10, 90_000);
    const stop = dashboard.page.locator(
      `.run[data-run="${second}"] button[aria-label="Stop this run"]`,
    );
    await dashboard.untilStatus(second, 'running');
    const untilItFlies = async () => {
      const bar = `.run[data-run="${second}"] .progress i`;
      const before = await dashboard.page.locator(bar).getAttribute('style');
      await dashboard.until(
        ([bar, before]) => document.querySelector(bar).getAttribute('style') !== before,
        [bar, before],
      );
    };
    // The button keeps the focus while the flight goes on, and its place once the list knows what is flown: the stream
    // reports progress before that.
    await stop.focus();
    await dashboard.until((id) => {
      const traits = document.querySelector(`.run[data-run="${id}"] [data-role=flight]`);
      return traits.textContent.includes('m/s');
    }, second);
    await untilItFlies();
    const button = await stop.elementHandle();
    await untilItFlies();
    assert.ok(await button.evaluate((element) => element === document.activeElement));
    await dashboard.screenshot('flying_in_real_time');
    await stop.click();
    await dashboard.untilStatus(second, 'cancelled');
    await dashboard.page
      .locator(`.run[data-run="${second}"] button[aria-label="Delete this run"]`)
      .click();
    await dashboard.page
      .locator(`.run[data-run="${second}"] button[aria-label="Confirm deletion"]`)
      .click();
    await dashboard.until(
      (id) => document.querySelector(`.run[data-run="${id}"]`) === null,
      second,
    );
    const left = (await getJson(stage.server, '/runs')).runs.map(({ id }) => id);
    assert.deepEqual(left, [run]);
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
