// A mission drawn on the map: edited with mouse and keyboard, checked, saved, exported, imported, flown.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { programFile, serverMissing, sourceFile } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('missions drawn on the map', { skip, timeout: 900_000 }, () => {
  let stage;
  let page;
  let folder;

  before(async () => {
    stage = await openStage({ width: 1600, height: 900 });
    dashboard = stage.dashboard;
    page = dashboard.page;
    folder = path.dirname(stage.runs.folder);
  });

  after(() => stage?.close());

  const rows = () => page.locator('[data-role=mission-items] li');
  const titles = () => rows().locator('.mission-item-title').allInnerTexts();
  const checks = page_ => page_.locator('[data-role=mission-checks]');
  /** Waits until the report is that of the mission as it is. */
  const reported = () =>
    dashboard.until(
      () =>
        document.querySelector('[data-role=mission-map]:not(.outdated)') !== null &&
        document.querySelector('[data-role=profile-readout]')?.textContent !== '',
    );
  const clickMap = async (x, y) => {
    const box = await page.locator('[data-role=mission-map]').boundingBox();
    await page.mouse.click(box.x + box.width * x, box.y + box.height * y);
  };
  const marker = (number) => page.locator('.mission-marker', { hasText: new RegExp(`^${number}$`) });
  const field = (id) => page.locator(`#${id}`);
  /** The page is drawn once a frame. */
  const untilValue = (id, value) =>
    dashboard.until(([name, text]) => document.getElementById(name)?.value === text, [id, value]);
  /** For values that are read once, after a change that nothing else shows. */
  const drawn = () =>
    page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const untilItems = (count) =>
    dashboard.until(
      (n) => document.querySelectorAll('[data-role=mission-items] li').length === n,
      count,
    );

  step('opens the world with its imagery', async () => {
    await page.locator('[data-role=open-missions]').click();
    const make = page.getByRole('button', { name: 'Make it now' });
    const map = page.locator('[data-role=mission-map][data-world="builtin:1"]');
    await make.or(map).first().waitFor();
    if (await make.isVisible()) await make.click();
    await map.waitFor({ timeout: 300_000 });
    await dashboard.until(() => {
      const tiles = [...document.querySelectorAll('.leaflet-tile-loaded')];
      return tiles.length > 0 && tiles.every(({ naturalWidth }) => naturalWidth === 256);
    });
    await rows().first().waitFor({ state: 'detached' });
  });

  step('places items by clicks', async () => {
    await page.locator('[data-tool=take-off]').click();
    await clickMap(0.5, 0.5);
    await clickMap(0.5, 0.3);
    await clickMap(0.62, 0.3);
    await clickMap(0.62, 0.6);
    await page.locator('[data-tool=circle]').click();
    await clickMap(0.5, 0.7);
    await page.keyboard.press('v');
    await page.locator('[data-tool=select][aria-pressed=true]').waitFor();
    await untilItems(5);
    assert.deepEqual(await titles(), ['Take-off', 'Waypoint', 'Waypoint', 'Waypoint', 'Circle, turns']);
    await reported();
    const summary = await page.locator('[data-role=profile-readout]').innerText();
    assert.match(summary, /km, \d+ min/);
    assert.match(summary, /straight and level from/);
  });

  step('edits an item in its fields, and undoes it', async () => {
    await rows().nth(1).locator('.mission-item').click();
    // The fields of the item chosen before have the same ids and, here, the same height.
    await page.getByText('2 · Waypoint', { exact: true }).waitFor();
    await untilValue('item-param-6', '300');
    await field('item-param-6').fill('20');
    await checks(page).getByText('Height above the ground below 50 m').waitFor();
    await reported();
    await page.locator('[data-role=mission-undo]').click();
    await untilValue('item-param-6', '300');
    await page.locator('[data-role=mission-redo]').click();
    await untilValue('item-param-6', '20');
    await page.locator('[data-role=mission-undo]').click();
    await checks(page).getByText('Height above the ground below 50 m').waitFor({ state: 'detached' });
    await field('item-param-6').fill('99999');
    await page.locator('#item-param-6-error', { hasText: 'must be in [-1000, 20000]' }).waitFor();
    await field('item-param-6').blur();
    await untilValue('item-param-6', '300');
  });

  step('warns of a circle that needs too much bank', async () => {
    await rows().nth(4).locator('.mission-item').click();
    await page.getByText('5 · Circle, turns', { exact: true }).waitFor();
    await field('item-radius').fill('40');
    await checks(page).getByText(/^5\d° in the turn of item 5$/).waitFor();
    await page.locator('.mission-marker.warned', { hasText: '5' }).waitFor();
    await field('item-radius').fill('150');
    await checks(page).getByText(/in the turn of item 5$/).waitFor({ state: 'detached' });
    assert.match(await page.locator('[data-role=item-info]').innerText(), /turn with 23° of bank/);
  });

  step('drags, nudges, inserts and deletes items', async () => {
    const box = await marker(3).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + 90, box.y - 20, { steps: 6 });
    await page.mouse.up();
    assert.match(await page.locator('.mission-form h3').innerText(), /^3 · Waypoint/);
    await drawn();
    await reported();
    const dragged = Number(await field('item-lon').inputValue());
    await page.keyboard.press('ArrowRight');
    await dashboard.until((before) => Number(document.querySelector('#item-lon').value) !== before, dragged);
    const nudged = Number(await field('item-lon').inputValue());
    const metres = (nudged - dragged) * 111_195 * Math.cos((39.35 * Math.PI) / 180);
    assert.ok(Math.abs(metres - 10) < 0.1, `${metres} m`);
    await page.locator('.mission-handle').nth(1).click();
    await untilItems(6);
    await page.keyboard.press('Delete');
    await untilItems(5);
    for (let i = 0; i < 3; i += 1) await page.keyboard.press('Control+z');
    await rows().nth(2).locator('.mission-item').click();
    await untilValue('item-lon', String(dragged));
    await page.keyboard.press('Control+y');
    await untilValue('item-lon', String(nudged));
    await reported();
  });

  step('takes no keys while another page lies over it', async () => {
    await rows().nth(1).locator('.mission-item').click();
    await page.keyboard.press('Control+k');
    await page.locator('#palette-input').fill('score trajectories');
    await page.keyboard.press('Enter');
    await page.locator('.log-overlay[data-panel=scoring]').waitFor();
    await page.evaluate(() => document.activeElement.blur());
    const count = await rows().count();
    await page.keyboard.press('Delete');
    await drawn();
    assert.equal(await rows().count(), count);
    await page.keyboard.press('Escape');
    await page.locator('.log-overlay[data-panel=scoring]').waitFor({ state: 'hidden' });
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press('Delete');
    await untilItems(count - 1);
    await page.keyboard.press('Control+z');
    await untilItems(count);
  });

  step('counts a height from elsewhere and leaves the item where it is', async () => {
    await drawn();
    await reported();
    const before = await page.locator('[data-role=item-info]').innerText();
    await field('item-frame').selectOption({ label: 'above home' });
    await dashboard.until(() => document.querySelector('#item-param-6').value !== '300');
    await reported();
    assert.equal((await page.locator('[data-role=item-info]').innerText()).split(' · ')[0], before.split(' · ')[0]);
    await page.keyboard.press('Control+z');
  });

  step('shows the values under the mouse, on the map too', async () => {
    const canvas = await page.locator('.mission-profile-canvas').boundingBox();
    await page.mouse.move(canvas.x + canvas.width / 2, canvas.y + 30);
    await page.locator('[data-role=profile-readout]', { hasText: 'above ground' }).waitFor();
    const map = await page.locator('[data-role=mission-map]').boundingBox();
    await page.mouse.move(map.x + map.width * 0.45, map.y + map.height * 0.5);
    await page.locator('[data-role=ground-readout]', { hasText: /ground \d+\.\d m/ }).waitFor();
    await dashboard.screenshot('missions_1600x900');
  });

  step('saves the mission as a scenario, and leaves the map as it is', async () => {
    const scale = page.locator('.leaflet-control-scale-line');
    const whole = await scale.innerText();
    await page.locator('.leaflet-control-zoom-in').click();
    await dashboard.until(
      (before) => document.querySelector('.leaflet-control-scale-line').textContent !== before,
      whole,
    );
    const nearer = await scale.innerText();
    await field('mission-title').fill('Round the farm');
    await page.locator('[data-role=mission-save]').press('Enter');
    await page.locator('[data-role=mission-save]', { hasText: 'Saved' }).waitFor();
    await drawn();
    assert.equal(await scale.innerText(), nearer);
    assert.ok(existsSync(path.join(folder, 'saved/round_the_farm.json')));
    await page.locator('#mission-open option[value=round_the_farm]').waitFor({ state: 'attached' });
  });

  step('is flown by overfly run', () => {
    const file = path.join(folder, 'saved/round_the_farm.json');
    const out = path.join(folder, 'flown');
    const fields = ['--set', 'duration_s=2', '--set', 'estimators=[]', '--set', 'camera.rate_hz=5'];
    execFileSync(programFile(), ['run', file, '--out', out, '--quiet', ...fields]);
    const manifest = JSON.parse(readFileSync(path.join(out, 'manifest.json'), 'utf8'));
    assert.match(manifest.flight.description, /^mission, /);
  });

  const exported = async (format) => {
    const download = page.waitForEvent('download');
    await page.locator('[data-role=mission-export]').selectOption(format);
    const file = await download;
    return { name: file.suggestedFilename(), text: readFileSync(await file.path(), 'utf8') };
  };
  const imported = (name, text) => {
    const file = path.join(folder, name);
    writeFileSync(file, text);
    return page.locator('[data-role=mission-file]').setInputFiles(file);
  };

  step('exports and imports both formats without a change', async () => {
    const plan = await exported('plan');
    assert.equal(plan.name, 'round_the_farm.plan');
    const lines = await exported('waypoints');
    assert.equal(lines.name, 'round_the_farm.waypoints');
    assert.match(lines.text, /^QGC WPL 110\n/);
    for (const file of [lines, plan]) {
      await imported(file.name, file.text);
      await page.locator('[data-role=mission-notes]', { hasText: `${file.name}: 5 items.` }).waitFor();
      assert.equal((await exported('waypoints')).text, lines.text);
    }
    assert.equal((await exported('plan')).text, plan.text);
    // A mission file of a scenario, too.
    const scenario = sourceFile('scenarios/airfield_mission.json');
    const file = path.join(folder, plan.name);
    const more = ['--set', `flight.mission.file=${file}`, '--set', 'duration_s=1', '--set', 'estimators=[]'];
    execFileSync(programFile(), ['run', scenario, '--out', path.join(folder, 'plan'), '--quiet', ...more]);
  });

  step('keeps what it does not fly, and says so', async () => {
    const { text } = await exported('plan');
    const plan = JSON.parse(text);
    const unknown = {
      type: 'SimpleItem',
      command: 206,
      frame: 2,
      params: [25, 0, 1, 0, 0, 0, 0],
      autoContinue: true,
      doJumpId: 6,
    };
    plan.mission.items.push(unknown);
    plan.geoFence.polygons.push({ inclusion: true, polygon: [], version: 1 });
    await imported('survey.plan', JSON.stringify(plan));
    const notes = page.locator('[data-role=mission-notes]');
    await notes.filter({ hasText: 'command 206 is kept, but not flown' }).waitFor();
    await notes.filter({ hasText: 'geofence (1) is kept' }).waitFor();
    await checks(page).getByText('command 206 was left out').waitFor();
    const again = JSON.parse((await exported('plan')).text);
    assert.deepEqual(again.mission.items.at(-1), unknown);
    assert.equal(again.geoFence.polygons.length, 1);
    await exported('waypoints');
    await notes.filter({ hasText: 'cannot hold the geofence' }).waitFor();
    await imported('broken.waypoints', 'QGC WPL 110\n0 1 0 16\n');
    await notes.filter({ hasText: 'broken.waypoints: line 2: 4 columns' }).waitFor();
    await untilItems(6);
  });

  step('opens several missions, also those of the server', async () => {
    // What was imported is not saved: it is replaced by the second choice.
    await field('mission-open').selectOption('airfield_mission');
    await page.locator('[data-role=mission-notes]', { hasText: 'choose again to replace it' }).waitFor();
    await untilItems(6);
    await field('mission-open').selectOption('airfield_mission');
    await dashboard.until(() => document.querySelector('#mission-title').value === 'A mission over the built-in airfield');
    assert.equal((await titles()).at(-1), 'Landing');
    await reported();
    await page.locator('[data-role=profile-readout]', { hasText: 'ends with the landing' }).waitFor();
    await field('mission-open').selectOption('round_the_farm');
    await dashboard.until(() => document.querySelector('#mission-title').value === 'Round the farm');
    await untilItems(5);
    assert.equal(await page.locator('[data-role=mission-save]').innerText(), 'Saved');
  });

  step('keeps the draft when the page is loaded again', async () => {
    await rows().nth(1).locator('.mission-item').click();
    await field('item-param-6').fill('250');
    await reported();
    await page.waitForFunction(() => localStorage.getItem('overfly.mission')?.includes('250'));
    await page.reload();
    await page.locator('[data-role=open-missions]').click();
    await rows().nth(1).locator('.mission-item', { hasText: '250 m' }).waitFor();
  });

  step('flies the mission at once', async () => {
    await reported();
    await page.locator('[data-role=mission-fly]').click();
    await page.locator('[data-panel=missions]').waitFor({ state: 'hidden' });
    await page.locator('.run[aria-current=true]', { hasText: 'Round the farm' }).waitFor();
    const id = await dashboard.runId();
    await page.locator(`.run[data-run="${id}"] [aria-label="Stop this run"]`).click();
    await dashboard.untilStatus(id, 'cancelled', 60_000);
  });

  step('deletes the saved mission, and its draft stays', async () => {
    await page.locator('[data-role=open-missions]').click();
    await reported();
    await page.locator('[data-role=mission-delete]').click();
    await page.locator('[data-role=mission-delete]', { hasText: 'Delete?' }).click();
    await page.locator('#mission-open option[value=round_the_farm]').waitFor({ state: 'detached' });
    assert.ok(!existsSync(path.join(folder, 'saved/round_the_farm.json')));
    await untilItems(5);
  });

  step('fits dark and small screens', async () => {
    await page.emulateMedia({ colorScheme: 'dark' });
    for (const [width, height] of [
      [1280, 800],
      [820, 1180],
      [390, 844],
    ]) {
      await page.setViewportSize({ width, height });
      await reported();
      await dashboard.screenshot(`missions_${width}x${height}`);
      const wide = await page.evaluate(() =>
        [...document.querySelectorAll('.mission-page, .mission-page *:not(.leaflet-container *)')]
          .filter((element) => element.getBoundingClientRect().right > innerWidth + 1)
          .map((element) => element.className),
      );
      assert.deepEqual(wide, []);
    }
    await page.setViewportSize({ width: 1600, height: 900 });
    await page.emulateMedia({ colorScheme: 'light' });
  });

  step('closes by Escape and logged no error in the page', async () => {
    await page.keyboard.press('Escape');
    await page.locator('[data-panel=missions]').waitFor({ state: 'hidden' });
    assert.deepEqual(dashboard.complaints, []);
  });
});
