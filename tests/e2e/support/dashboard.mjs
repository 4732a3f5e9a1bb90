// The dashboard as a viewer uses it. Everything waits for a condition, never for a time.
import { mkdirSync } from 'node:fs';
import { setTimeout as pause } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import path from 'node:path';

const kScreenshots = fileURLToPath(new URL('../screenshots', import.meta.url));
const kPatience_ms = 30_000;

export class Dashboard {
  constructor(page) {
    this.page = page;
    this.complaints = [];
    page.setDefaultTimeout(kPatience_ms);
    page.on('pageerror', (error) => this.complaints.push(error.message));
  }

  async open(url) {
    // A machine that makes a world for another test may need more than a minute.
    await this.page.goto(url, { timeout: 4 * kPatience_ms });
    await this.until(
      () => document.querySelector('[data-role=connection]')?.dataset.status === 'open',
    );
  }

  /** Waits until a function of the page is true. */
  async until(condition, argument, timeout = kPatience_ms) {
    await this.page.waitForFunction(condition, argument, { timeout, polling: 50 });
  }

  /**
   * Waits until the layout has its place: after a new window size or a moved panel it takes it in
   * steps. Two looks at the panels, ten frames apart, must agree.
   */
  async untilSettled() {
    await this.page.evaluate(async (patience_ms) => {
      const look = () =>
        JSON.stringify(
          [...document.querySelectorAll('.header-bar, .timeline, .dv-groupview, .panel')].map((part) => {
            const { left, top, width, height } = part.getBoundingClientRect();
            return [left, top, width, height];
          }),
        );
      const frame = () => new Promise((done) => requestAnimationFrame(done));
      const end = performance.now() + patience_ms;
      let seen = '';
      while (look() !== seen) {
        if (performance.now() > end) throw new Error('the layout does not come to rest');
        seen = look();
        for (let i = 0; i < 10; i++) await frame();
      }
    }, kPatience_ms);
  }

  field(name) {
    return this.page.locator(`[id="field-${name}"]`);
  }

  /** Chooses a scenario and waits for its fields. */
  async chooseScenario(name) {
    await this.page.locator(`#scenario option[value="${name}"]`).waitFor({ state: 'attached' });
    const picker = this.page.locator('#scenario');
    if ((await picker.inputValue()) !== name) await picker.selectOption(name);
    await this.page.locator(`.fields[data-scenario="${name}"]`).waitFor();
  }

  async chooseEstimators(...types) {
    for (const box of await this.page.locator('[data-estimator]').all()) {
      await box.setChecked(types.includes(await box.getAttribute('data-estimator')));
    }
  }

  /** Closes the scenario's editor. Until it is closed it keeps the keyboard. */
  async closeEditor() {
    await this.page.locator('[data-role=close-editor]').click();
    await this.page.locator('.editor').waitFor({ state: 'hidden' });
  }

  /** Presses the button and waits for the run. @return its id */
  async launch() {
    const before = await this.runId();
    await this.page.getByRole('button', { name: 'Launch flight' }).click();
    await this.until((id) => {
      const chosen = document.querySelector('.run[aria-current=true]');
      return chosen !== null && chosen.dataset.run !== id;
    }, before);
    return this.runId();
  }

  runId() {
    return this.page.evaluate(
      () => document.querySelector('.run[aria-current=true]')?.dataset.run ?? null,
    );
  }

  /** A flight takes several times as long on a machine that does other work. */
  async untilStatus(id, status, timeout = 3 * kPatience_ms) {
    await this.until(
      ([run, wanted]) =>
        document.querySelector(`.run[data-run="${run}"]`)?.dataset.status === wanted,
      [id, status],
      timeout,
    );
  }

  /** Values next to the plots' titles that are cut off. */
  cutValues() {
    return this.page.evaluate(() =>
      [...document.querySelectorAll('.plot-title .readout')]
        .filter((readout) => {
          const title = readout.closest('.plot-title').getBoundingClientRect();
          const text = document.createRange();
          text.selectNodeContents(readout);
          const { left, right, bottom } = text.getBoundingClientRect();
          return left < title.left || right > title.right || bottom > title.bottom;
        })
        .map((readout) => readout.textContent),
    );
  }

  /** Frame number that a panel shows; null when it shows none. */
  frame(panel) {
    return this.page.evaluate((name) => {
      const text = document.querySelector(`[data-panel="${name}"]`)?.dataset.frame;
      return text === undefined ? null : Number(text);
    }, panel);
  }

  async untilFrames(panels, least = 0, timeout = kPatience_ms) {
    await this.until(
      ([names, low]) =>
        names.every(
          (name) =>
            Number(document.querySelector(`[data-panel="${name}"]`)?.dataset.frame ?? -1) >= low,
        ),
      [panels, least],
      timeout,
    );
  }

  /** Waits until these panels all show the frame at the playback cursor, standing still. */
  async untilSameInstant(panels = ['scene', 'camera', 'plots', 'errors']) {
    await this.until((names) => {
      const timeline = document.querySelector('[data-panel=timeline]');
      return (
        timeline.dataset.playing === 'false' &&
        timeline.dataset.frame !== undefined &&
        names.every(
          (name) =>
            document.querySelector(`[data-panel="${name}"]`)?.dataset.frame ===
            timeline.dataset.frame,
        )
      );
    }, panels);
  }

  async playback() {
    return this.page.evaluate(() => {
      const { frame, tNs, playing } = document.querySelector('[data-panel=timeline]').dataset;
      return { frame: Number(frame), t_ns: Number(tNs), playing: playing === 'true' };
    });
  }

  async untilPlaying(playing) {
    await this.until(
      (wanted) =>
        document.querySelector('[data-panel=timeline]').dataset.playing === String(wanted),
      playing,
    );
  }

  async untilSpeed(speed) {
    await this.until((wanted) => {
      const { dataset } = document.querySelector('[data-panel=timeline]');
      return dataset.speed === wanted && document.querySelector('#speed').value === wanted;
    }, String(speed));
  }

  async untilCursor(frame) {
    await this.until(
      (wanted) => document.querySelector('[data-panel=timeline]').dataset.frame === String(wanted),
      frame,
    );
  }

  /** Clicks at a share of the width of the time line or of a plot and waits for another instant. */
  async seekAt(selector, share, panels) {
    // A view that just came to rest may still move by a frame: that is not the click's doing.
    await this.untilSameInstant(panels);
    const { frame } = await this.playback();
    const box = await this.page.locator(selector).first().boundingBox();
    await this.page.mouse.click(box.x + box.width * share, box.y + box.height / 2);
    await this.until(
      (before) => document.querySelector('[data-panel=timeline]').dataset.frame !== String(before),
      frame,
    );
    await this.untilSameInstant(panels);
  }

  /** A digest of what a panel's canvas shows: of several pictures, that of the main run. */
  picture(panel) {
    return this.page.evaluate((name) => {
      const within = (part) => document.querySelector(`[data-panel="${name}"] ${part}`);
      const canvas = within('[data-main=true] canvas.picture') ?? within('canvas.picture');
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let sum = 0;
      let squares = 0;
      let digest = 0;
      for (let i = 0; i < data.length; i += 4) {
        sum += data[i];
        squares += data[i] * data[i];
        digest = (Math.imul(digest, 31) + data[i]) | 0;
      }
      const count = data.length / 4;
      const mean = sum / count;
      return { digest, mean, deviation: Math.sqrt(Math.max(0, squares / count - mean * mean)) };
    }, panel);
  }

  /** Waits until a panel's picture shows something: the first one may be of a panel without size. */
  async untilPictured(panel) {
    for (let tries = 0; (await this.picture(panel)).deviation <= 1; ++tries) {
      if (tries === 100) throw new Error(`the picture of ${panel} stays empty`);
      await pause(100);
    }
  }

  /** Waits until a panel's picture has stayed the same for as long as one takes to be drawn. */
  async untilStill(panel) {
    const end_ms = Date.now() + kPatience_ms;
    let before = null;
    for (let same = 0; same < 4; ) {
      if (Date.now() > end_ms) throw new Error(`the picture of ${panel} never stays the same`);
      const { digest } = await this.picture(panel);
      same = digest === before ? same + 1 : 0;
      before = digest;
      await pause(150);
    }
  }

  async untilPictureDiffers(panel, digest) {
    const end_ms = Date.now() + kPatience_ms;
    while ((await this.picture(panel)).digest === digest) {
      if (Date.now() > end_ms) throw new Error(`the picture of ${panel} stays the same`);
      await pause(50);
    }
  }

  /** Texts of the error table: row key -> one text an estimator. */
  errors() {
    return this.page.evaluate(() =>
      Object.fromEntries(
        [...document.querySelectorAll('.errors tr[data-row]')].map((row) => [
          row.dataset.row,
          [...row.querySelectorAll('td')].map((cell) => cell.textContent),
        ]),
      ),
    );
  }

  async screenshot(name) {
    mkdirSync(kScreenshots, { recursive: true });
    await this.page.screenshot({ path: path.join(kScreenshots, `${name}.png`) });
  }
}
