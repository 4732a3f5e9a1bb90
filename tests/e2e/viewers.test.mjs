// A viewer's address: everything can be looked at, nothing can be started or changed; the operator's
// page beside it has all controls.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe } from 'node:test';
import { browserMissing, openBrowser } from './support/browser.mjs';
import { Dashboard } from './support/dashboard.mjs';
import { flyCourse, kBlackout } from './support/flights.mjs';
import { getJson, launchCourse, serverMissing, startServer } from './support/server.mjs';
import { openStage } from './support/stage.mjs';
import { makeStep } from './support/steps.mjs';

const kSize = { width: 1280, height: 800 };
const kRun = '20260101-000001-seen';
const kPanels = ['scene', 'camera', 'plots', 'errors'];

/** Controls of the dashboard that only operators have, and what all have. */
const kDashboard = {
  changing: [
    '.launch-form [type=submit]',
    '[data-role=open-predict]',
    '[data-role=open-hunt]',
    '[data-role=open-connect]',
    '.run [data-role=delete]',
    '.run [data-role=edit-notes]',
    '.run [data-role=repeat]',
    '.run [data-role=explain]',
    '[data-role=explain-estimator]',
  ],
  free: [
    '#scenario',
    '[data-role=edit-json]',
    '[data-role=open-logs]',
    '.run [data-role=open]',
    '.run [data-role=compare]',
    '[data-role=layout-menu]',
    '.report-button',
  ],
  note: '.launch-form .viewer-note',
};

/** The same of the pages, and what opens them. */
const kPages = {
  scenario: {
    opener: 'edit-json',
    changing: ['.save-bar', '[data-role=launch-edited]'],
    free: ['[data-section=camera]', '[data-role=close-editor]'],
    note: '.editor-foot .viewer-note',
  },
  logs: {
    opener: 'open-logs',
    changing: ['.upload-line .secondary', '[data-log-estimator]', '.log-form [type=submit]'],
    free: ['[data-role=log-rows]', '#log-source'],
    note: '.log-form .viewer-note',
  },
  calibration: {
    opener: 'open-calibration',
    changing: ['#calibration-kind', '[data-role=begin-calibration]'],
    free: ['[data-role=saved-calibrations]'],
    note: '.calibration-side .viewer-note',
  },
  missions: {
    opener: 'open-missions',
    changing: ['[data-role=mission-save]', '[data-role=mission-save-copy]', '[data-role=mission-fly]'],
    free: ['#mission-open', '[data-role=mission-import]', '[data-role=mission-export]'],
    note: '.mission-bar .viewer-note',
  },
  sweeps: {
    opener: 'open-sweeps',
    changing: ['[data-role=new-sweep]'],
    free: [],
    note: '[data-panel=sweeps] .viewer-note',
  },
  studies: {
    opener: 'open-studies',
    changing: ['[data-role=new-explain]', '[data-role=new-predict]', '[data-role=new-hunt]'],
    free: [],
    note: '[data-panel=studies] .viewer-note',
  },
  scoring: {
    opener: 'open-scores',
    changing: ['[data-role=upload-scores]'],
    free: ['.score-search', '#score-alignment'],
    note: null,
  },
};

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

/** Waits until the controls of a part of the page are those that a viewer, or an operator, has. */
async function untilOffered(page, { changing, free, note }, isViewer) {
  const forViewers = note === null ? [] : [note];
  const [shown, hidden] = isViewer ? [forViewers, changing] : [changing, forViewers];
  for (const [selectors, state] of [
    [[...free, ...shown], 'visible'],
    [hidden, 'hidden'],
  ]) {
    for (const selector of selectors) await page.locator(selector).first().waitFor({ state });
  }
}

/** Opens a page over the dashboard, looks at its controls, and closes it. */
async function lookAtPage(page, name, isViewer) {
  const panel = page.locator(`[data-panel=${name}]`);
  await page.locator(`[data-role=${kPages[name].opener}]`).click();
  await panel.getByRole('heading', { level: 2 }).first().waitFor();
  await untilOffered(page, kPages[name], isViewer);
  if (isViewer) await dashboard.screenshot(`viewer_${name}_1280x800`);
  await panel.getByLabel('Close', { exact: true }).click();
  await panel.waitFor({ state: 'hidden' });
}

/** Commands that the palette offers for some words. */
async function commandsFor(page, words) {
  await page.keyboard.press('Control+k');
  await page.locator('#palette-input').fill(words);
  const ids = await page.$$eval('#palette-list li', (items) =>
    items.map(({ dataset }) => dataset.command),
  );
  await page.keyboard.press('Escape');
  await page.locator('.palette').waitFor({ state: 'hidden' });
  return ids;
}

/** Sends a request as a page does. @return status and error code of the answer */
function ask(page, method, route, body) {
  return page.evaluate(
    async ([asked, place, sent]) => {
      const json = { 'content-type': 'application/json' };
      const options = sent === undefined ? {} : { headers: json, body: JSON.stringify(sent) };
      const answer = await fetch(`api/v1${place}`, { method: asked, ...options });
      const text = await answer.text();
      return { status: answer.status, error: answer.ok ? null : JSON.parse(text).error };
    },
    [method, route, body],
  );
}

describe('a viewer', { skip, timeout: 600_000 }, () => {
  let stage;
  let browser;
  let page;
  let operator;
  let viewerTokenFile;
  let viewerAddress;

  before(async () => {
    stage = await openStage(kSize, (runs) => {
      flyCourse(runs, kRun, kBlackout);
      viewerTokenFile = path.join(path.dirname(runs), 'viewer_token');
      return { viewerTokenFile };
    });
    operator = stage.dashboard;
    const token = readFileSync(viewerTokenFile, 'utf8').trim();
    assert.notEqual(token, stage.server.token);
    viewerAddress = `${stage.server.url}/?token=${token}`;
    browser = await openBrowser(kSize);
    page = browser.page;
    dashboard = new Dashboard(page);
    await dashboard.open(`${viewerAddress}#run=${kRun}`);
  });

  after(async () => {
    await browser?.close();
    await stage?.close();
  });

  const chip = () => page.locator('[data-role=view-only]');

  step('is told so by the page', async () => {
    assert.doesNotMatch(page.url(), /token/);
    await chip().waitFor({ state: 'visible' });
    assert.equal(await chip().innerText(), 'View only');
    assert.match(await chip().getAttribute('title'), /operator's address/);
    await untilOffered(page, kDashboard, true);
    const note = page.locator(kDashboard.note);
    assert.match(await note.innerText(), /look at everything.*operator's address/);
    await dashboard.untilSameInstant(kPanels);
    await dashboard.screenshot('viewer_1280x800');
  });

  step('is told so without a stream too', async () => {
    const other = await page.context().newPage();
    await other.routeWebSocket(/\/api\/v1\/stream/, (socket) => socket.close());
    await other.goto(new URL('/', page.url()).href);
    await other.locator('[data-role=view-only]').waitFor({ state: 'visible' });
    await other.locator(kDashboard.note).waitFor();
    assert.equal(await other.locator('.launch-form [type=submit]').isVisible(), false);
    await other.close();
  });

  step('plays, seeks, compares and reads as everybody', async () => {
    await page.keyboard.press('Home');
    await dashboard.untilCursor(0);
    await page.keyboard.press(' ');
    await dashboard.untilPlaying(true);
    await dashboard.untilFrames(['timeline', 'camera', 'scene'], 8);
    await page.keyboard.press(' ');
    await dashboard.untilPlaying(false);
    await dashboard.seekAt('.timeline .track', 0.5, kPanels);
    await page.locator('[data-mode=top]').click();
    await dashboard.untilPictured('scene');
  });

  step('chooses scenarios and has changes of them checked', async () => {
    await dashboard.chooseScenario('course');
    await dashboard.field('seed').fill('12');
    await page.locator('[data-role=edit-json]').click();
    await page.locator('[data-check=done]', { hasText: 'no errors' }).waitFor();
    await dashboard.closeEditor();
  });

  step('opens a mission and has it checked', async () => {
    await page.locator('[data-role=open-missions]').click();
    const opener = page.locator('#mission-open');
    await opener.locator('option[value=airfield_mission]').waitFor({ state: 'attached' });
    await opener.selectOption('airfield_mission');
    // The server's verdict, not that it works on it.
    const verdict = page.locator('[data-role=mission-checks] > :is(.fine, [data-kind])').first();
    await verdict.waitFor({ state: 'visible' });
    assert.notEqual(await verdict.getAttribute('data-kind'), 'error');
    await page.keyboard.press('Control+s');
    await page.locator('.mission-page').getByLabel('Close', { exact: true }).click();
    assert.equal((await getJson(stage.server, '/scenarios')).scenarios.some(({ saved }) => saved), false);
  });

  step('is told so on a narrow screen too', async () => {
    await page.setViewportSize({ width: 360, height: 640 });
    await dashboard.untilSettled();
    for (const part of [chip(), page.locator('.help-button')]) {
      const { x, width } = await part.boundingBox();
      assert.ok(x >= 0 && x + width <= 360, 'a part of the bar is cut off');
    }
    await dashboard.screenshot('viewer_360x640');
    await page.setViewportSize(kSize);
    await dashboard.untilSettled();
  });

  step('is offered nothing that starts or changes something', async () => {
    for (const name of Object.keys(kPages)) await lookAtPage(page, name, true);
    const seen = await page.$$eval('[data-changes]', (parts) =>
      parts.filter((part) => part.checkVisibility()).map((part) => part.outerHTML),
    );
    assert.deepEqual(seen, []);
    assert.deepEqual(await commandsFor(page, 'predict where'), []);
    assert.deepEqual(await commandsFor(page, 'autopilot'), []);
    assert.deepEqual(await commandsFor(page, 'explain why'), []);
    assert.deepEqual(await commandsFor(page, 'flight logs'), ['logs']);
  });

  step('launches nothing with the keyboard', async () => {
    const sent = [];
    const note = (request) => request.method() !== 'GET' && sent.push(request.url());
    page.on('request', note);
    await dashboard.field('duration_s').press('Enter');
    for (let i = 0; i < 60; i += 1) {
      await page.keyboard.press('Tab');
      const hidden = await page.evaluate(
        () => document.activeElement?.closest('[data-changes]') !== null,
      );
      assert.equal(hidden, false, 'a hidden control has the focus');
    }
    page.off('request', note);
    assert.deepEqual(sent, []);
    assert.equal((await getJson(stage.server, '/runs')).runs.length, 1);
  });

  step('is refused by the server what the page does not offer', async () => {
    for (const [method, route, body] of [
      ['DELETE', `/runs/${kRun}`],
      ['PUT', `/runs/${kRun}/notes`, { tags: ['mine'], note: '' }],
      ['POST', '/runs', { scenario: 'course', overrides: {} }],
      ['DELETE', '/scenarios/course'],
    ]) {
      const { status, error } = await ask(page, method, route, body);
      assert.equal(status, 403, `${method} ${route}`);
      assert.equal(error.code, 'read_only');
      assert.ok(error.message.length > 0);
    }
    assert.deepEqual(await ask(page, 'GET', `/runs/${kRun}`), { status: 200, error: null });
    const [{ id, tags }] = (await getJson(stage.server, '/runs')).runs;
    assert.deepEqual([id, tags], [kRun, []]);
  });

  step('leaves the operator all controls', async () => {
    assert.equal(await operator.page.locator('[data-role=view-only]').isVisible(), false);
    await operator.page.locator(`.run[data-run="${kRun}"] [data-role=open]`).click();
    await operator.untilSameInstant(kPanels);
    await untilOffered(operator.page, kDashboard, false);
    for (const name of Object.keys(kPages)) await lookAtPage(operator.page, name, false);
    assert.deepEqual(await commandsFor(operator.page, 'predict where'), ['predict']);
    assert.deepEqual(operator.complaints, []);
  });

  step('watches a flight that the operator starts, and cannot stop it', async () => {
    const id = await launchCourse(stage.server, { duration_s: 600 });
    await dashboard.untilStatus(id, 'running');
    await operator.untilStatus(id, 'running');
    const stop = `.run[data-run="${id}"] [data-role=stop]`;
    await operator.page.locator(stop).waitFor({ state: 'visible' });
    assert.equal(await page.locator(stop).isVisible(), false);
    await page.locator(`.run[data-run="${id}"] [data-role=open]`).click();
    await dashboard.untilFrames(['scene', 'camera'], 5);
    const refused = await ask(page, 'POST', `/runs/${id}/cancel`);
    assert.deepEqual([refused.status, refused.error.code], [403, 'read_only']);
    await dashboard.screenshot('viewer_live_1280x800');
    await operator.page.locator(stop).click();
    await dashboard.untilStatus(id, 'cancelled');
  });

  step('becomes an operator with the operator’s cookie, without a reload', async () => {
    await page.evaluate(() => {
      window.isTheSame = true;
    });
    const other = await page.context().newPage();
    await other.goto(stage.server.address);
    await other.close();
    await stage.server.stop();
    const { folder: runs, tokenFile } = stage.runs;
    const { port } = stage.server;
    stage.server = await startServer({ runs, tokenFile, viewerTokenFile, port });
    await chip().waitFor({ state: 'hidden' });
    await untilOffered(page, { ...kDashboard, changing: ['.launch-form [type=submit]'] }, false);
    assert.equal(await page.evaluate(() => window.isTheSame), true);
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
