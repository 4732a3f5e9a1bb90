// A link opens the same picture in a browser that has never been here: runs, instant, layout, and
// everything that the viewer chose. Damaged links open as far as they can be read.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing, openBrowser } from './support/browser.mjs';
import { Dashboard } from './support/dashboard.mjs';
import { flyPair, kPair } from './support/flights.mjs';
import { getJson, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kSize = { width: 1600, height: 900 };
const [kSlow, kFast] = kPair.map(({ id }) => id);
const kPanels = ['scene', 'camera', 'plots', 'errors'];

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

/** What a viewer sees, once it has come to rest. */
async function look(view) {
  await view.untilSameInstant(kPanels);
  await view.untilSettled();
  for (const panel of ['scene', 'camera']) await view.untilStill(panel);
  const shown = await view.page.evaluate(() => {
    const all = (selector) => [...document.querySelectorAll(selector)];
    const one = (selector) => document.querySelector(selector);
    const digest = (canvas) => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return data.reduce((sum, value) => (Math.imul(sum, 31) + value) | 0, 0);
    };
    return {
      layout: one('[data-role=layout-menu]').textContent,
      groups: all('.dv-groupview').map((group) => {
        const { left, top, right, bottom } = group.getBoundingClientRect();
        const tabs = [...group.querySelectorAll('.panel-tab-title')].map((tab) => tab.textContent);
        const panel = group.querySelector('.panel')?.dataset.panel;
        return { tabs, panel, place: [left, top, right, bottom].map((edge) => Math.round(edge)) };
      }),
      runs: all('[data-shown-run]').map((entry) => [
        entry.dataset.shownRun,
        entry.getAttribute('aria-current'),
        entry.querySelector('input').value,
      ]),
      tracks: all('.track-chip').map((chip) => [
        chip.querySelector('.track-button').getAttribute('aria-pressed'),
        getComputedStyle(chip.querySelector('i')).backgroundColor,
      ]),
      chosen: ['alignment', 'camera', 'debug-of', 'image-error-of', 'speed'].map(
        (id) => document.getElementById(id)?.value,
      ),
      pressed: ['.tab[data-group]', '[data-mode]', '.rates button', '[data-role=side-by-side]'].map(
        (buttons) => all(buttons).map((button) => button.getAttribute('aria-pressed')),
      ),
      notes: all('[data-role=alignment]').map((note) => note.textContent),
      values: all('.readout').map((readout) => readout.textContent),
      curves: all('[data-panel=plots] .uplot canvas').map(digest),
      errors: one('.errors').innerText,
      clock: (({ frame, tNs, speed }) => [frame, tNs, speed])(one('[data-panel=timeline]').dataset),
      range: one('[data-role=range]').getAttribute('style'),
      pictures: all('[data-panel=camera] canvas.picture').map((canvas) => {
        const { left, top, width, height } = canvas.style;
        return [left, top, width, height, canvas.width].map((length) => Math.round(parseFloat(length)));
      }),
    };
  });
  const seen = await Promise.all(['scene', 'camera'].map((panel) => view.picture(panel)));
  return { ...shown, means: seen.map(({ mean }) => Math.round(mean)) };
}

describe('links', { skip, timeout: 600_000 }, () => {
  let stage;
  let page;

  before(async () => {
    stage = await openStage(kSize, flyPair);
    dashboard = stage.dashboard;
    page = dashboard.page;
  });

  after(() => stage?.close());

  /** Acts in a browser of its own, which has kept nothing. */
  const elsewhere = async (hash, act) => {
    const browser = await openBrowser(kSize);
    try {
      const other = new Dashboard(browser.page);
      await other.open(`${stage.server.address}${hash}`);
      await act(other);
      assert.deepEqual(other.complaints, []);
    } finally {
      await browser.close();
    }
  };
  const fields = () => page.evaluate(() => new URLSearchParams(location.hash.slice(1)).toString());
  const untilWritten = (...names) =>
    dashboard.until(
      (wanted) => wanted.every((name) => new URLSearchParams(location.hash.slice(1)).has(name)),
      names,
    );

  step('show two runs by default without further words', async () => {
    await page.locator(`.run[data-run="${kSlow}"] .run-open`).click();
    await dashboard.untilFrames(kPanels);
    await page.locator(`.run[data-run="${kFast}"] .compare`).click();
    await page.locator(`[data-shown-run="${kFast}"]`).waitFor();
    await untilWritten('t');
    await dashboard.until(
      () => new URLSearchParams(location.hash.slice(1)).getAll('run').length === 2,
    );
    assert.deepEqual([...new URLSearchParams(await fields()).keys()], ['layout', 'run', 'run', 't']);
  });

  step('hold what the viewer chooses', async () => {
    // Runs, tracks, alignment.
    await page.getByLabel('Offset of run B in seconds').fill('1.5');
    await page.keyboard.press('Enter');
    await dashboard.until(() => document.querySelector('.errors .good') !== null);
    await page.locator('#alignment').selectOption('sim3');
    const button = (run, name) =>
      page.locator(`[data-shown-run="${run}"] .track-button`, { hasText: name });
    await button(kSlow, 'strays').click();
    await page.getByLabel('Choose the colour of B flat').click();
    await dashboard.screenshot('track_colour_1600x900');
    await page.getByLabel('Petrol for B flat').click();
    await page.getByLabel('Choose the colour of A drifts').click();
    await page.getByLabel('Any colour for A drifts').fill('#7a3b00');
    await button(kFast, 'truth').click();
    // The clock.
    await dashboard.seekAt('.track .bar', 0.2, kPanels);
    await page.keyboard.press('[');
    await dashboard.seekAt('.track .bar', 0.8, kPanels);
    await page.keyboard.press(']');
    await page.locator('#speed').selectOption('2');
    await page.getByLabel('Repeat from the start').click();
    await page.keyboard.press('r');
    await dashboard.seekAt('.track .bar', 0.55, kPanels);
    // The plots: another group, a part of the time.
    await page.locator('.tab[data-group=errors]').first().click();
    const plot = page.locator('[data-panel=plots] [data-axis=error_m] .u-over');
    await plot.hover();
    await page.mouse.wheel(0, -500);
    // The pictures: another camera, another estimator, the other error, a part of the image.
    await page.locator('#camera').selectOption('oblique');
    await page.locator('#debug-of').selectOption('flat');
    await dashboard.untilPictured('camera');
    await dashboard.untilSameInstant(kPanels);
    await page.locator('[data-panel=camera] .picture-view').first().hover();
    await page.mouse.wheel(0, -600);
    await page.mouse.move(5, 5);
    // The layout: another panel, another width.
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('[data-show-panel=image-error]').check();
    await page.keyboard.press('Escape');
    await page.locator('#image-error-of').selectOption('drifts');
    await dashboard.untilSettled();
    const scene = await page.locator('.dv-groupview', { has: page.locator('[data-panel=scene]') }).boundingBox();
    await page.mouse.move(scene.x - 3, 400);
    await page.mouse.down();
    await page.mouse.move(scene.x + 57, 400, { steps: 6 });
    await page.mouse.up();
    await page.mouse.move(5, 5);
    await page.keyboard.press('2');
    await untilWritten(
      ...['layout', 'panels', 'run', 'view', 'align', 'hide', 'plots', 'window', 'range', 'colour'],
      ...['speed', 'loop', 'camera', 'debug', 'error', 'zoom', 't'],
    );
  });

  step('open the same picture in a fresh browser', async () => {
    const wanted = await look(dashboard);
    assert.match(wanted.layout, /Fly \*/);
    const hash = await page.evaluate(() => location.hash);
    assert.ok(hash.length < 1500, `${hash.length} characters`);
    await dashboard.screenshot('link_sent_1600x900');
    await elsewhere(hash, async (other) => {
      const { place: _, ...rest } = await look(other);
      await other.screenshot('link_opened_1600x900');
      for (const [i, group] of rest.groups.entries()) {
        const off = group.place.map((edge, k) => Math.abs(edge - wanted.groups[i].place[k]));
        assert.ok(Math.max(...off) <= 4, `${group.tabs} is off by ${off} px`);
      }
      const unplaced = ({ groups, curves: _curves, pictures: _pictures, ...all }) => ({
        ...all,
        groups: groups.map(({ tabs, panel }) => ({ tabs, panel })),
      });
      assert.deepEqual(unplaced(rest), unplaced(wanted));
      for (const [i, place] of rest.pictures.entries()) {
        const off = place.map((part, k) => Math.abs(part - wanted.pictures[i][k]));
        assert.ok(Math.max(...off) <= 12, `the picture is off by ${off} px`);
      }
      // The address is the same again: nothing was lost, nothing was added.
      const parts = (text) => [...new URLSearchParams(text.slice(1))];
      // One frame on and back: the page has written the whole address itself.
      await other.page.keyboard.press('ArrowRight');
      await other.until((old) => location.hash !== old, hash);
      await other.page.keyboard.press('ArrowLeft');
      await other.until((t) => new URLSearchParams(location.hash.slice(1)).get('t') === t, new URLSearchParams(hash.slice(1)).get('t'));
      const again = await other.page.evaluate(() => location.hash);
      assert.deepEqual(parts(again), parts(hash));
    });
  });

  step('open an own layout where it is not known', async () => {
    await page.locator('[data-role=layout-menu]').click();
    await page.locator('#layout-name').fill('Mine');
    await page.getByRole('button', { name: 'Keep', exact: true }).click();
    await page.keyboard.press('Escape');
    await page.locator('.menu[data-layout=Mine]').waitFor();
    await dashboard.until(() => !new URLSearchParams(location.hash.slice(1)).has('layout'));
    const { groups } = await look(dashboard);
    const hash = await page.evaluate(() => location.hash);
    await elsewhere(hash, async (other) => {
      const opened = await look(other);
      assert.deepEqual(opened.groups.map(({ tabs }) => tabs), groups.map(({ tabs }) => tabs));
    });
    await page.reload();
    await page.locator('.menu[data-layout=Mine]').waitFor();
  });

  step('say which parts are damaged, and open the rest', async () => {
    const damaged = `#run=${kSlow}&panels=e30x&speed=1e9&hide=Z/x&window=9,3&align=sim3&t=2.5`;
    await elsewhere(damaged, async (other) => {
      const notice = other.page.locator('.notice[data-level=error]', { hasText: 'damaged' });
      await notice.waitFor();
      const text = await notice.innerText();
      for (const part of ['panels', 'speed=1e9', 'hide=Z/x', 'window=9,3']) assert.ok(text.includes(part), text);
      await other.screenshot('link_damaged_1600x900');
      await other.untilSameInstant(kPanels);
      await other.until(() => document.querySelector('#alignment').value === 'sim3');
      const { t_ns } = await other.playback();
      assert.equal(t_ns, 2.5e9);
      await other.page.locator('.menu[data-layout=fly]').waitFor();
    });
  });

  step('go back and forward through links without changing them', async () => {
    const links = [
      `#layout=camera&run=${kSlow}&t=1`,
      `#layout=fly&run=${kFast}&t=2`,
      `#layout=fly&run=${kSlow}&run=${kFast}&t=3`,
    ];
    const untilShown = async (link) => {
      await dashboard.until((hash) => decodeURIComponent(location.hash) === hash, link);
      await dashboard.until(
        (t_ns) => Number(document.querySelector('[data-panel=timeline]').dataset.tNs) === t_ns,
        Number(new URLSearchParams(link).get('t')) * 1e9,
      );
      // Longer than the page waits before it writes its address.
      await page.waitForTimeout(1000);
      assert.equal(decodeURIComponent(await page.evaluate(() => location.hash)), link);
    };
    for (const link of links) {
      await page.evaluate((hash) => {
        location.hash = hash;
      }, link);
      await untilShown(link);
    }
    for (const [by, place] of [[-1, 1], [-1, 0], [1, 1], [1, 2], [-2, 0]]) {
      await page.evaluate((steps) => history.go(steps), by);
      await untilShown(links[place]);
    }
  });

  step('hide each track of a single run', async () => {
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.url}/#layout=compare&run=${kSlow}&t=3`);
    await dashboard.untilSameInstant(kPanels.filter((panel) => panel !== 'camera'));
    const values = () => page.locator('[data-panel=plots] [data-axis=x_m] .readout').count();
    const tracks = () => page.evaluate(() => document.querySelector('[data-panel=plot3d]')?.dataset.tracks);
    await page.locator('.dv-tab', { hasText: /^3D plot$/ }).click();
    await dashboard.until(() => document.querySelector('[data-panel=plot3d]')?.dataset.tracks === '4');
    assert.equal(await values(), 4);
    for (const [i, name] of ['truth', 'strays', 'flat'].entries()) {
      await page.getByRole('button', { name: `Show ${name}` }).click();
      await dashboard.until((left) => {
        const readouts = document.querySelectorAll('[data-panel=plots] [data-axis=x_m] .readout');
        return readouts.length === left && document.querySelector('[data-panel=plot3d]').dataset.tracks === String(left);
      }, 3 - i);
    }
    await dashboard.screenshot('hidden_tracks_1600x900');
    await page.getByRole('button', { name: 'Show truth' }).click();
    await dashboard.until(() => document.querySelector('[data-panel=plot3d]').dataset.tracks === '2');
    assert.equal(await tracks(), '2');
  });

  step('compare two alignments of an estimate, each with its scale', async () => {
    const { estimators } = await getJson(stage.server, `/runs/${kSlow}/metrics`);
    const scale = (mode) => estimators.drifts.alignments[mode].scale.toFixed(4);
    const wanted = [`drifts by init_scale, scale ${scale('init_scale')}`, `drifts by sim3, scale ${scale('sim3')}`];
    await page.locator('#compared').selectOption('sim3');
    await dashboard.until(() => document.querySelector('[data-panel=plot3d]').dataset.tracks === '3');
    const legend = (view) =>
      view.page.locator('[data-panel=plots] .alignment-legend span').allInnerTexts();
    await page.locator('[data-panel=plots] .alignment-legend').waitFor();
    assert.deepEqual(await legend(dashboard), wanted);
    const columns = await getJson(stage.server, `/runs/${kSlow}/trajectories/drifts?format=json&alignment=sim3`);
    const { frame } = await dashboard.playback();
    const y_m = columns.y_m[columns.frame.indexOf(frame)].toFixed(1);
    const readouts = page.locator('[data-panel=plots] [data-axis=y_m] .readout');
    await readouts.nth(2).filter({ hasText: y_m.replace('-', '−') }).waitFor();
    assert.equal((await readouts.allInnerTexts())[2].replace('−', '-'), y_m);
    const { scale: scales } = await dashboard.errors();
    assert.deepEqual(scales.filter((_, i) => i % 3 === 0), [scale('init_scale'), scale('sim3')]);
    await dashboard.screenshot('compared_alignments_1600x900');
    await page.locator('.tab[data-group=path]').click();
    await page.locator('.path-plot').first().waitFor();
    await dashboard.screenshot('compared_paths_1600x900');
    await page.locator('.dv-tab', { hasText: /^3D view$/ }).click();
    await page.getByRole('button', { name: 'Show flat' }).click();
    await page.getByRole('button', { name: 'Show drifts' }).click();
    await dashboard.untilStill('scene');
    const names = await page.locator('[data-panel=scene] .legend span').allInnerTexts();
    assert.ok(names.some((name) => name.startsWith('flat by sim3, scale ')), `${names}`);
    const both = await dashboard.picture('scene');
    await dashboard.screenshot('compared_scene_1600x900');
    await page.locator('#compared').selectOption('');
    await dashboard.untilPictureDiffers('scene', both.digest);
    await page.locator('#compared').selectOption('sim3');
    await page.getByRole('button', { name: 'Show flat' }).click();
    await page.getByRole('button', { name: 'Show drifts' }).click();
    await untilWritten('compare');
    await dashboard.until(() => {
      const hidden = new URLSearchParams(location.hash.slice(1)).getAll('hide').join();
      return hidden.includes('flat') && !hidden.includes('drifts');
    });
    await elsewhere(await page.evaluate(() => location.hash), async (other) => {
      await other.page.locator('[data-panel=plots] .alignment-legend').waitFor();
      await other.until((count) => document.querySelectorAll('[data-panel=plots] .alignment-legend span').length === count, 2);
      assert.deepEqual(await legend(other), wanted);
    });
  });

  step('do not move the layout while runs are opened, added and exchanged', async () => {
    await page.addInitScript(() => {
      window.jumps = [];
      const keep = (list) => window.jumps.push(...list.getEntries());
      new PerformanceObserver(keep).observe({ type: 'layout-shift', buffered: true });
    });
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.url}/#layout=fly`);
    await page.locator('.run').first().waitFor();
    await dashboard.untilSettled();
    // By the address: the browser does not count as jumps what follows a click.
    for (const [what, main, hash] of [
      ['a run', kSlow, `run=${kSlow}&t=2`],
      ['a second run', kSlow, `run=${kSlow}&run=${kFast}&t=2`],
      ['the other as the main one', kFast, `run=${kSlow}&run=${kFast}&main=${kFast}&t=3`],
      ['one run again', kFast, `run=${kFast}&t=3`],
      ['the other run', kSlow, `run=${kSlow}&t=3`],
    ]) {
      await page.evaluate((link) => {
        window.jumps = [];
        location.hash = link;
      }, `layout=fly&${hash}`);
      await dashboard.until(
        (id) => document.querySelector('.run[aria-current=true]')?.dataset.run === id,
        main,
      );
      await dashboard.untilSameInstant(kPanels);
      await dashboard.untilSettled();
      const jumps = await page.evaluate(() =>
        window.jumps.map(({ value, sources }) => [
          value,
          ...sources.map(({ node }) => node?.className ?? node?.parentElement?.className ?? ''),
        ]),
      );
      const jumped = jumps.reduce((sum, [value]) => sum + value, 0);
      assert.ok(jumped < 0.02, `${what}: layout shift ${jumped} of ${JSON.stringify(jumps)}`);
    }
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
