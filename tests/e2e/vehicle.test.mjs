// A live vehicle: its state over the 3D view and its modes on the time line, live and in playback.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { programFile, serverMissing, sourceFile } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';
import { freePort } from './support/vehicle.mjs';

const kFlightPatience_ms = 300_000;

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('a live vehicle', { skip, timeout: 900_000 }, () => {
  let stage;
  let vehicle;
  let port;
  let run;

  before(async () => {
    port = await freePort();
    const link = `127.0.0.1:${port}`;
    vehicle = spawn(
      programFile(),
      ['vehicle', '--link', `tcp-listen:${link}`, '--airspeed-m-s', '20', '--speed-up', '2'],
      { stdio: 'ignore' },
    );
    stage = await openStage({ width: 1280, height: 800 }, (runs) => {
      const scenarios = path.join(path.dirname(runs), 'scenarios');
      mkdirSync(scenarios);
      const course = JSON.parse(readFileSync(sourceFile('scenarios/course.json'), 'utf8'));
      const mavlink = {
        link: `tcp:${link}`,
        mission_file: sourceFile('scenarios/missions/airfield_pattern.waypoints'),
        arm_and_start: true,
        geoid_separation_m: 0,
      };
      const live = {
        ...course,
        title: 'A live vehicle',
        flight: { mavlink },
        duration_s: 25,
        camera: { width_px: 320, height_px: 240, rate_hz: 5 },
        estimators: [],
      };
      const other = { ...live, flight: { mavlink: { ...mavlink, link: 'tcp:127.0.0.1:9' } } };
      writeFileSync(path.join(scenarios, 'live.json'), JSON.stringify(live));
      writeFileSync(path.join(scenarios, 'other.json'), JSON.stringify(other));
      const over = { ...live, title: 'A course', flight: course.flight };
      writeFileSync(path.join(scenarios, 'over.json'), JSON.stringify(over));
      const data = [sourceFile('scenarios/missions')];
      return { runs, scenarios, data, links: [`tcp:${link}`], allowCommands: true };
    });
    dashboard = stage.dashboard;
  });

  after(async () => {
    await stage?.close();
    vehicle?.kill();
  });

  const line = (key) => dashboard.page.locator(`[data-vehicle="${key}"]`).innerText();

  step('is refused where the server does not allow its link, with the reason', async () => {
    await dashboard.chooseScenario('other');
    assert.equal(await dashboard.field('flight.mavlink.link').inputValue(), 'tcp:127.0.0.1:9');
    await dashboard.page.getByRole('button', { name: 'Launch flight' }).click();
    const error = dashboard.page.locator('.fields [data-error-of="flight.mavlink.link"]');
    await error.waitFor({ state: 'visible' });
    assert.match(await error.innerText(), /--allow-link/);
  });

  step('shows its state while it flies', async () => {
    await dashboard.chooseScenario('live');
    run = await dashboard.launch();
    await dashboard.until(
      () => document.querySelector('[data-role=vehicle-link]')?.textContent === 'connected',
      undefined,
      kFlightPatience_ms,
    );
    await dashboard.until(() =>
      /[1-9]\d* msg\/s/.test(document.querySelector('[data-vehicle=link]')?.textContent ?? ''),
    );
    // Modes come with heartbeats, once a second.
    await dashboard.until(
      () => document.querySelector('[data-vehicle=mode]').textContent === 'AUTO, armed',
    );
    assert.match(await line('battery'), /^\d+\.\d V, \d+ %$/);
    assert.match(await line('gps'), /^3D fix, \d+ satellites$/);
    assert.match(await line('link'), /0\.0 % lost$/);
    await dashboard.screenshot('vehicle_live_1280x800');
  });

  step('shows the same in playback, with its modes and mission items as bands', async () => {
    await dashboard.untilStatus(run, 'completed', kFlightPatience_ms);
    await dashboard.page.reload();
    await dashboard.until(() => document.querySelector('[data-role=flight-lane] .flight-mode'));
    await dashboard.seekAt('.track .bar', 0.6);
    assert.match(await line('mode'), /^AUTO, armed$/);
    assert.equal(
      await dashboard.page.locator('[data-role=vehicle-link]').innerText(),
      'connected',
    );
    const items = dashboard.page.locator('[data-role=flight-lane] .flight-mission');
    assert.ok((await items.count()) >= 1);
    const box = await dashboard.page.locator('.track .bar').boundingBox();
    await dashboard.page.mouse.move(box.x + box.width * 0.5, box.y + 7);
    const tip = dashboard.page.locator('.track .tip');
    await tip.waitFor({ state: 'visible' });
    assert.match(await tip.innerText(), /AUTO/);
    await dashboard.screenshot('vehicle_replayed_1280x800');
  });

  step('is connected to by its address, over the world of a scenario that flies a course', async () => {
    const { page } = dashboard;
    await dashboard.chooseScenario('over');
    await page.locator('[data-role=open-connect]').click();
    await page.locator('#connect-kind').selectOption('tcp');
    await page.locator('#connect-port').fill('70000');
    const button = page.locator('.connect .primary');
    await button.click();
    const error = page.locator('.connect [data-error-of="flight.mavlink.link"]');
    await error.filter({ hasText: 'from 1 to 65535' }).waitFor();
    await page.locator('#connect-port').fill('9');
    await button.click();
    await error.filter({ hasText: '--allow-link' }).waitFor();
    await dashboard.screenshot('connect_1280x800');
    await page.setViewportSize({ width: 1920, height: 1080 });
    await dashboard.screenshot('connect_1920x1080');
    await page.setViewportSize({ width: 1280, height: 800 });
    await page.locator('#connect-port').fill(String(port));
    await button.click();
    await dashboard.until(() => document.querySelector('[data-panel=connect]').hidden);
    await dashboard.until((before) => {
      const chosen = document.querySelector('.run[aria-current=true]')?.dataset.run;
      return chosen !== undefined && chosen !== before;
    }, run);
    const live = await dashboard.runId();
    await dashboard.until(
      () =>
        Number(document.querySelector('[data-panel=plots]').dataset.frame ?? -1) > 5 &&
        !document.querySelector('[data-panel=vehicle]').hidden &&
        document.querySelector('[data-role=vehicle-link]').textContent === 'connected',
      undefined,
      kFlightPatience_ms,
    );
    assert.match(await line('mode'), /armed$/);
    await dashboard.screenshot('connected_1280x800');
    await page.evaluate(async (id) => {
      await fetch(`api/v1/runs/${id}/cancel`, { method: 'POST' });
    }, live);
    await dashboard.untilStatus(live, 'cancelled');
  });
});
