// The 3D plot: its tracks, the note under the mouse, seeking by a click, and two runs on one clock.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { flyCourse } from './support/flights.mjs';
import { serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kFlights = [
  { id: '20260101-000001-slow', airspeed_m_s: 15 },
  { id: '20260101-000002-fast', airspeed_m_s: 25 },
];
const [kSlow, kFast] = kFlights.map(({ id }) => id);
const kEstimators = '[{"name":"drifts","type":"drifting","parameters":{"drift":0.1}}]';
const kSmall = ['camera.width_px=160', 'camera.height_px=120'];
const kPanel = '[data-panel=plot3d]';

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

function fly(runs) {
  for (const { id, airspeed_m_s } of kFlights) {
    const fields = [
      `flight.course.airspeed_m_s=${airspeed_m_s}`,
      `estimators=${kEstimators}`,
      'duration_s=6',
      ...kSmall,
    ];
    flyCourse(runs, id, fields);
  }
  return {};
}

describe('the 3D plot', { skip, timeout: 600_000 }, () => {
  let stage;
  let page;

  before(async () => {
    stage = await openStage({ width: 1600, height: 900 }, fly);
    dashboard = stage.dashboard;
    page = dashboard.page;
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.address}#run=${kSlow}&t=6`);
    await dashboard.untilFrames(['scene', 'plots']);
  });

  after(() => stage?.close());

  const area = () => page.locator('.plot3d-area');
  const untilTracks = (count) =>
    dashboard.until(
      ([panel, wanted]) => document.querySelector(panel)?.dataset.tracks === wanted,
      [kPanel, String(count)],
    );
  const draws = () => page.locator(kPanel).getAttribute('data-draws').then(Number);
  /** Acts, and waits until the plot was drawn again. */
  const drawn = async (act) => {
    const before = await draws();
    await act();
    await dashboard.until(
      ([panel, count]) => Number(document.querySelector(panel).dataset.draws) > count,
      [kPanel, before],
    );
  };

  /** Where the canvas of the lines has the colour of a variable of the style sheet [px of the page]. */
  const placesOf = async (colour) => {
    // The legend has the colours of the lines, and lies over them.
    const style = '.plot3d-area .legend { visibility: hidden }';
    const lines = page.locator(`${kPanel} [data-role=plot3d-lines]`);
    const png = (await lines.screenshot({ style })).toString('base64');
    const places = await page.evaluate(
      async ([encoded, wanted]) => {
        const bytes = Uint8Array.from(atob(encoded), (letter) => letter.charCodeAt(0));
        const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
        const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
        const pen = canvas.getContext('2d');
        pen.drawImage(bitmap, 0, 0);
        const { data } = pen.getImageData(0, 0, bitmap.width, bitmap.height);
        const probe = document.body.appendChild(document.createElement('i'));
        probe.style.color = wanted;
        const rgb = getComputedStyle(probe).color.match(/\d+/g).map(Number);
        probe.remove();
        const found = [];
        for (let i = 0; i < data.length; i += 4) {
          if (!rgb.every((part, k) => Math.abs(part - data[i + k]) < 4)) continue;
          found.push([(i / 4) % bitmap.width, Math.floor(i / 4 / bitmap.width)]);
        }
        return found;
      },
      [png, `var(${colour})`],
    );
    const box = await area().boundingBox();
    return places.map(([x, y]) => [box.x + x, box.y + y]);
  };

  /** Puts the mouse on an end of the track, which leads to the south: seen from above, downwards. */
  const pointAt = async (colour, end) => {
    const places = (await placesOf(colour)).sort((a, b) => a[1] - b[1]);
    assert.ok(places.length > 40, `${places.length} pixels of ${colour}`);
    const [x, y] = end === 'north' ? places.at(0) : places.at(-1);
    await page.mouse.move(x, y);
    await page.locator('[data-role=plot3d-note]').waitFor();
    return { x, y, note: await page.locator('[data-role=plot3d-note]').innerText() };
  };

  step('is opened by the command palette, with the tracks of the run', async () => {
    const loaded = () =>
      page.evaluate(() =>
        performance.getEntriesByType('resource').some(({ name }) => name.includes('plot3d_panel')),
      );
    assert.equal(await loaded(), false, 'it is loaded when it is first shown');
    await page.keyboard.press('Control+k');
    await page.keyboard.type('Show 3D plot');
    await page.keyboard.press('Enter');
    await untilTracks(2);
    assert.equal(await loaded(), true);
    await dashboard.until(() => document.querySelector('[data-panel=plot3d]').dataset.draws > 0);
    await page.locator('.dv-groupview:has(.plot3d-area) .enlarge').click();
    await dashboard.untilSettled();
    assert.match(await area().getAttribute('aria-label'), /^3D plot of truth, drifts/);
    const points = Number(await page.locator(kPanel).getAttribute('data-points'));
    assert.ok(points > 300, `${points} points`);
  });

  step('draws the truth and the estimate', async () => {
    await drawn(() => page.locator('[data-view3d=top]').click());
    for (const colour of ['--truth', '--estimate-1']) {
      const places = await placesOf(colour);
      assert.ok(places.length > 40, `${places.length} pixels of ${colour}`);
    }
    await dashboard.screenshot('plot3d_top');
  });

  step('is not drawn while nothing changes', async () => {
    const frames = () =>
      page.evaluate(async () => {
        for (let i = 0; i < 20; i++) await new Promise(requestAnimationFrame);
      });
    // Rows and scores may still arrive for a while.
    let before = null;
    for (let tries = 0; tries < 100 && before !== (await draws()); tries += 1) {
      before = await draws();
      await frames();
    }
    await frames();
    assert.equal(await draws(), before);
  });

  step('says what is under the mouse, and seeks there', async () => {
    // The estimate is ahead of the truth: only it is at the southern end.
    const { note: southern } = await pointAt('--estimate-1', 'south');
    assert.match(southern, /^drifts\s*\n00:0[56]\./);
    const { x, y, note } = await pointAt('--truth', 'north');
    const [, time, place] = note.split('\n');
    assert.match(place, /^x −?\d+\.\d\s+y −?\d+\.\d\s+z \d+\.\d m$/u);
    const [, seconds] = time.match(/^00:(\d\d\.\d{3})$/);
    assert.ok(Number(seconds) < 1, `the northern end of the track is at ${seconds} s`);
    await page.mouse.click(x, y);
    await dashboard.until(
      (wanted) => Math.abs(document.querySelector('[data-panel=timeline]').dataset.tNs / 1e9 - wanted) < 0.02,
      Number(seconds),
    );
  });

  step('draws the part after the instant fainter', async () => {
    await dashboard.until(() => {
      const { frame } = document.querySelector('[data-panel=plot3d]').dataset;
      return frame === document.querySelector('[data-panel=timeline]').dataset.frame;
    });
    await page.mouse.move(0, 0);
    await dashboard.until(() => document.querySelector('[data-role=plot3d-note]').hidden);
    // What is left in full colour is the aircraft, which is small.
    const before = (await placesOf('--estimate-1')).length;
    await dashboard.seekAt('.track .bar', 0.99, ['plot3d']);
    const after = (await placesOf('--estimate-1')).length;
    assert.ok(after > before + 40, `${before} pixels at the beginning, ${after} at the end`);
  });

  step('is turned, moved and zoomed by mouse and keys', async () => {
    const box = await area().boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const look = async () => JSON.stringify(await placesOf('--truth'));
    const seen = [await look()];
    const changes = async (act) => {
      await drawn(act);
      const now = await look();
      assert.ok(!seen.includes(now), 'it looks as before');
      seen.push(now);
    };
    const drag = async (button) => {
      await page.mouse.move(x, y);
      await page.mouse.down({ button });
      await page.mouse.move(x + 40, y - 60, { steps: 3 });
      await page.mouse.up({ button });
    };
    await changes(() => drag('left'));
    await changes(() => drag('right'));
    await changes(() => page.mouse.wheel(0, -300));
    await area().focus();
    await changes(() => page.keyboard.press('ArrowLeft'));
    await changes(() => page.keyboard.press('-'));
    await changes(() => page.keyboard.press('0'));
    await changes(() => page.getByLabel('Exaggeration of heights').selectOption('10'));
  });

  step('shows two runs, each with its letter', async () => {
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.address}#layout=compare&run=${kSlow}&run=${kFast}&t=6`);
    await page.getByText('3D plot', { exact: true }).first().click();
    await untilTracks(4);
    await page.locator('.dv-groupview:has(.plot3d-area) .enlarge').click();
    await dashboard.untilSettled();
    const legend = await page.locator(`${kPanel} .legend`).innerText();
    for (const label of ['A truth', 'A drifts', 'B truth', 'B drifts']) assert.ok(legend.includes(label));
    await drawn(() => page.locator('[data-view3d=top]').click());
    const { note } = await pointAt('--estimate-2', 'south');
    assert.match(note, /^B drifts .*25 m\/s/);
    await dashboard.screenshot('plot3d_two_runs');
  });

  step('leaves out a hidden track', async () => {
    await page.locator('.dv-groupview:has(.plot3d-area) .enlarge').click();
    await page.locator(`[data-shown-run="${kFast}"] .track-button`).last().click();
    await untilTracks(3);
    await dashboard.until(() => !document.querySelector('[data-panel=plot3d] .legend').innerText.includes('B drifts'));
    assert.equal((await placesOf('--estimate-2')).length, 0);
  });

  step('waits for a graphics context that was taken away', async () => {
    const context = (act) =>
      page.evaluate((name) => {
        const gl = document.querySelector('[data-role=plot3d-lines]').getContext('webgl2');
        window.lostContext ??= gl.getExtension('WEBGL_lose_context');
        window.lostContext[name]();
      }, act);
    await context('loseContext');
    await page.locator(`${kPanel} .panel-empty`).getByText('graphics memory').waitFor();
    assert.equal(await area().isVisible(), false);
    await context('restoreContext');
    await area().waitFor();
    await dashboard.untilSettled();
    assert.ok((await placesOf('--truth')).length > 20);
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
