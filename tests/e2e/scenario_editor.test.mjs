// The scenario editor: every section as a form, errors where they are, flown and saved as changed.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { callServer, getJson, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kPatience_ms = 300_000;
/** Types whose parameters the form knows. */
const kKnown = ['feature', 'baseline_hold', 'baseline_homography', 'perfect', 'drifting'];

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('the scenario editor', { skip, timeout: 900_000 }, () => {
  let stage;
  let page;

  before(async () => {
    stage = await openStage({ width: 1280, height: 800 });
    dashboard = stage.dashboard;
    page = dashboard.page;
    await dashboard.chooseScenario('course');
  });

  after(() => stage?.close());

  const role = (name) => page.locator(`[data-role="${name}"]`);
  const control = (path) => page.locator(`[id="edit-${path}"]`);
  const shows = (path, text) =>
    dashboard.until(
      ([id, wanted]) => document.getElementById(id)?.value === wanted,
      [`edit-${path}`, text],
    );
  const row = (path) => page.locator(`.editor [data-path="${path}"]`).first();
  const section = (name) => page.locator(`[data-section=${name}]`).click();
  const errorOf = (path) => row(path).locator('.row-error').first();
  const checked = () => page.locator('.editor-errors [data-check=done]').waitFor();
  const option = (name) => page.locator(`#scenario option[value="${name}"]`);

  step('shows what the schema says at each field', async () => {
    await role('edit-json').click();
    await page.locator('[data-section=general]:focus').waitFor();
    await page.keyboard.press('Tab');
    await page.keyboard.press('Tab');
    await page.keyboard.press('Enter');
    await page.locator('[data-section=camera]:focus').waitFor();
    await shows('camera.width_px', '1280');
    assert.equal(await page.getByLabel('Width', { exact: true }).inputValue(), '1280');
    assert.equal(await row('camera.width_px').locator('.unit').innerText(), 'px');
    assert.equal(await row('camera.width_px').locator('.row-hint').innerText(), 'in [16, 8192]');
    await shows('camera.fov_axis', 'horizontal');
    await dashboard.screenshot('scenario_editor_1280x800');
  });

  step('names what is wrong at the field, without moving the others', async () => {
    const before = await row('camera.height_px').boundingBox();
    await control('camera.width_px').fill('5');
    await errorOf('camera.width_px').filter({ hasText: 'must be in [16, 8192]' }).waitFor();
    assert.equal(await control('camera.width_px').getAttribute('aria-invalid'), 'true');
    assert.deepEqual(await row('camera.height_px').boundingBox(), before);
    await page.locator('[data-section=camera].faulty').waitFor();
    await control('camera.width_px').fill('three hundred');
    await errorOf('camera.width_px').filter({ hasText: 'must be an integer' }).waitFor();
    await control('camera.width_px').fill('320');
    await checked();
    await errorOf('camera.width_px').waitFor({ state: 'hidden' });
  });

  step("shows what only the server knows to be wrong, at its field", async () => {
    await section('flight');
    await control('flight.course.leg_length_m').fill('5000');
    await errorOf('flight.course.leg_length_m').filter({ hasText: 'length_m = 3300' }).waitFor();
    await dashboard.screenshot('scenario_editor_error');
    await control('flight.course.leg_length_m').fill('1000');
    await checked();
    // A lens may be added, and asks for what it needs.
    await section('camera');
    await role('add-camera.distortion').click();
    await errorOf('camera.distortion.coefficients').filter({ hasText: 'is required' }).waitFor();
    await control('camera.distortion.coefficients').fill('-0.1, 0.02, 0, 0');
    await checked();
  });

  step('says when the server does not answer, and checks what it can', async () => {
    await page.route('**/scenario-check', (route) => route.abort());
    await control('camera.height_px').fill('240');
    await page.locator('[data-check=browser]').waitFor();
    await control('camera.height_px').fill('2');
    await errorOf('camera.height_px').filter({ hasText: 'must be in' }).waitFor();
    await page.unroute('**/scenario-check');
    await control('camera.height_px').fill('240');
    await checked();
  });

  step('adds and removes estimators, and knows the parameters of their types', async () => {
    await section('estimators');
    await control('estimators.0.parameters.features').fill('50');
    await errorOf('estimators.0.parameters.features').filter({ hasText: '[100, 20000]' }).waitFor();
    await control('estimators.0.parameters.features').fill('700');
    await control('estimators.0.parameters.low_texture').uncheck();
    await role('add-estimators').click();
    await shows('estimators.1.name', 'feature_2');
    await control('estimators.1.type').selectOption('drifting');
    await shows('estimators.1.name', 'drifting');
    await control('estimators.1.parameters.drift').fill('0.01');
    await role('add-estimators').click();
    await role('remove-estimators.2').click();
    await control('estimators.2.name').waitFor({ state: 'detached' });
    await checked();
    await dashboard.screenshot('scenario_editor_estimators');
  });

  step('shows the same in the launcher, in both directions', async () => {
    await section('general');
    await control('title').fill('A small camera');
    await control('duration_s').fill('3');
    await dashboard.closeEditor();
    await dashboard.until(() => document.getElementById('field-duration_s').value === '3');
    assert.ok(await page.locator('[data-estimator=drifting]').isChecked());
    await dashboard.field('flight.course.airspeed_m_s').fill('20');
    await role('edit-json').click();
    await section('flight');
    await shows('flight.course.airspeed_m_s', '20');
    await role('as-json').click();
    await dashboard.until(() => document.querySelector('#section-text').value !== '');
    const text = await page.getByLabel('Section as JSON').inputValue();
    assert.equal(JSON.parse(text).course.airspeed_m_s, 20);
    await page.getByLabel('Section as JSON').fill(text.replace('"height_agl_m": 300', '"height_agl_m": 200'));
    await role('as-form').click();
    await shows('flight.course.height_agl_m', '200');
    await checked();
  });

  step('flies what was changed', async () => {
    const before = await dashboard.runId();
    await role('launch-edited').click();
    await dashboard.until((id) => {
      const run = document.querySelector('.run[aria-current=true]')?.dataset.run;
      return run !== undefined && run !== id;
    }, before);
    assert.ok(await page.locator('.editor').isHidden());
    const run = await dashboard.runId();
    await dashboard.untilStatus(run, 'completed', kPatience_ms);
    const manifest = await getJson(stage.server, `/runs/${run}/manifest`);
    const [camera] = manifest.cameras;
    assert.deepEqual([camera.width_px, camera.height_px], [320, 240]);
    assert.equal(camera.distortion.model, 'radtan');
    const [feature, drifting] = manifest.estimators;
    assert.equal(feature.parameters.features, '700');
    assert.equal(feature.parameters.low_texture, 'false');
    assert.equal(drifting.name, 'drifting');
    assert.equal(Number(drifting.parameters.drift), 0.01);
    const flown = await getJson(stage.server, `/runs/${run}/scenario`);
    assert.equal(flown.title, 'A small camera');
    assert.equal(flown.flight.course.airspeed_m_s, 20);
    assert.equal(flown.flight.course.height_agl_m, 200);
  });

  step('refuses names that are none, or that the server has', async () => {
    await role('edit-json').click();
    await page.locator('#save-name').fill('two words');
    await page.getByRole('button', { name: 'Save', exact: true }).click();
    await role('save-note').filter({ hasText: 'letters, digits' }).waitFor();
    await page.locator('#save-name').fill('course');
    await page.getByRole('button', { name: 'Save', exact: true }).click();
    await role('save-note').filter({ hasText: 'scenario of the server' }).waitFor();
  });

  step('saves the scenario, which is then in the list', async () => {
    await page.locator('#save-name').fill('small_camera');
    await page.getByRole('button', { name: 'Save', exact: true }).click();
    await option('small_camera').waitFor({ state: 'attached' });
    await dashboard.until(() => document.querySelector('#scenario').value === 'small_camera');
    const { scenarios } = await getJson(stage.server, '/scenarios');
    const entry = scenarios.find(({ name }) => name === 'small_camera');
    assert.deepEqual([entry.title, entry.saved, entry.error], ['A small camera', true, null]);
    const document = await getJson(stage.server, '/scenarios/small_camera');
    assert.equal(document.camera.width_px, 320);
    assert.equal(document.estimators[0].parameters.features, 700);
  });

  step('asks before it replaces a saved scenario', async () => {
    await section('general');
    await control('seed').fill('9');
    await page.getByRole('button', { name: 'Save', exact: true }).click();
    await role('save-note').filter({ hasText: 'small_camera exists already' }).waitFor();
    assert.equal((await getJson(stage.server, '/scenarios/small_camera')).seed, 1);
    await dashboard.screenshot('scenario_editor_replace');
    await role('replace-scenario').click();
    await page.locator('.notices', { hasText: 'saved as small_camera' }).first().waitFor();
    await dashboard.until(() => document.querySelector('[data-check=none]') !== null);
    assert.equal((await getJson(stage.server, '/scenarios/small_camera')).seed, 9);
  });

  step('deletes a saved scenario when it is asked twice', async () => {
    await role('delete-scenario').click();
    await role('delete-scenario').filter({ hasText: 'Delete?' }).click();
    await option('small_camera').waitFor({ state: 'detached' });
    assert.equal((await callServer(stage.server, '/scenarios/small_camera')).status, 404);
    await page.keyboard.press('Escape');
    await page.locator('.editor').waitFor({ state: 'hidden' });
  });

  step('has the parameters and usual values that the estimators report', async () => {
    await dashboard.chooseScenario('course');
    const estimators = kKnown.map((type) => ({ name: type, type }));
    const body = JSON.stringify({
      scenario: 'course',
      overrides: { estimators, duration_s: 1, 'camera.width_px': 320, 'camera.height_px': 240 },
    });
    const headers = { 'content-type': 'application/json' };
    const answer = await callServer(stage.server, '/runs', { method: 'POST', body, headers });
    const { id } = await answer.json();
    await dashboard.untilStatus(id, 'completed', kPatience_ms);
    const manifest = await getJson(stage.server, `/runs/${id}/manifest`);
    await role('edit-json').click();
    await section('estimators');
    for (const { name, parameters } of manifest.estimators) {
      await control('estimators.0.type').selectOption(name);
      await row('estimators.0.parameters').filter({ hasText: `Parameters of ${name}.` }).waitFor();
      const shown = await page.evaluate(() => {
        const prefix = 'edit-estimators.0.parameters.';
        return Object.fromEntries(
          [...document.querySelectorAll(`[id^="${prefix}"]`)].map((field) => [
            field.id.slice(prefix.length),
            field.type === 'checkbox' ? String(field.checked) : field.placeholder,
          ]),
        );
      });
      assert.deepEqual(new Set(Object.keys(shown)), new Set(Object.keys(parameters ?? {})), name);
      for (const [parameter, usual] of Object.entries(shown)) {
        // Without one, the usual value depends on the flight.
        if (usual !== '') assert.equal(usual, String(parameters[parameter]), `${name} ${parameter}`);
      }
    }
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
