// Studies from the page: why a run failed, where a flight is risky, which flight is the worst.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { flyCourse, kBlackout } from './support/flights.mjs';
import { callServer, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kPatience_ms = 300_000;

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

const kShort = {
  format_version: 1,
  title: 'A short course',
  world: { builtin: { seed: 1 } },
  flight: { course: { height_agl_m: 120, leg_length_m: 100 } },
  duration_s: 4,
  camera: {
    width_px: 320,
    height_px: 240,
    rate_hz: 16,
    sensor: { exposure_ms: 2, read_noise_e: 8 },
  },
  estimators: [{ name: 'feature', type: 'feature' }],
};

describe('studies', { skip, timeout: 900_000 }, () => {
  let stage;
  let page;
  const studies = {};

  before(async () => {
    stage = await openStage({ width: 1280, height: 800 }, (runs) => {
      const scenarios = path.join(path.dirname(runs), 'scenarios');
      mkdirSync(scenarios);
      writeFileSync(path.join(scenarios, 'short.json'), JSON.stringify(kShort));
      flyCourse(runs, 'planted', kBlackout);
      return { scenarios };
    });
    dashboard = stage.dashboard;
    page = dashboard.page;
  });

  after(() => stage?.close());

  const role = (name) => page.locator(`[data-role=${name}]`);
  const state = (text, timeout = kPatience_ms) =>
    page.locator('[data-role=study-state]', { hasText: text }).waitFor({ timeout });
  /** Waits until the study that was started last, by its title, is complete. */
  const done = (title) =>
    page
      .locator('.sweep-title h3', { hasText: title })
      .locator('[data-role=study-state]', { hasText: 'done' })
      .waitFor({ timeout: kPatience_ms });
  const chosen = () =>
    page.locator('.study-page .log-row[aria-current=true] [data-study]').getAttribute('data-study');

  step('says how to begin', async () => {
    await role('open-studies').click();
    await page.locator('[data-role=study-message]', { hasText: 'no studies yet' }).waitFor();
    await dashboard.screenshot('no_studies_1280x800');
    await page.locator('.study-page [aria-label=Close]').click();
  });

  step(
    'offers to explain a run whose estimator failed, in the list and next to its errors',
    async () => {
      await page.locator('.run[data-run=planted] [data-role=explain]').waitFor();
      await role('explain-estimator').first().waitFor();
      await dashboard.screenshot('failed_run_1280x800');
      await role('explain-estimator').first().click();
      await page.locator('.study-form h3', { hasText: 'Explain why' }).waitFor();
      assert.equal(await role('study-run').inputValue(), 'planted');
      assert.equal(await role('study-estimator').inputValue(), 'feature');
      await role('study-flights').fill('99');
      await role('start-study').click();
      await page.locator('[data-role=study-errors]', { hasText: 'must be' }).waitFor();
      await dashboard.screenshot('explain_form_1280x800');
    },
  );

  step('explains it: the planted cause is necessary and sufficient', async () => {
    await role('study-flights').fill('5');
    await role('start-study').click();
    await page.locator('[data-role=study-progress]', { hasText: 'flights' }).waitFor({
      timeout: kPatience_ms,
    });
    await dashboard.screenshot('explain_running_1280x800');
    studies.explain = await chosen();
    await done('Why feature failed');
    const row = page.locator('[data-role=study-causes] tr', { hasText: 'Injected faults' });
    assert.deepEqual((await row.locator('td').allInnerTexts()).slice(0, 2), ['yes', 'yes']);
    assert.match(await role('study-sentences').innerText(), /injected faults/);
    const flights = page.locator('[data-role=study-flights] tbody tr');
    assert.equal(await flights.count(), 5);
    await dashboard.screenshot('explained_1280x800');
    const address = await page.getByRole('link', { name: 'Open as a page' }).getAttribute('href');
    const route = address.slice(address.indexOf('/studies/'));
    const written = await (await callServer(stage.server, route)).text();
    assert.match(written, /<svg/);
    assert.match(written, /Injected faults/i);
  });

  step('opens an evidence flight, and the address opens the study again', async () => {
    const open = page.locator('[data-role=study-flights] [data-run]').first();
    const id = await open.getAttribute('data-run');
    assert.match(id, new RegExp(`^${studies.explain}\\.[0-9a-f]{20}$`));
    await dashboard.until((name) => location.hash.includes(`study=${name}`), studies.explain);
    const address = page.url();
    await open.click();
    await page.locator('.study-page').waitFor({ state: 'hidden' });
    await page.locator('[data-role=status]', { hasText: 'completed' }).waitFor();
    await dashboard.until((run) => location.hash.includes(run), id);
    await page.goto('about:blank');
    await page.goto(address);
    await page.locator('[data-role=study-causes]').waitFor();
    assert.equal(await chosen(), studies.explain);
    await page.locator('.study-page [aria-label=Close]').click();
    await dashboard.until(() => !location.hash.includes('study='));
  });

  step("predicts the launcher's scenario with its changes", async () => {
    await dashboard.chooseScenario('short');
    assert.ok(await page.getByRole('button', { name: 'Launch flight' }).isVisible());
    await dashboard.screenshot('launch_1280x800');
    await dashboard.field('flight.course.airspeed_m_s').fill('28');
    await role('open-predict').click();
    await page
      .locator('[data-role=study-scenario] option:checked', { hasText: 'As in Launch' })
      .waitFor({
        state: 'attached',
      });
    await role('study-map_km').fill('0.6');
    await dashboard.screenshot('predict_form_1280x800');
    await role('start-study').click();
    await done('Risk: A short course');
    studies.predict = await chosen();
    const frame = page.frameLocator('[data-role=study-page]');
    await frame.locator('h1', { hasText: 'Risk: A short course' }).waitFor();
    await frame.locator('svg').first().waitFor();
    assert.equal(await role('study-page').getAttribute('sandbox'), '');
    assert.match(await role('study-sentences').innerText(), /%/);
    await dashboard.screenshot('predicted_1280x800');
  });

  step('hunts within limits, and gives the worst flight', async () => {
    await role('new-hunt').click();
    await page.locator('[data-role=study-axes] tbody tr').nth(1).waitFor();
    await role('axis-1-path').fill('camera.sensor.read_noise_e');
    await role('axis-1-path').press('Tab');
    await dashboard.until(() => document.querySelector('[data-role=axis-1-to]').value === '60');
    // The form was made again: the field after it still has the focus, and what is typed replaces its text.
    const from = await role('axis-1-from').inputValue();
    await page.keyboard.type('150');
    assert.equal(await role('axis-1-from').inputValue(), '150');
    await role('axis-1-from').fill(from);
    await role('study-flights').fill('3');
    await role('study-all').check();
    await dashboard.screenshot('hunt_form_1280x800');
    await role('start-study').click();
    await done('Worst flight: A short course');
    studies.hunt = await chosen();
    const rows = page.locator('[data-role=study-hunted] tbody tr');
    assert.equal(await rows.count(), 3);
    assert.equal(await page.locator('[data-role=study-hunted] tr[aria-current=true]').count(), 1);
    const [saved] = await Promise.all([
      page.waitForEvent('download'),
      role('download-worst').click(),
    ]);
    const scenario = JSON.parse(readFileSync(await saved.path(), 'utf8'));
    assert.equal(scenario.duration_s, 4);
    assert.ok(scenario.flight.course.height_agl_m >= 60);
    await dashboard.screenshot('hunted_1280x800');
    await page.emulateMedia({ colorScheme: 'dark' });
    await dashboard.screenshot('hunted_dark_1280x800');
    await page.locator(`[data-study="${studies.predict}"]`).click();
    await page.frameLocator('[data-role=study-page]').locator('h1').waitFor();
    await dashboard.screenshot('predicted_dark_1280x800');
    await page.locator(`[data-study="${studies.explain}"]`).click();
    await role('study-causes').waitFor();
    await dashboard.screenshot('explained_dark_1280x800');
    await page.emulateMedia({ colorScheme: 'light' });
  });

  step('cancels one that is made, and deletes it', async () => {
    await role('new-hunt').click();
    await page.locator('[data-role=study-axes] tbody tr').nth(1).waitFor();
    await role('start-study').click();
    await state('running');
    await role('cancel-study').click();
    await state('cancelled');
    const gone = await chosen();
    await role('delete-study').click();
    await page.locator('[data-role=delete-study]', { hasText: 'Delete the study?' }).click();
    await page.locator(`[data-study="${gone}"]`).waitFor({ state: 'detached' });
    assert.equal(await page.locator('[data-study]').count(), 3);
  });

  step('fits a phone, and closes with Escape', async () => {
    await page.setViewportSize({ width: 390, height: 844 });
    await page.locator(`[data-study="${studies.hunt}"]`).click();
    await role('study-worst').waitFor();
    await dashboard.screenshot('hunted_390x844');
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    await page.locator(`[data-study="${studies.explain}"]`).click();
    await role('study-causes').waitFor();
    await dashboard.screenshot('explained_390x844');
    await page.keyboard.press('Escape');
    await page.locator('.study-page').waitFor({ state: 'hidden' });
    await page.setViewportSize({ width: 1280, height: 800 });
    await page.keyboard.press('Control+k');
    await page.keyboard.type('hunt the worst');
    await page.keyboard.press('Enter');
    await page.locator('.study-form h3', { hasText: 'Hunt the worst flight' }).waitFor();
    assert.deepEqual(dashboard.complaints, []);
  });
});
