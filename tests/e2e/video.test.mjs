// Moving pictures as VP8 video by WebCodecs: what is sent, what is shown, and JPEG where the browser
// cannot decode video, or fails to.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing } from './support/browser.mjs';
import { Dashboard } from './support/dashboard.mjs';
import { flyCourse } from './support/flights.mjs';
import { serverMissing } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kRun = '20260101-000001-moving';
const kRate_hz = 31;
const kVp8 = 3;
const kKeyFlag = 8;

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

/** Without recorded images: the camera's pictures are rendered again and then encoded. */
function fly(runs) {
  const fields = ['duration_s=30', 'camera.width_px=640', 'camera.height_px=480', 'estimators=[]'];
  flyCourse(runs, kRun, fields);
  return {};
}

/** The page has no WebCodecs, as on a plain http address of another machine. */
function removeVideo() {
  delete globalThis.VideoDecoder;
}

/** Decodes the trial picture at the start, and fails at every picture of a stream. */
function breakVideo() {
  const Real = globalThis.VideoDecoder;
  globalThis.VideoDecoder = class {
    static opened = 0;
    static isConfigSupported = (config) => Real.isConfigSupported(config);
    constructor(events) {
      this.constructor.opened += 1;
      if (this.constructor.opened === 1) return new Real(events);
      this.events = events;
      this.state = 'unconfigured';
      this.decodeQueueSize = 0;
    }
    configure() {
      this.state = 'configured';
    }
    decode() {
      setTimeout(() => this.events.error(new DOMException('broken', 'EncodingError')));
    }
    close() {
      this.state = 'closed';
    }
  };
}

/** Pictures that arrive at a page, and what it says to the server. */
function listen(page) {
  const heard = { pictures: [], said: [], names: new Map() };
  page.on('websocket', (socket) => {
    socket.on('framesent', ({ payload }) => heard.said.push(JSON.parse(payload)));
    socket.on('framereceived', ({ payload }) => {
      if (typeof payload === 'string') {
        const message = JSON.parse(payload);
        if (message.type !== 'pictures') return;
        for (const { id, name } of message.pictures) heard.names.set(id, name);
        return;
      }
      const encoding = payload.readUInt16LE(36);
      heard.pictures.push({
        name: heard.names.get(payload.readUInt32LE(8)),
        encoding,
        bytes: payload.length,
        frame: Number(payload.readBigInt64LE(16)),
        key: (payload.readUInt32LE(44) & kKeyFlag) !== 0,
      });
    });
  });
  return heard;
}

describe('moving pictures', { skip, timeout: 600_000 }, () => {
  let stage;
  let heard;
  const pages = [];

  /** The camera's layout in a page of its own, at rest. */
  const open = async (prepare, t_s = 1) => {
    const page = await stage.browser.page.context().newPage();
    pages.push(page);
    if (prepare !== undefined) await page.addInitScript(prepare);
    dashboard = new Dashboard(page);
    heard = listen(page);
    await dashboard.open(`${stage.server.address}#layout=camera&run=${kRun}&t=${t_s}`);
    // At first the run is shown from its beginning.
    await dashboard.untilCursor(Math.floor(t_s * kRate_hz));
    await dashboard.untilSameInstant(['camera']);
  };
  const ofCamera = () => heard.pictures.filter(({ name }) => name === 'camera');
  const until = async (condition, what) => {
    const end_ms = Date.now() + 60_000;
    while (!condition()) {
      if (Date.now() > end_ms) {
        const video = ofCamera().filter(({ encoding }) => encoding === kVp8).length;
        throw new Error(`never: ${what}; ${video} of ${ofCamera().length} pictures are video`);
      }
      await dashboard.page.waitForTimeout(50);
    }
  };
  const toggle = async (playing) => {
    await dashboard.page.keyboard.press(' ');
    await dashboard.untilPlaying(playing);
  };
  /** Grey levels of the camera's picture on a grid, and its frame. */
  const grid = () =>
    dashboard.page.evaluate(() => {
      const panel = document.querySelector('[data-panel=camera]');
      const canvas = panel.querySelector('canvas.picture');
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      const levels = [];
      for (let y = 8; y < canvas.height; y += 16) {
        for (let x = 8; x < canvas.width; x += 16) levels.push(data[4 * (y * canvas.width + x)]);
      }
      const rate = panel.querySelector('[data-role=rate]');
      return { frame: Number(panel.dataset.frame), levels, rate: rate.textContent, hint: rate.title };
    });

  before(async () => {
    stage = await openStage({ width: 1600, height: 900 }, fly);
    // Its pictures would need the processor.
    await stage.browser.page.goto('about:blank');
  });

  after(() => stage?.close());

  step('come as video, and as a JPEG again when they come to rest', async () => {
    await open();
    // What the page has got is heard here a little later.
    await until(() => ofCamera().length > 0, 'a first picture');
    assert.ok(ofCamera().every(({ encoding }) => encoding !== kVp8));
    await toggle(true);
    await until(() => ofCamera().filter(({ encoding }) => encoding === kVp8).length > 20, '20 video pictures');
    await toggle(false);
    await dashboard.untilSameInstant(['camera']);
    await until(() => ofCamera().at(-1).encoding !== kVp8, 'a JPEG at rest');
    assert.equal(ofCamera().at(-1).frame, (await dashboard.playback()).frame);
    const video = ofCamera().filter(({ encoding }) => encoding === kVp8);
    assert.ok(video[0].key, 'the first one needs no other');
    assert.ok(video.filter(({ key }) => key).length <= 3, 'key pictures are rare');
    assert.ok(!heard.said.some(({ type }) => type === 'key'), 'none was lost');
    const shown = heard.said.filter(({ type }) => type === 'shown');
    assert.ok(shown.length > 10, 'the page says what it has shown');
  });

  step('have the grey levels of the picture at rest', async () => {
    await dashboard.page.keyboard.press('Home');
    await dashboard.untilCursor(0);
    await toggle(true);
    const count = ofCamera().length;
    await until(() => ofCamera().length > count + 20, '20 pictures');
    const moving = await grid();
    await toggle(false);
    const sent = () => ofCamera().filter(({ frame }) => frame === moving.frame);
    await until(() => sent().length > 0, 'the picture shown');
    assert.equal(sent()[0].encoding, kVp8);
    assert.match(moving.rate, /^\d+(\.\d)? Hz/);
    assert.match(moving.hint, /^Measured: .* Mbit\/s as VP8 video/);
    await dashboard.page.goto('about:blank');
    await open(removeVideo, moving.frame / kRate_hz + 0.001);
    const resting = await grid();
    assert.equal(resting.frame, moving.frame);
    assert.equal(resting.levels.length, moving.levels.length);
    const differences = resting.levels.map((level, i) => moving.levels[i] - level);
    const mean = (list) => list.reduce((sum, value) => sum + value, 0) / list.length;
    assert.ok(Math.abs(mean(differences)) < 1, `mean difference ${mean(differences)}`);
    const size = mean(differences.map(Math.abs));
    assert.ok(size < 4, `mean absolute difference ${size}`);
  });

  step('are JPEGs where the browser has no WebCodecs, of more than twice the bytes', async () => {
    await dashboard.page.goto('about:blank');
    await open(removeVideo);
    await toggle(true);
    const still = ofCamera().length;
    await until(() => ofCamera().length > still + 20, '20 pictures');
    const { hint } = await grid();
    assert.match(hint, /Mbit\/s as JPEG/);
    await toggle(false);
    const jpegs = ofCamera().slice(still, still + 20);
    assert.ok(jpegs.every(({ encoding }) => encoding !== kVp8));
    assert.ok(!heard.said.some(({ pictures }) => pictures?.some(({ encoding }) => encoding === 'vp8')));
    await dashboard.page.goto('about:blank');
    await open();
    await toggle(true);
    const after_key = () => ofCamera().filter(({ encoding, key }) => encoding === kVp8 && !key);
    await until(() => after_key().length > 20, '20 video pictures');
    await toggle(false);
    const mean = (list) => list.reduce((sum, { bytes }) => sum + bytes, 0) / list.length;
    const [video, jpeg] = [mean(after_key()), mean(jpegs)];
    console.log(`bytes of a picture: ${video.toFixed(0)} as VP8, ${jpeg.toFixed(0)} as JPEG`);
    assert.ok(2 * video < jpeg, `${video} bytes as VP8, ${jpeg} as JPEG`);
  });

  step('go on as JPEGs when the decoder fails again and again', async () => {
    await dashboard.page.goto('about:blank');
    await open(breakVideo);
    await toggle(true);
    await until(
      () => heard.said.some(({ type, pictures }) => type === 'subscribe' && pictures.some(({ name, encoding }) => name === 'camera' && encoding === undefined)),
      'a subscription without video',
    );
    assert.ok(heard.said.some(({ type }) => type === 'key'), 'it tried again first');
    const count = ofCamera().length;
    await until(() => ofCamera().length > count + 10, 'more pictures');
    await dashboard.untilFrames(['camera'], ofCamera().at(-1).frame);
    assert.notEqual(ofCamera().at(-1).encoding, kVp8);
    await toggle(false);
    await dashboard.untilSameInstant(['camera']);
    assert.deepEqual(dashboard.complaints, []);
  });

  step('of the 3D view come as video too, and rest as JPEG when the view is turned', async () => {
    await dashboard.page.goto('about:blank');
    await open();
    const ofScene = () => heard.pictures.filter(({ name }) => name === 'scene');
    await toggle(true);
    await until(() => ofScene().some(({ encoding }) => encoding === kVp8), 'video of the scene');
    // The rate takes no room from the tools.
    const tools = dashboard.page.locator('.dv-groupview:has([data-panel=scene]) .panel-tools');
    const widths = await tools.evaluate((list) => [list.scrollWidth, list.clientWidth]);
    assert.ok(widths[0] <= widths[1], `tools of ${widths[0]} px in ${widths[1]} px`);
    await dashboard.screenshot('video_playing');
    await toggle(false);
    await dashboard.untilSameInstant(['camera', 'scene']);
    await until(() => ofScene().at(-1).encoding !== kVp8, 'a JPEG at rest');
  });
});
