// The frame of the dashboard: layouts, themes, command palette, narrow screens.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { gzipSync } from 'node:zlib';
import { browserMissing } from './support/browser.mjs';
import { serverMissing, sourceFile } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kSizes = [
  { width: 1280, height: 800 },
  { width: 1920, height: 1080 },
];
const kFlightPatience_ms = 300_000;
const kMostBundle_bytes = 600_000;
const kLayouts = {
  fly: ['launcher', 'runs', 'log', 'scene', 'plots', 'camera', 'debug', 'errors'],
  compare: ['runs', 'launcher', 'log', 'scene', 'plot3d', 'camera', 'plots', 'errors', 'plots-errors'],
  estimator: ['debug', 'camera', 'image-error', 'depth', 'plots-errors', 'plots', 'status', 'errors', 'log', 'runs', 'launcher'],
  camera: ['runs', 'launcher', 'log', 'camera', 'depth', 'image-error', 'debug', 'scene', 'plots-image'],
};

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('the frame of the dashboard', { skip, timeout: 900_000 }, () => {
  let stage;
  let page;

  before(async () => {
    stage = await openStage(kSizes[0]);
    dashboard = stage.dashboard;
    page = dashboard.page;
  });

  after(() => stage?.close());

  /** Where every group of panels is, with its tabs from left to right. */
  const groups = () =>
    page.evaluate(() =>
      [...document.querySelectorAll('.dv-groupview')].map((group) => {
        const { left, top, right, bottom } = group.getBoundingClientRect();
        const tabs = [...group.querySelectorAll('.panel-tab-title')].map((tab) => tab.textContent);
        return { tabs, left, top, right, bottom };
      }),
    );

  const settledGroups = async () => {
    await dashboard.untilSettled();
    return groups();
  };

  const chooseLayout = async (name) => {
    await page.locator('[data-role=layout-menu]').click();
    await page.locator(`[data-choose-layout="${name}"]`).click();
    await page.locator(`.menu[data-layout="${name}"]`).waitFor();
  };

  const shownPanels = async () => {
    await page.locator('[data-role=layout-menu]').click();
    const names = await page.evaluate(() =>
      [...document.querySelectorAll('[data-show-panel]:checked')].map((box) => box.dataset.showPanel),
    );
    await page.keyboard.press('Escape');
    return names;
  };

  const reopen = async (hash = '') => {
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.url}/${hash}`);
  };

  step('has a small first bundle', () => {
    const folder = sourceFile('web/dist');
    const html = readFileSync(path.join(folder, 'index.html'), 'utf8');
    const files = [...html.matchAll(/(?:src|href)="\.\/(assets\/[^"]+)"/g)].map(([, file]) => file);
    assert.ok(files.length >= 2 && files.every((file) => existsSync(path.join(folder, file))));
    const bytes = files
      .map((file) => gzipSync(readFileSync(path.join(folder, file))).length)
      .reduce((sum, size) => sum + size, 0);
    assert.ok(bytes < kMostBundle_bytes, `${bytes} bytes`);
  });

  step('does not jump while it loads', async () => {
    await page.addInitScript(() => {
      window.jumps = [];
      new PerformanceObserver((list) => window.jumps.push(...list.getEntries())).observe({
        type: 'layout-shift',
        buffered: true,
      });
    });
    await reopen();
    await dashboard.chooseScenario('course');
    const jumped = await page.evaluate(() => window.jumps.reduce((sum, { value }) => sum + value, 0));
    assert.ok(jumped < 0.05, `layout shift ${jumped}`);
  });

  step('flies, to have something to show', async () => {
    await dashboard.field('duration_s').fill('4');
    await dashboard.chooseEstimators('feature');
    const run = await dashboard.launch();
    await dashboard.untilStatus(run, 'completed', kFlightPatience_ms);
    await dashboard.until(() => document.querySelector('.errors .good, .errors .bad') !== null);
  });

  for (const [name, panels] of Object.entries(kLayouts)) {
    step(`has every panel of the layout ${name} in its place`, async () => {
      for (const size of kSizes) {
        await page.setViewportSize(size);
        await chooseLayout(name);
        assert.deepEqual((await shownPanels()).sort(), [...panels].sort());
        const places = await groups();
        for (const [i, a] of places.entries()) {
          assert.ok(a.right - a.left >= 150 && a.bottom - a.top >= 80, `${a.tabs} is small`);
          assert.ok(a.left >= 0 && a.right <= size.width + 1 && a.bottom <= size.height + 1);
          for (const b of places.slice(i + 1)) {
            const apart =
              a.right <= b.left + 1 || b.right <= a.left + 1 || a.bottom <= b.top + 1 || b.bottom <= a.top + 1;
            assert.ok(apart, `${a.tabs} overlaps ${b.tabs}`);
          }
        }
        // Every panel in front has its view, and that view has its room.
        await dashboard.until(
          (count) => document.querySelectorAll('.dock .panel').length === count,
          places.length,
        );
        const empty = await page.evaluate(() =>
          [...document.querySelectorAll('.dock .panel')]
            .filter(({ clientHeight, textContent }) => clientHeight < 40 || textContent === '')
            .map(({ dataset }) => dataset.panel),
        );
        assert.deepEqual(empty.filter((panel) => !['scene', 'debug', 'camera'].includes(panel)), []);
        await dashboard.screenshot(`layout_${name}_${size.width}x${size.height}`);
      }
      await page.setViewportSize(kSizes[0]);
    });
  }

  step('arranges a layout again for a new size of the window', async () => {
    await chooseLayout('fly');
    const places = async () => (await settledGroups()).map(({ tabs, left, top }) => [tabs.join(), Math.round(left), Math.round(top)]);
    const untilLeft = (px) =>
      dashboard.until(
        (left) => {
          const scene = document.querySelector('.dv-groupview:has([data-panel=scene])');
          return Math.abs(scene.getBoundingClientRect().left - left) < 4;
        },
        px,
      );
    const before = await places();
    const sceneAt = (list) => list.find(([tabs]) => tabs === '3D view')[1];
    await page.setViewportSize(kSizes[1]);
    // The column of forms is 312 px wide there; scaled in proportion it would have 410.
    await untilLeft(320);
    await page.setViewportSize(kSizes[0]);
    await untilLeft(sceneAt(before));
    assert.deepEqual(await places(), before);
    // Also if the window got its size while one panel filled it.
    await page.locator('.dv-groupview:has([data-panel=plots]) .enlarge').click();
    await page.setViewportSize(kSizes[1]);
    await dashboard.until(() => document.querySelector('[data-panel=plots]').clientWidth > 1800);
    await page.keyboard.press('Escape');
    await untilLeft(320);
    await page.setViewportSize(kSizes[0]);
    await untilLeft(sceneAt(before));
  });

  step('leaves room for the curves of every plot', async () => {
    for (const name of ['fly', 'compare', 'estimator']) {
      await chooseLayout(name);
      await page.locator('.plot .u-over').first().waitFor();
      await dashboard.untilSettled();
      const low = await page.evaluate(() =>
        [...document.querySelectorAll('.dock .plot')]
          .filter((plot) => plot.querySelector('.u-over')?.clientHeight < 58)
          .map((plot) => plot.dataset.axis),
      );
      assert.deepEqual(low, [], name);
    }
    await chooseLayout('fly');
  });

  step('brings the tools that have no room by the arrow at their edge', async () => {
    await chooseLayout('camera');
    const group = page.locator('.dv-groupview:has([data-panel=scene])');
    const inSight = () =>
      dashboard.until(() => {
        const tools = document.querySelector('.dv-groupview:has([data-panel=scene]) .panel-tools');
        const last = [...tools.children].at(-1).getBoundingClientRect();
        return last.right <= tools.getBoundingClientRect().right + 1;
      });
    const more = group.getByLabel('Scroll to the right');
    await more.click();
    await inSight();
    await more.waitFor({ state: 'hidden' });
    await group.getByLabel('Scroll to the left').click();
    await more.waitFor();
    await group.getByLabel('Scroll to the left').waitFor({ state: 'hidden' });
    await chooseLayout('fly');
  });

  step('keeps a moved panel and a new width over a reload', async () => {
    await chooseLayout('fly');
    const log = page.locator('.dv-tab', { hasText: /^Log$/ });
    await log.dragTo(page.locator('.dv-groupview', { hasText: 'Alignment' }).locator('.errors'), {
      targetPosition: { x: 100, y: 60 },
    });
    await dashboard.until(
      () =>
        [...document.querySelectorAll('.dv-groupview')].filter((group) => {
          const tabs = [...group.querySelectorAll('.panel-tab-title')].map((tab) => tab.textContent);
          return tabs.includes('Log') && tabs.includes('Errors');
        }).length === 1,
    );
    const scene = (await settledGroups()).find(({ tabs }) => tabs.includes('3D view'));
    await page.mouse.move(scene.left - 3, 400);
    await page.mouse.down();
    await page.mouse.move(scene.left + 77, 400, { steps: 6 });
    await page.mouse.up();
    // It is kept once the mouse has come to rest.
    await dashboard.until((left) => {
      const { changed } = JSON.parse(localStorage.getItem('overfly.layouts') ?? '{}');
      return changed != null && Math.abs(changed.parts[0].size - left) < 30;
    }, scene.left + 80);
    const before = await settledGroups();
    await page.reload();
    await dashboard.until((count) => document.querySelectorAll('.dv-groupview').length === count, before.length);
    const after = await settledGroups();
    for (const [i, { tabs, left, top }] of before.entries()) {
      assert.deepEqual(after[i].tabs, tabs);
      assert.ok(Math.hypot(after[i].left - left, after[i].top - top) < 6, `${tabs} has moved`);
    }
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('[data-role=reset-layout]').click();
    await page.keyboard.press('Escape');
    assert.equal((await groups()).length, kLayouts.fly.length);
  });

  step('hides a panel and shows it again as it is now', async () => {
    await page.getByRole('button', { name: 'Hide Errors' }).click();
    await dashboard.until(() => document.querySelector('.dock [data-panel=errors]') === null);
    await dashboard.seekAt('.track .bar', 0.5, ['scene', 'camera', 'plots']);
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('[data-show-panel=errors]').check();
    await page.keyboard.press('Escape');
    await dashboard.untilSameInstant();
    await chooseLayout('fly');
  });

  step('enlarges a panel and restores it', async () => {
    const width = () => page.evaluate(() => document.querySelector('[data-panel=camera]').clientWidth);
    const before = await width();
    const camera = page.locator('.dv-groupview', { has: page.locator('[data-panel=camera]') });
    await camera.getByRole('button', { name: 'Enlarge or restore' }).click();
    await dashboard.until(() => document.querySelector('[data-panel=camera]').clientWidth > 1200);
    await page.keyboard.press('Escape');
    await dashboard.until((w) => document.querySelector('[data-panel=camera]').clientWidth === w, before);
  });

  step('keeps own layouts by name, and deletes them', async () => {
    await page.getByRole('button', { name: 'Hide Camera' }).click();
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('#layout-name').fill('Without camera');
    await page.getByRole('button', { name: 'Keep', exact: true }).click();
    await chooseLayout('compare');
    await page.reload();
    await chooseLayout('Without camera');
    assert.ok(!(await shownPanels()).includes('camera'));
    await page.locator('[data-role=layout-menu]').click();
    await page.getByRole('button', { name: 'Delete the layout Without camera' }).click();
    await page.keyboard.press('Escape');
    await page.locator('.menu[data-layout=fly]').waitFor();
  });

  step('exports own layouts to a file, and imports them in another browser', async () => {
    await page.getByRole('button', { name: 'Hide Log' }).click();
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('#layout-name').fill('Team');
    await page.getByRole('button', { name: 'Keep', exact: true }).click();
    const shown = await shownPanels();
    await page.locator('[data-role=layout-menu]').click();
    await dashboard.screenshot('layout_files_1280x800');
    const saving = page.waitForEvent('download');
    await page.getByRole('button', { name: 'Export the layout Team' }).click();
    const saved = await saving;
    assert.equal(saved.suggestedFilename(), 'Team.layouts.json');
    const text = readFileSync(await saved.path(), 'utf8');
    assert.deepEqual(JSON.parse(text).layouts.map(({ name }) => name), ['Team']);
    await page.evaluate(() => localStorage.clear());
    await reopen('#layout=compare');
    await page.locator('.menu[data-layout=compare]').waitFor();
    const give = (name, content) =>
      page.locator('[data-role=layout-file]').setInputFiles({ name, mimeType: 'application/json', buffer: Buffer.from(content) });
    await give('damaged.json', text.replace('"runs"', '"radar"'));
    await page.locator('.notice[data-level=error]', { hasText: /damaged\.json.*layouts\[0\]\.panels\..*no panel "radar"/ }).waitFor();
    await dashboard.screenshot('layout_file_refused_1280x800');
    await page.locator('.menu[data-layout=compare]').waitFor();
    await give('Team.layouts.json', text);
    await page.locator('.menu[data-layout=Team]').waitFor();
    assert.deepEqual(await shownPanels(), shown);
    // A dropped file.
    await page.evaluate((content) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([content], 'other.json'));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true }));
    }, text.replace('"Team"', '"Dropped"'));
    await page.locator('.menu[data-layout=Dropped]').waitFor();
    await page.reload();
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('[data-choose-layout=Team]').waitFor();
    await page.locator('[data-choose-layout=Dropped]').waitFor();
    await page.keyboard.press('Escape');
  });

  step('opens the layout of a link in a browser that knows nothing', async () => {
    await page.evaluate(() => localStorage.clear());
    await reopen('#layout=camera');
    await page.locator('.menu[data-layout=camera]').waitFor();
    await dashboard.until(() => location.hash.startsWith('#layout=camera'));
    assert.ok((await shownPanels()).includes('plots-image'));
  });

  step('says so when a stored layout is damaged, and shows the default one', async () => {
    await page.evaluate(() => localStorage.setItem('overfly.layouts', '{"version":1,"name":'));
    await reopen();
    await page.locator('.notice', { hasText: 'damaged' }).waitFor();
    await page.locator('.menu[data-layout=fly]').waitFor();
  });

  step('runs commands by their names', async () => {
    await page.keyboard.press('Control+k');
    await page.locator('#palette-input').fill('debug est');
    await page.keyboard.press('Enter');
    await page.locator('.menu[data-layout=estimator]').waitFor();
    await page.keyboard.press('Control+k');
    await dashboard.screenshot('palette');
    await page.locator('#palette-input').fill('open run course');
    await page.keyboard.press('Enter');
    await dashboard.until(() => /run=/.test(location.hash));
    await page.keyboard.press('Control+k');
    await page.keyboard.press('Escape');
    await page.locator('.palette').waitFor({ state: 'hidden' });
    // Keys that are typed within one frame are not lost.
    const focused = await page.evaluate(() => {
      const press = (key) => {
        const options = { ...key, bubbles: true, cancelable: true };
        document.activeElement.dispatchEvent(new KeyboardEvent('keydown', options));
        return document.activeElement.id === 'palette-input';
      };
      return [press({ key: 'k', ctrlKey: true }), press({ key: 'Escape' })];
    });
    assert.deepEqual(focused, [true, false]);
    await chooseLayout('fly');
  });

  step('brings a page to the front, also one that is open below another', async () => {
    const open = async (words, panel) => {
      await page.keyboard.press('Control+k');
      await page.locator('#palette-input').fill(words);
      await page.keyboard.press('Enter');
      await dashboard.until(
        (name) =>
          document.elementFromPoint(innerWidth / 2, innerHeight / 2)?.closest('.log-overlay')
            ?.dataset.panel === name,
        panel,
      );
    };
    await open('calibrate a camera', 'calibration');
    await open('score trajectories', 'scoring');
    await open('calibrate a camera', 'calibration');
    await page.keyboard.press('Escape');
    await dashboard.until(() => document.querySelector('.log-overlay[data-panel=calibration]').hidden);
    assert.ok(await page.locator('.log-overlay[data-panel=scoring]').isVisible());
    await page.keyboard.press('Escape');
    await dashboard.until(() =>
      [...document.querySelectorAll('.log-overlay')].every(({ hidden }) => hidden),
    );
  });

  step('follows the theme of the system, and the choice of the viewer', async () => {
    const back = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await page.emulateMedia({ colorScheme: 'dark' });
    const dark = await back();
    await page.emulateMedia({ colorScheme: 'light' });
    const light = await back();
    assert.notEqual(light, dark);
    await dashboard.untilSameInstant();
    await dashboard.screenshot('light_1280x800');
    await page.locator('#theme').selectOption('dark');
    assert.equal(await back(), dark);
    await page.reload();
    assert.equal(await back(), dark);
    await page.locator('#theme').selectOption('system');
    await page.emulateMedia({ colorScheme: 'dark' });
  });

  step('names every control', async () => {
    await page.locator('[data-role=layout-menu]').click();
    const nameless = await page.evaluate(() =>
      [...document.querySelectorAll('button, input, select, textarea, [role=slider], canvas[role]')]
        .filter((control) => {
          const texts = [
            control.getAttribute('aria-label'),
            control.textContent,
            ...[...(control.labels ?? [])].map((label) => label.textContent),
          ];
          return texts.every((text) => text === null || text.trim() === '');
        })
        .map((control) => control.outerHTML.slice(0, 120)),
    );
    await page.keyboard.press('Escape');
    assert.deepEqual(nameless, []);
  });

  step('stacks the panels on narrow screens', async () => {
    await chooseLayout('fly');
    for (const [width, height] of [
      [390, 844],
      [768, 1024],
    ]) {
      await page.setViewportSize({ width, height });
      await dashboard.until(
        (count) => document.querySelectorAll('.stacked .panel').length === count,
        kLayouts.fly.length,
      );
      await dashboard.untilSettled();
      const { over, outside } = await page.evaluate(() => ({
        over: document.documentElement.scrollWidth - window.innerWidth,
        outside: [...document.querySelectorAll('.stacked, .panel-host, .header-bar > *, .timeline > *')]
          .filter((part) => part.getBoundingClientRect().right > window.innerWidth + 1)
          .map((part) => part.className),
      }));
      assert.equal(over, 0);
      assert.deepEqual(outside, []);
      await dashboard.untilSameInstant();
      await dashboard.screenshot(`narrow_${width}x${height}`);
      await page.locator('[data-role=pages-menu]').click();
      await page.locator('[data-role=open-scores]').click();
      await page.locator('[data-panel=scoring]').waitFor();
      await page.keyboard.press('Escape');
      await page.locator('[data-role=pages-menu]:focus').waitFor();
      assert.ok(!(await page.locator('[data-role=open-scores]').isVisible()));
    }
    await page.setViewportSize(kSizes[0]);
    await dashboard.until(() => document.querySelectorAll('.dv-groupview').length === 8);
    await dashboard.untilSameInstant();
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
