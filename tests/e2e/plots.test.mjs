// The plots of two flights with three estimators each: moved in time, read, saved.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { flyCourse } from './support/flights.mjs';
import { getJson, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kIds = ['20260101-000001-slow', '20260101-000002-fast'];
const kEstimators = ['first', 'second', 'third'];
const kPanels = ['plots'];

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

/** Changes the answers of an estimator: it initialises, is lost in the middle, and misses ten frames. */
function disturb(folder, name) {
  const file = path.join(folder, 'estimates', `${name}.jsonl`);
  const lines = readFileSync(file, 'utf8').trimEnd().split('\n');
  const changed = lines.map((line, frame) => {
    const { t_ns } = JSON.parse(line);
    if (frame < 31) return JSON.stringify({ frame, map_id: 0, state: 'INITIALISING', t_ns });
    if (frame >= 310 && frame < 341) return JSON.stringify({ frame, map_id: 0, state: 'LOST', t_ns });
    if (frame >= 400 && frame < 410) return JSON.stringify({ frame, t_ns, dropped: true });
    return line;
  });
  writeFileSync(file, `${changed.join('\n')}\n`);
}

function fly(runs) {
  for (const [i, id] of kIds.entries()) {
    const estimators = kEstimators.map((name, k) => ({
      name,
      type: 'drifting',
      parameters: { drift: 0.01 * (k + 1) * (i + 1) },
    }));
    flyCourse(runs, id, [
      'duration_s=20',
      `flight.course.airspeed_m_s=${20 + 5 * i}`,
      'camera.width_px=160',
      'camera.height_px=120',
      `estimators=${JSON.stringify(estimators)}`,
    ]);
    disturb(path.join(runs, id), 'second');
  }
  return {};
}

describe('the plots', { skip, timeout: 600_000 }, () => {
  let stage;
  let page;

  before(async () => {
    stage = await openStage({ width: 1600, height: 900 }, fly);
    dashboard = stage.dashboard;
    page = dashboard.page;
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.address}#run=${kIds[0]}&run=${kIds[1]}&t=12`);
    await dashboard.untilFrames(kPanels);
    await dashboard.untilSettled();
    await page.locator('.dv-groupview:has([data-panel=plots]) .enlarge').click();
    await dashboard.untilSettled();
  });

  after(() => stage?.close());

  const chooseGroup = (name) => page.locator(`.tab[data-group=${name}]`).click();
  const whole = () => page.locator('[data-role=whole-flight]');
  const plotBox = (key) => page.locator(`.plot[data-axis=${key}] .u-over`).boundingBox();
  /** The part of the flight that is shown, in % of the time line: begin and width; null = everything. */
  const part = () =>
    page.locator('[data-role=plotted]').evaluate(({ hidden, style }) =>
      hidden ? null : [Number.parseFloat(style.left), Number.parseFloat(style.width)],
    );
  const frames = () =>
    page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  /** Acts, and waits until another part is shown and stays. */
  const moved = async (act) => {
    const before = JSON.stringify(await part());
    await act();
    await frames();
    await dashboard.until((old) => {
      const { hidden, style } = document.querySelector('[data-role=plotted]');
      const now = hidden ? null : [Number.parseFloat(style.left), Number.parseFloat(style.width)];
      return JSON.stringify(now) !== old;
    }, before);
    await frames();
    return part();
  };

  step('zooms with the wheel and moves with Shift', async () => {
    assert.equal(await part(), null);
    assert.ok(await whole().isHidden());
    const { x, y, width, height } = await plotBox('x_m');
    const middle = [x + width / 2, y + height / 2];
    await page.mouse.move(...middle);
    for (let i = 0; i < 8; i += 1) await page.mouse.wheel(0, -100);
    const zoomed_percent = 100 * Math.exp(-8 * 0.15); // eight notches
    await dashboard.until((wanted) => {
      const { hidden, style } = document.querySelector('[data-role=plotted]');
      return !hidden && Math.abs(Number.parseFloat(style.width) - wanted) < 0.1;
    }, zoomed_percent);
    const zoomed = await part();
    const { t_ns } = await dashboard.playback();
    await page.keyboard.down('Shift');
    const dragged = await moved(async () => {
      await page.mouse.down();
      await page.mouse.move(middle[0] + width / 4, middle[1], { steps: 4 });
      await page.mouse.up();
    });
    await page.keyboard.up('Shift');
    assert.ok(dragged[0] < zoomed[0], `${dragged} after ${zoomed}`);
    assert.ok(Math.abs(dragged[1] - zoomed[1]) < 0.01);
    const wheeled = await moved(() => page.mouse.wheel(120, 0));
    assert.ok(wheeled[0] > dragged[0], 'a wheel turned to the right shows later times');
    assert.equal((await dashboard.playback()).t_ns, t_ns, 'moving does not seek');
  });

  step('moves with the middle button, and with two fingers', async () => {
    const { x, y, width, height } = await plotBox('roll_deg');
    const [left, top] = [x + width / 2, y + height / 2];
    await page.mouse.move(left, top);
    const before = await part();
    const dragged = await moved(async () => {
      await page.mouse.down({ button: 'middle' });
      await page.mouse.move(left + 40, top, { steps: 3 });
      await page.mouse.up({ button: 'middle' });
    });
    assert.ok(dragged[0] < before[0]);
    const touch = await page.context().newCDPSession(page);
    const fingers = (type, ...places) =>
      touch.send('Input.dispatchTouchEvent', {
        type,
        touchPoints: places.map((at, id) => ({ x: at, y: top, id })),
      });
    const { t_ns } = await dashboard.playback();
    const pinched = await moved(async () => {
      await fingers('touchStart', left - 30);
      await fingers('touchStart', left - 30, left + 30);
      await fingers('touchMove', left - 90, left + 30);
      await fingers('touchMove', left - 90, left + 90);
      await fingers('touchEnd');
    });
    assert.ok(pinched[1] < dragged[1] / 2, 'two fingers zoom in');
    assert.equal((await dashboard.playback()).t_ns, t_ns, 'two fingers do not seek');
  });

  step('moves with the keys, and shows the whole flight again', async () => {
    await page.locator('[data-panel=plots] .plot-grid').focus();
    const before = await part();
    const later = await moved(() => page.keyboard.press('ArrowRight'));
    assert.ok(later[0] > before[0]);
    const { frame } = await dashboard.playback();
    const nearer = await moved(() => page.keyboard.press('+'));
    assert.ok(nearer[1] < later[1]);
    assert.equal((await dashboard.playback()).frame, frame, 'the keys do not step');
    assert.ok(await whole().isVisible());
    await dashboard.screenshot('plots_zoomed');
    await whole().click();
    await dashboard.until(() => document.querySelector('[data-role=plotted]').hidden);
    assert.ok(await whole().isHidden());
    await page.keyboard.press('Control+k');
    await page.keyboard.type('Plots: zoom in');
    await page.keyboard.press('Enter');
    await dashboard.until(() => !document.querySelector('[data-role=plotted]').hidden);
    const { x, y, width, height } = await plotBox('z_m');
    await page.mouse.dblclick(x + width / 2, y + height / 2);
    await dashboard.until(() => document.querySelector('[data-role=plotted]').hidden);
  });

  step('shows the value of every curve, also of eight', async () => {
    // Away from the plots the values are those at the clock's time.
    await dashboard.seekAt('.track .bar', 0.8, kPanels);
    await page.mouse.move(2, 2);
    const readouts = page.locator('.plot[data-axis=y_m] .readout');
    assert.equal(await readouts.count(), 8);
    await dashboard.until(() =>
      [...document.querySelectorAll('.plot[data-axis=y_m] .readout')].every((one) =>
        /^[AB] [−\d]/.test(one.textContent),
      ),
    );
    const { x, y, width, height } = await plotBox('y_m');
    await page.mouse.move(x + width * 0.9, y + height * 0.9);
    const tip = page.locator('[data-role=plot-tip]');
    await tip.waitFor();
    const rows = await tip.locator('.plot-tip-rows > div').allInnerTexts();
    const names = ['A truth', 'B truth', ...kEstimators.flatMap((one) => [`A ${one}`, `B ${one}`])];
    const texts = rows.map((text) => text.split('\n'));
    assert.deepEqual(texts.map(([name]) => name).sort(), names.sort());
    const values = texts.map(([, value]) => Number(/^([−\d.]+) m$/.exec(value)[1].replace('−', '-')));
    assert.deepEqual(values, [...values].sort((a, b) => b - a), 'from top to bottom');
    assert.equal(await tip.locator('[data-nearest]').innerText(), rows.at(-1), 'the lowest is nearest');
    await dashboard.screenshot('plots_values');
    await page.mouse.move(x + width * 0.9, y + 2);
    await dashboard.until(
      () => document.querySelector('.plot-tip-rows > div')?.dataset.nearest === 'true',
    );
    await page.mouse.move(2, 2);
    await tip.waitFor({ state: 'hidden' });
  });

  /** Whether something below a plot's curves has a colour, at a share of its width. */
  const hasBelow = (key, share, colour) =>
    page.evaluate(
      ([axis, at, wanted]) => {
        const plot = document.querySelector(`.plot[data-axis=${axis}]`);
        const canvas = plot.querySelector('canvas');
        const [outer, inner] = [canvas, plot.querySelector('.u-over')].map((one) => one.getBoundingClientRect());
        const ratio = canvas.width / outer.width;
        const x = Math.floor((inner.left - outer.left + inner.width * at) * ratio);
        const y = Math.ceil((inner.bottom - outer.top) * ratio);
        const { data } = canvas.getContext('2d').getImageData(x, y, 1, canvas.height - y);
        const colours = Array.from({ length: data.length / 4 }, (_, i) => data.slice(4 * i, 4 * i + 4).join(' '));
        return colours.includes(`${wanted} 255`);
      },
      [key, share, colour],
    );

  step('shows the states of the estimators below the curves and names them', async () => {
    const legend = page.locator('[data-role=plot-legend]').first();
    const words = await legend.innerText();
    for (const word of ['A truth', 'B third', 'initialising', 'tracking', 'lost']) assert.ok(words.includes(word), word);
    // The second estimator of both runs is lost from 10 to 11 s of 20.
    const shown = await page.evaluate(() => {
      const probe = document.createElement('span');
      document.body.append(probe);
      const colour = (name) => {
        probe.style.color = `var(--${name})`;
        return getComputedStyle(probe).color.match(/\d+/g).slice(0, 3).join(' ');
      };
      return { lost: colour('bad'), second: colour('estimate-2') };
    });
    for (const plot of ['x_m', 'yaw_deg']) {
      assert.ok(await hasBelow(plot, 10.5 / 20, shown.lost), `${plot}: lost`);
      assert.ok(!(await hasBelow(plot, 10.5 / 20, shown.second)), `${plot}: not tracking`);
      assert.ok(!(await hasBelow(plot, 15 / 20, shown.lost)), `${plot}: not lost`);
      assert.ok(await hasBelow(plot, 15 / 20, shown.second), `${plot}: tracking`);
    }
    const { x, y, width, height } = await plotBox('y_m');
    await page.mouse.move(x + (width * 10.5) / 20, y + height / 2);
    await page.locator('.plot-tip-more', { hasText: 'A second: lost' }).waitFor();
    await dashboard.screenshot('plots_states');
  });

  step('says on the time line which estimator was in which state, from when to when', async () => {
    const bar = await page.locator('.track .bar').boundingBox();
    await page.mouse.move(bar.x + (bar.width * 10.5) / 20, bar.y + bar.height / 2);
    const tip = page.locator('.track .tip');
    await tip.filter({ hasText: 'A second: lost 00:10.000 – 00:11.000' }).waitFor();
    await tip.filter({ hasText: 'B first: tracking 00:00.000 – 00:' }).waitFor();
    assert.match(await page.locator('[data-role=fault-legend]').innerText(), /initialising\s*tracking\s*lost/);
    const strips = await page.locator('.track .strips').boundingBox();
    assert.ok(strips.y >= bar.y - 0.5, 'the strips stay inside the bar');
    await dashboard.screenshot('timeline_states');
    await page.mouse.move(2, 2);
  });

  step('counts the frames that an estimator has missed', async () => {
    await chooseGroup('estimates');
    const valuesAt = async (axis, share, wanted) => {
      await page.locator(`.plot[data-axis=${axis}] .readout`).first().waitFor();
      const { x, y, width, height } = await plotBox(axis);
      await page.mouse.move(x + width * share, y + height / 2);
      await dashboard.until(
        ([of, texts]) => {
          const all = document.querySelectorAll(`.plot[data-axis=${of}] .readout`);
          return [...all].map(({ textContent }) => textContent).join() === texts;
        },
        [axis, wanted],
      );
    };
    await valuesAt('missed_frames', 0.3, 'A 0,A 0,A 0,B 0,B 0,B 0');
    await valuesAt('missed_frames', 0.9, 'A 0,A 10,A 0,B 0,B 10,B 0');
    await valuesAt('dropped_frames', 0.3, 'A 0,A 0,A 0,B 0,B 0,B 0');
    await valuesAt('dropped_frames', 0.9, 'A 0,A 10,A 0,B 0,B 10,B 0');
    assert.equal(await page.locator('.plot[data-axis=unanswered_frames]').count(), 0);
    await dashboard.screenshot('plots_missed');
    await page.mouse.move(2, 2);
    await chooseGroup('pose');
  });

  const save = async (panel, format) => {
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.locator(`.dv-groupview:has([data-panel=${panel}]) .plot-files`).selectOption(format),
    ]);
    return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
  };
  /** Size of an SVG file as the browser shows it, and how many of its pixels are not the background's. */
  const rendered = (svg) =>
    page.evaluate(async (text) => {
      const problems = new DOMParser().parseFromString(text, 'image/svg+xml').querySelectorAll('parsererror');
      const image = new Image();
      image.src = URL.createObjectURL(new Blob([text], { type: 'image/svg+xml' }));
      await image.decode();
      const canvas = document.createElement('canvas');
      [canvas.width, canvas.height] = [image.width, image.height];
      const pen = canvas.getContext('2d');
      pen.drawImage(image, 0, 0);
      const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
      let drawn = 0;
      for (let i = 4; i < data.length; i += 4) {
        if ([0, 1, 2].some((k) => data[i + k] !== data[k])) drawn += 1;
      }
      return { problems: problems.length, width: canvas.width, height: canvas.height, drawn };
    }, svg);
  /** Saves every format of a panel and looks at the files. @return the CSV's lines */
  const saveAll = async (panel, name, words) => {
    const [csv, svg, png] = [await save(panel, 'csv'), await save(panel, 'svg'), await save(panel, 'png')];
    assert.deepEqual([csv.name, svg.name, png.name], ['csv', 'svg', 'png'].map((end) => `overfly-${name}.${end}`));
    const text = svg.bytes.toString();
    writeFileSync(new URL(`./screenshots/saved_${name}.png`, import.meta.url), png.bytes);
    const { problems, width, height, drawn } = await rendered(text);
    assert.equal(problems, 0);
    assert.ok(drawn > 2000, `${drawn} pixels of ${name} are drawn`);
    for (const word of words) assert.ok(text.includes(word), `${word} is in the file`);
    assert.ok(!text.includes('var('), 'a file has colours, no variables');
    assert.equal(png.bytes.readUInt32BE(16), 2 * width, 'width of the PNG');
    assert.equal(png.bytes.readUInt32BE(20), 2 * height, 'height of the PNG');
    return csv.bytes.toString().trimEnd().split('\n');
  };

  step('saves paths', async () => {
    await chooseGroup('path');
    await page.locator('.path-plot').first().waitFor();
    await dashboard.untilSettled();
    const lines = await saveAll('plots', 'path', ['From above', 'From the south', 'A truth', 'B third']);
    assert.equal(lines[0], 'run,track,t_s,x_m,y_m,z_m');
    const truth = lines.filter((line) => line.startsWith(`${kIds[0]},truth,`));
    assert.equal(truth.length, 621);
    await chooseGroup('pose');
  });

  step('plots relative errors over the length of sub-paths', async () => {
    await chooseGroup('drift');
    const plot = page.locator('[data-axis=translation_percent]');
    await plot.waitFor();
    await dashboard.untilSettled();
    const { estimators } = await getJson(stage.server, `/runs/${kIds[1]}/metrics`);
    const { relative } = estimators.third.alignments.init_scale;
    const wanted = relative.find(({ length_m }) => length_m === 200).translation_percent.toFixed(3);
    const longest = Math.max(...relative.map(({ length_m }) => length_m));
    const { x, y, width, height } = await plot.locator('.path-area').boundingBox();
    // The axis ends 8 % beyond the greatest length; 48 and 16 px are left and right of it.
    await page.mouse.move(x + 48 + ((width - 64) * 200) / (1.08 * longest), y + height / 3);
    const tip = page.locator('[data-role=plot-tip]');
    await tip.filter({ hasText: 'Translation error · 200 m' }).waitFor();
    const row = tip.locator('.plot-tip-rows > div', { hasText: 'B third' });
    assert.equal((await row.innerText()).split('\n')[1], `${wanted} %`);
    await dashboard.screenshot('plots_drift');
    await page.mouse.move(2, 2);
    const lines = await saveAll('plots', 'drift', ['Translation error [%]', 'Rotation error [deg / 100 m]', 'A first']);
    assert.equal(lines[0], 'figure,estimate,length_m,value,sub_paths');
    const saved = lines.find((line) => line.startsWith('translation_percent,B third,200,'));
    assert.equal(Number(saved.split(',')[3]).toFixed(3), wanted);
    await chooseGroup('pose');
  });

  step('saves the 3D plot', async () => {
    await page.locator('.dv-groupview:has([data-panel=plots]) .enlarge').click();
    await page.keyboard.press('Control+k');
    await page.keyboard.type('Show 3D plot');
    await page.keyboard.press('Enter');
    await dashboard.until(() => document.querySelector('[data-panel=plot3d]')?.dataset.draws > 0);
    await dashboard.untilSettled();
    await page.locator('.dv-groupview:has([data-panel=plot3d]) .enlarge').click();
    await dashboard.untilSettled();
    const lines = await saveAll('plot3d', '3d', ['x east [m]', 'z up [m]', 'B second']);
    assert.ok(lines.length > 8 * 580);
    await page.locator('.dv-groupview:has([data-panel=plot3d]) .enlarge').click();
  });

  step('saves the box plots and histograms of repeated flights', async () => {
    await page.keyboard.press('Control+k');
    await page.keyboard.type('Show Repeated flights');
    await page.keyboard.press('Enter');
    await page.locator('#repeats-choice').selectOption('all');
    await page.locator('[data-box=third]').waitFor();
    await dashboard.untilSettled();
    const lines = await saveAll('repeats', 'repeats', ['Position RMSE [m]', 'second', 'median']);
    assert.equal(lines[0], 'estimator,run,position_rmse_m');
    assert.equal(lines.length, 7);
  });
});
