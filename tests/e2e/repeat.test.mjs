// Flights that wait, that end with a word, and that are flown again with changes.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { callServer, getJson, launchCourse, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kPatience_ms = 300_000;

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('flying again', { skip, timeout: 900_000 }, () => {
  let stage;
  let page;
  let occupying;
  let second;

  before(async () => {
    stage = await openStage({ width: 1280, height: 800 });
    dashboard = stage.dashboard;
    page = dashboard.page;
  });

  after(() => stage?.close());

  const entry = (id) => page.locator(`.run[data-run="${id}"]`);
  const notice = (text) => page.locator('.notices', { hasText: text });

  step('shows the place in the queue and the time that is left', async () => {
    // Longer than any page takes to show the list, and cancelled below.
    occupying = await launchCourse(stage.server, { duration_s: 600 });
    await entry(occupying)
      .filter({ hasText: / · \d+ s left/ })
      .waitFor({ timeout: kPatience_ms });
    await dashboard.chooseScenario('course');
    await dashboard.field('duration_s').fill('2');
    await dashboard.field('flight.course.airspeed_m_s').fill('20');
    await dashboard.field('pacing').selectOption('real_time');
    await dashboard.chooseEstimators('baseline_hold');
    second = await dashboard.launch();
    await entry(second).filter({ hasText: '· next' }).waitFor();
    await dashboard.screenshot('queue_1280x800');
  });

  step('says that a flight is complete', async () => {
    const cancelled = await callServer(stage.server, `/runs/${occupying}/cancel`, {
      method: 'POST',
    });
    assert.equal(cancelled.status, 202);
    await dashboard.untilStatus(second, 'completed', kPatience_ms);
    await notice('The course over the built-in airfield: the flight is complete.').waitFor();
  });

  step('shows what was flown, and flies it with a change', async () => {
    await dashboard.chooseScenario('course');
    await entry(second).locator('[data-role=repeat]').click();
    await page.locator(`.fields[data-repeats="${second}"]`).waitFor();
    assert.equal(await dashboard.field('duration_s').inputValue(), '2');
    assert.equal(await dashboard.field('flight.course.airspeed_m_s').inputValue(), '20');
    assert.equal(await dashboard.field('pacing').inputValue(), 'real_time');
    assert.match(await page.locator('#scenario option:checked').innerText(), /^Again: The course/);
    await dashboard.screenshot('again_1280x800');
    await dashboard.field('flight.course.airspeed_m_s').fill('25');
    const third = await dashboard.launch();
    assert.ok(third !== second && third !== occupying);
    await dashboard.untilStatus(third, 'completed', kPatience_ms);
    const [flown, before] = await Promise.all(
      [third, second].map((id) => getJson(stage.server, `/runs/${id}/scenario`)),
    );
    assert.equal(flown.flight.course.airspeed_m_s, 25);
    flown.flight.course.airspeed_m_s = before.flight.course.airspeed_m_s;
    assert.deepEqual(flown, before);
    assert.deepEqual(flown.estimators.map(({ type }) => type), ['baseline_hold']);
  });

  step("shows the server's limit at the field when a flight is repeated", async () => {
    await dashboard.field('flight.course.airspeed_m_s').fill('999');
    await page.getByRole('button', { name: 'Launch flight' }).click();
    const error = page.locator('[data-error-of="flight.course.airspeed_m_s"]');
    await error.waitFor({ state: 'visible' });
    assert.match(await error.innerText(), /must be/);
    assert.equal((await getJson(stage.server, '/runs')).runs.length, 3);
  });

  step('goes back to the scenario', async () => {
    await page.locator('#scenario').selectOption('course');
    await page.locator('.fields:not([data-repeats])').waitFor();
    assert.equal(await page.locator('#scenario option', { hasText: 'Again' }).count(), 0);
    assert.deepEqual(
      dashboard.complaints.filter((text) => !text.includes('400')),
      [],
    );
  });
});
