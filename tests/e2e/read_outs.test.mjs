// Every panel that shows a pose says the same after random seeks, and what the server recorded of
// that frame: plots, 3D view, 3D plot, errors, pictures, time line; two flights with two estimators.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { flyPair, kPair } from './support/flights.mjs';
import { getJson, serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kSeed = 20260101;
const kSeeks = 6;
const kRate_hz = 20;
/** A whole number of frames, so that both flights have a frame at every instant that has one. */
const kOffset_s = 1.5;
const kEstimators = ['drifts', 'flat'];
const kAxes = ['x_m', 'y_m', 'z_m', 'roll_deg', 'pitch_deg', 'yaw_deg'];
const kErrors = ['error_m', 'error_along_m', 'error_across_m', 'error_up_m', 'error_rotation_deg'];
const kPanels = ['scene', 'plots', 'plots-errors', 'plot3d', 'errors', 'camera', 'depth'];
/** All of them on the screen at the same time. */
const kLayout = {
  row: [
    2200,
    { column: [5000, 'runs', 5000, 'errors'] },
    4300,
    { column: [5000, 'scene', 5000, 'plots'] },
    3500,
    { column: [3600, 'plot3d', 2400, { row: [5000, 'camera', 5000, 'depth'] }, 4000, 'plots-errors'] },
  ],
};

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

/** Mulberry32: the same numbers in every run of the test. */
function randomFrom(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let bits = Math.imul(state ^ (state >>> 15), 1 | state);
    bits = (bits + Math.imul(bits ^ (bits >>> 7), 61 | bits)) ^ bits;
    return ((bits ^ (bits >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** A text of the screen; null for "–". */
function numberOf(text) {
  const number = text.replace(/^[A-Z] /, '').replace('−', '-');
  return number === '–' ? null : Number(number);
}

/** Agrees up to the last digit shown. */
function assertShown(shown, wanted, digits, what) {
  if (wanted === null || shown === null) {
    assert.equal(shown, wanted, what);
    return;
  }
  const off = Math.abs(shown - wanted);
  assert.ok(off <= 0.5001 * 10 ** -digits, `${what}: shown ${shown}, recorded ${wanted}`);
}

describe('the read-outs of all panels', { skip, timeout: 600_000 }, () => {
  const random = randomFrom(kSeed);
  let stage;
  let page;

  before(async () => {
    stage = await openStage({ width: 1920, height: 1080 }, flyPair);
    dashboard = stage.dashboard;
    page = dashboard.page;
    const [a, b] = kPair;
    const panels = Buffer.from(JSON.stringify(kLayout)).toString('base64url');
    const runs = `run=${a.id}&run=${b.id}@${kOffset_s}&hide=A/strays&hide=B/strays`;
    await page.goto('about:blank');
    await dashboard.open(`${stage.server.address}#panels=${panels}&${runs}&view=orbit,215,60,300&t=3`);
    await dashboard.untilSameInstant(kPanels);
    await dashboard.until(() => document.querySelector('.errors .good') !== null);
  });

  after(() => stage?.close());

  /** What the server has of a run at a frame under an alignment, by label of the track. */
  const recorded = async ({ id }, letter, frame, alignment) => {
    const rows = new Map();
    for (const name of ['truth', ...kEstimators]) {
      const mode = name === 'truth' ? '' : `&alignment=${alignment}`;
      const columns = await getJson(stage.server, `/runs/${id}/trajectories/${name}?format=json${mode}`);
      const row = columns.frame.indexOf(frame);
      assert.ok(row >= 0, `frame ${frame} of ${name}`);
      const values = Object.entries(columns).map(([column, cells]) => [column, cells[row]]);
      rows.set(`${letter} ${name}`, Object.fromEntries(values));
    }
    return rows;
  };

  /** Everything on the screen that tells a pose or an error. */
  const shown = () =>
    page.evaluate(() => {
      const all = (selector) => [...document.querySelectorAll(selector)];
      const readouts = (panel) =>
        Object.fromEntries(
          all(`[data-panel=${panel}] .plot`).map((plot) => [
            plot.dataset.axis,
            Object.fromEntries(
              [...plot.querySelectorAll('.readout')].map((one) => [one.title, one.textContent]),
            ),
          ]),
        );
      return {
        poses: readouts('plots'),
        errors: readouts('plots-errors'),
        labels: all('.scene-label').map((label) => label.textContent),
        marks: document.querySelector('[data-panel=plot3d]').dataset.marks.split('; '),
        states: all('.errors [data-state-of]').map((cell) => [
          cell.dataset.run,
          cell.dataset.stateOf,
          cell.textContent,
        ]),
        pictures: all('[data-panel=camera] .picture-view, [data-panel=depth] .picture-view').map(
          (view) => [view.dataset.run, Number(view.dataset.frame)],
        ),
        time: document.querySelector('[data-role=time]').textContent,
        alignment: all('[data-role=alignment]').map((note) => note.textContent),
      };
    });

  /** How far the camera's picture of the main run is from the recorded one, mean of grey levels. */
  const pictureOff = (id, frame) =>
    page.evaluate(async ([run, k]) => {
      const answer = await fetch(`api/v1/runs/${run}/frames/${k}.jpg`);
      const image = await createImageBitmap(await answer.blob());
      const canvas = document.querySelector('[data-panel=camera] [data-main=true] canvas.picture');
      const copy = new OffscreenCanvas(canvas.width, canvas.height);
      copy.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
      const pixels = (one) => one.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
      const [drawn, wanted] = [pixels(canvas), pixels(copy)];
      return drawn.reduce((sum, value, i) => sum + Math.abs(value - wanted[i]), 0) / drawn.length;
    }, [id, frame]);

  const seek = {
    'time line': () => dashboard.seekAt('.track .bar', 0.2 + 0.6 * random(), kPanels),
    plot: () => dashboard.seekAt('[data-panel=plots] .u-over', 0.2 + 0.6 * random(), kPanels),
    keys: async () => {
      const { frame } = await dashboard.playback();
      await page.keyboard.press(random() < 0.5 ? 'ArrowLeft' : 'ArrowRight');
      await dashboard.until(
        (before) => document.querySelector('[data-panel=timeline]').dataset.frame !== String(before),
        frame,
      );
      await dashboard.untilSameInstant(kPanels);
    },
  };

  const check = async (alignment) => {
    await dashboard.untilStill('scene');
    await dashboard.untilStill('camera');
    await dashboard.until((mode) => {
      const notes = [...document.querySelectorAll('[data-role=alignment]')];
      return notes.every(({ textContent }) => textContent.includes(mode));
    }, alignment);
    const { frame } = await dashboard.playback();
    const [a, b] = kPair;
    const frame_b = frame - kOffset_s * kRate_hz;
    const rows = new Map([
      ...(await recorded(a, 'A', frame, alignment)),
      ...(await recorded(b, 'B', frame_b, alignment)),
    ]);
    const at = `frame ${frame}, ${alignment}`;
    const now = await shown();

    assert.equal(now.time, `00:${(frame / kRate_hz).toFixed(3).padStart(6, '0')}`, at);
    for (const axis of kAxes) {
      assert.deepEqual(Object.keys(now.poses[axis]), [...rows.keys()], at);
      for (const [label, row] of rows) {
        const digits = axis.endsWith('_deg') ? 2 : 1;
        assertShown(numberOf(now.poses[axis][label]), row[axis], digits, `${axis} of ${label}, ${at}`);
      }
    }
    const estimates = [...rows].filter(([label]) => !label.endsWith('truth'));
    for (const column of kErrors) {
      assert.ok(now.errors[column] !== undefined, `${column}, ${at}`);
      for (const [label, row] of estimates) {
        assertShown(numberOf(now.errors[column][label]), row[column], 3, `${column} of ${label}, ${at}`);
      }
    }

    const marks = new Map(now.marks.map((text) => /^(\w+ \w+) (.*)$/.exec(text).slice(1)));
    assert.deepEqual([...marks.keys()], [...rows.keys()], at);
    for (const [label, row] of rows) {
      const place = marks.get(label).split(' ').map(Number);
      ['x_m', 'y_m', 'z_m'].forEach((axis, i) =>
        assertShown(place[i], row[axis], 3, `${axis} of ${label} in the 3D plot, ${at}`),
      );
    }

    const labels = now.labels.filter((label) => !label.includes('strays'));
    assert.ok(labels.length >= 2, `${labels} in the 3D view, ${at}`);
    for (const text of labels) {
      const [, label, error = ''] = /^(\w+ \w+)(?: (.*) m)?$/.exec(text);
      const error_m = rows.get(label).error_m ?? 0;
      if (error === '') assert.ok(error_m < 0.0501, `${label} is ${error_m} m off, ${at}`);
      else assertShown(numberOf(error), error_m, error_m < 10 ? 2 : 0, `${label} in the 3D view, ${at}`);
    }

    const letters = { [a.id]: 'A', [b.id]: 'B' };
    for (const [run, name, state] of now.states) {
      if (!kEstimators.includes(name)) continue;
      assert.equal(state, rows.get(`${letters[run]} ${name}`).state, `${name}, ${at}`);
    }
    assert.equal(now.pictures.length, 4, at);
    for (const [run, picture] of now.pictures) {
      assert.equal(picture, run === a.id ? frame : frame_b, `picture of ${letters[run]}, ${at}`);
    }
    // Coded at another quality, it is a little off; the neighbours' are farther.
    const off = await pictureOff(a.id, frame);
    for (const other of [frame - 1, frame + 1]) {
      const other_off = await pictureOff(a.id, other);
      assert.ok(off < other_off, `${off} grey levels off, ${other_off} from frame ${other}, ${at}`);
    }
  };

  for (const alignment of ['init_scale', 'sim3', 'origin']) {
    step(`agree by ${alignment}`, async () => {
      await page.locator('#alignment').selectOption(alignment);
      const ways = Object.keys(seek);
      for (let i = 0; i < kSeeks; i += 1) {
        await seek[ways[i % ways.length]]();
        await check(alignment);
      }
      await dashboard.screenshot(`read_outs_${alignment}_1920x1080`);
    });
  }

  step('agree between two frames of the other flight', async () => {
    const [, b] = kPair;
    const offset_s = 1.333;
    await page.getByLabel('Offset of run B in seconds').fill(String(offset_s));
    await page.keyboard.press('Enter');
    await page.locator('#alignment').selectOption('init_scale');
    for (let i = 0; i < kSeeks; i += 1) {
      await seek['time line']();
      await dashboard.untilStill('scene');
      const { t_ns } = await dashboard.playback();
      const frames = (t_ns / 1e9 - offset_s) * kRate_hz;
      const [low, share] = [Math.floor(frames), frames - Math.floor(frames)];
      const [before, later] = await Promise.all(
        [low, low + 1].map((frame) => recorded(b, 'B', frame, 'init_scale')),
      );
      const now = await shown();
      const marks = new Map(now.marks.map((text) => /^(\w+ \w+) (.*)$/.exec(text).slice(1)));
      const places = new Map();
      for (const [label, row] of before) {
        const wanted = ['x_m', 'y_m', 'z_m'].map(
          (axis) => row[axis] + share * (later.get(label)[axis] - row[axis]),
        );
        places.set(label, wanted);
        const place = marks.get(label).split(' ').map(Number);
        place.forEach((value, k) => assertShown(value, wanted[k], 2, `${label} in the 3D plot`));
        ['x_m', 'y_m', 'z_m'].forEach((axis, k) =>
          assertShown(numberOf(now.poses[axis][label]), place[k], 1, `${axis} of ${label}`),
        );
      }
      const flat = now.labels.find((label) => label.startsWith('B flat'));
      assert.ok(flat !== undefined, `${now.labels}`);
      const text = / ([\d.]+) m$/.exec(flat)?.[1];
      const [estimate, truth] = ['B flat', 'B truth'].map((label) => places.get(label));
      const error_m = Math.hypot(...estimate.map((value, k) => value - truth[k]));
      if (text === undefined) assert.ok(error_m < 0.0501, `B flat is ${error_m} m off`);
      // The recorded places are rounded to millimetres.
      else assert.ok(Math.abs(Number(text) - error_m) < 0.007, `${flat} in the 3D view, recorded ${error_m}`);
    }
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
