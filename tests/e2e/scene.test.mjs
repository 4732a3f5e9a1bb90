// The 3D view: its modes, what it shows, the camera's image on the ground, a picture saved, and the
// address that opens the same view again.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { flyCourse } from './support/flights.mjs';
import { serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kRun = '20260101-000001-drifts';
const kEstimators =
  '[{"name":"feature","type":"feature"},{"name":"drifts","type":"drifting","parameters":{"drift":0.3}}]';

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

function fly(runs) {
  flyCourse(runs, kRun, ['duration_s=6', `estimators=${kEstimators}`]);
  return {};
}

describe('the 3D view', { skip, timeout: 600_000 }, () => {
  let stage;
  let page;

  before(async () => {
    stage = await openStage({ width: 1600, height: 900 }, fly);
    dashboard = stage.dashboard;
    page = dashboard.page;
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.address}#run=${kRun}&t=5`);
    await dashboard.untilSameInstant();
  });

  after(() => stage?.close());

  const labels = () => page.locator('.scene-label').allInnerTexts();
  const changed = async (act) => {
    const { digest } = await dashboard.picture('scene');
    await act();
    await dashboard.untilPictureDiffers('scene', digest);
  };
  const show = async (part, on) => {
    await page.locator('[data-role=scene-show]').click();
    await page.locator(`[data-part=${part}]`).setChecked(on);
    await page.keyboard.press('Escape');
  };

  step('names the truth and the estimates at their aircraft', async () => {
    await dashboard.until(() => document.querySelectorAll('.scene-label').length === 3);
    const texts = await labels();
    assert.equal(texts[0], 'truth');
    assert.match(texts[1], /^feature/);
    assert.match(texts[2], /^drifts \d+(\.\d+)? m$/);
    const boxes = await Promise.all(
      (await page.locator('.scene-label').all()).map((label) => label.boundingBox()),
    );
    for (const [i, a] of boxes.entries()) {
      for (const b of boxes.slice(i + 1)) {
        const apart =
          a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
        assert.ok(apart, 'labels cover each other');
      }
    }
  });

  step('has five viewpoints', async () => {
    for (const key of ['2', '3', '4', '5', '1']) await changed(() => page.keyboard.press(key));
    await changed(() => page.keyboard.press('4'));
    const own = await page.locator('.scene-label').filter({ hasText: 'truth' }).count();
    assert.equal(own, 0, 'one is in the aircraft');
    await dashboard.screenshot('scene_onboard');
  });

  step('flies freely from where the view was, by keys, mouse and wheel', async () => {
    await page.keyboard.press('2');
    await page.keyboard.press('5');
    await page.locator('[data-mode=free][aria-pressed=true]').waitFor();
    await changed(async () => {
      await page.keyboard.down('w');
      await page.waitForFunction(() => location.hash.includes('view=free'));
      await page.keyboard.up('w');
    });
    const box = await page.locator('[data-panel=scene] .panel-body').boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await changed(async () => {
      await page.mouse.move(x, y);
      await page.mouse.down();
      await page.mouse.move(x + 60, y + 40, { steps: 4 });
      await page.mouse.up();
    });
    await changed(() => page.mouse.wheel(0, -400));
    await page.keyboard.press('2');
  });

  step("lays the camera's image onto the ground", async () => {
    await page.keyboard.press('3');
    await page.locator('[data-mode=top][aria-pressed=true]').waitFor();
    const [{ width, height }] = await page.evaluate(() => {
      const { width, height } = document.querySelector('[data-panel=scene] canvas.picture');
      return [{ width, height }];
    });
    assert.ok(width > 300 && height > 200);
    await changed(() => page.keyboard.press('f'));
    // Colourless where the grey camera's image lies: in the middle, below the aircraft.
    const colourless = () =>
      page.evaluate(() => {
        const canvas = document.querySelector('[data-panel=scene] canvas.picture');
        const { data } = canvas
          .getContext('2d')
          .getImageData(canvas.width / 2 - 12, canvas.height / 2 - 12, 24, 24);
        let most = 0;
        for (let i = 0; i < data.length; i += 4) {
          most = Math.max(most, Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]));
        }
        return most;
      });
    const parts = ['ribbons', 'aircraft', 'frustum', 'points', 'errors'];
    await changed(async () => {
      for (const part of parts) await show(part, false);
    });
    await dashboard.untilStill('scene');
    const before = await colourless();
    await changed(() => page.keyboard.press('i'));
    await dashboard.untilStill('scene');
    const after = await colourless();
    assert.ok(before > 20 && after < 12, `colourfulness ${before} before, ${after} after`);
    await dashboard.screenshot('scene_image_on_ground');
    for (const part of parts) await show(part, true);
  });

  step('draws lines from the truth to the estimates', async () => {
    await page.keyboard.press('2');
    await page.locator('[data-mode=orbit][aria-pressed=true]').waitFor();
    await dashboard.untilStill('scene');
    await changed(() => show('error_history', true));
    await dashboard.untilStill('scene');
    await dashboard.screenshot('scene_errors');
  });

  step('opens the same view again from the address alone', async () => {
    await dashboard.until(
      () => location.hash.includes('view=orbit') && location.hash.includes('error_history'),
    );
    await dashboard.untilSameInstant(['scene']);
    const before = await dashboard.picture('scene');
    const shown = await labels();
    const address = page.url();
    await page.goto('about:blank');
    await dashboard.open(address);
    await dashboard.untilSameInstant();
    await dashboard.until((count) => document.querySelectorAll('.scene-label').length === count, shown.length);
    const end_ms = Date.now() + 30_000;
    while ((await dashboard.picture('scene')).digest !== before.digest) {
      assert.ok(Date.now() < end_ms, 'another picture');
      await page.evaluate(() => new Promise(requestAnimationFrame));
    }
    assert.deepEqual(await labels(), shown);
  });

  step('keeps viewpoint and contents with an own layout', async () => {
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('#layout-name').fill('My view');
    await page.getByRole('button', { name: 'Keep', exact: true }).click();
    await page.keyboard.press('1');
    await show('labels', false);
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('[data-choose-layout="My view"]').click();
    await page.locator('[data-mode=orbit][aria-pressed=true]').waitFor();
    await dashboard.until(() => document.querySelectorAll('.scene-label').length > 0);
  });

  step('saves the view as a picture in its largest size', async () => {
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.locator('[data-role=scene-shot]').click(),
    ]);
    assert.match(download.suggestedFilename(), /^overfly-3d-.*\.png$/);
    const png = readFileSync(await download.path());
    assert.equal(png.subarray(1, 4).toString(), 'PNG');
    const [width, height] = [png.readUInt32BE(16), png.readUInt32BE(20)];
    assert.ok(width === 1920 || height === 1440, `${width} x ${height}`);
    assert.ok(png.length > 200_000, `${png.length} bytes`);
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
