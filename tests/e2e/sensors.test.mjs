// The sensors of a flight as plots: while it is flown and in playback, zoomed, at the cursor.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kFlight_s = 12;
const kFlightPatience_ms = 300_000;
const kSensors = {
  imu: {},
  barometer: {},
  gps: {},
  airspeed: {},
  magnetometer: {},
  range: { max_m: 1000 },
};
const kFaults = [{ kind: 'gps_outage', at_s: 5, duration_s: 3 }];
const kPlots = [
  'gyroscope',
  'accelerometer',
  'magnetometer',
  'gps_error',
  'gps_velocity',
  'airspeed',
  'pressure',
  'range',
];

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('the sensors of a flight', { skip, timeout: 600_000 }, () => {
  let stage;
  let run;

  before(async () => {
    stage = await openStage({ width: 1280, height: 800 });
    dashboard = stage.dashboard;
    await dashboard.chooseScenario('course');
  });

  after(() => stage?.close());

  async function typeSection(name, value) {
    await dashboard.page.locator(`[data-section=${name}]`).click();
    await dashboard.page.getByLabel('Section as JSON').fill(JSON.stringify(value));
  }

  const values = (plot) =>
    dashboard.page.evaluate(
      (key) =>
        [...document.querySelectorAll(`[data-axis=${key}] .readout`)].map(({ textContent }) =>
          Number(textContent.replace(/^[A-Za-z]+ /, '').replace('−', '-')),
        ),
      plot,
    );

  step('are plotted while it is flown', async () => {
    await dashboard.page.locator('[data-role=edit-json]').click();
    await dashboard.page.locator('[data-section=sensors]').click();
    await dashboard.page.locator('[data-role=as-json]').click();
    await typeSection('sensors', kSensors);
    await typeSection('faults', kFaults);
    await dashboard.closeEditor();
    await dashboard.field('duration_s').fill(String(kFlight_s));
    await dashboard.page.locator('#field-pacing').selectOption('real_time');
    run = await dashboard.launch();
    await dashboard.page.locator('[data-group=sensors]').click();
    await dashboard.until(
      (plots) => plots.every((plot) => document.querySelector(`[data-axis=${plot}]`) !== null),
      kPlots,
      kFlightPatience_ms,
    );
    await dashboard.until(
      () => /\d/.test(document.querySelector('[data-axis=gyroscope] .readout')?.textContent ?? ''),
      undefined,
      kFlightPatience_ms,
    );
    await dashboard.screenshot('sensors_live');
    await dashboard.untilStatus(run, 'completed', kFlightPatience_ms);
  });

  step('have the values at the cursor', async () => {
    await dashboard.seekAt('.track .bar', 4 / kFlight_s);
    await dashboard.until(() => {
      const text = document.querySelector('[data-axis=pressure] .readout')?.textContent ?? '';
      return Number(text) > 500;
    });
    const [, , down] = await values('accelerometer');
    assert.ok(down < -5 && down > -25, `specific force ${down}`);
    const [airspeed] = await values('airspeed');
    assert.ok(airspeed > 15 && airspeed < 40, `airspeed ${airspeed}`);
    for (const error of await values('gps_error')) assert.ok(Math.abs(error) < 50);
    assert.deepEqual(await dashboard.cutValues(), []);
    await dashboard.screenshot('sensors_1280');
    await dashboard.page.setViewportSize({ width: 1920, height: 1080 });
    await dashboard.screenshot('sensors_1920');
    assert.deepEqual(await dashboard.cutValues(), []);
  });

  step('are missing in an outage, which is marked on the time line', async () => {
    await dashboard.until(() => document.querySelector('.track').dataset.faults === 'gps_outage');
    await dashboard.page.locator('[data-fault-kind=gps_outage]').filter({ hasText: 'GPS outage' }).waitFor();
    await dashboard.seekAt('.track .bar', 7.5 / kFlight_s);
    await dashboard.until(
      () => document.querySelector('[data-axis=gps_velocity] .readout')?.textContent === 'E –',
    );
  });

  step('are read again where the plots are zoomed', async () => {
    const part = dashboard.page.waitForResponse((answer) => answer.url().includes('from_s='));
    const box = await dashboard.page.locator('[data-axis=gyroscope] .u-over').boundingBox();
    await dashboard.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await dashboard.page.mouse.wheel(0, -1200);
    const { sensors } = await (await part).json();
    const imu = sensors.find(({ sensor }) => sensor === 'imu');
    assert.equal(imu.curves[0].values.length, imu.samples, 'every sample of the part');
    const before = (await dashboard.playback()).frame;
    await dashboard.page.mouse.click(box.x + box.width / 4, box.y + box.height / 2);
    await dashboard.until(
      (frame) =>
        document.querySelector('[data-panel=timeline]').dataset.frame !== String(frame),
      before,
    );
    await dashboard.screenshot('sensors_zoomed');
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
