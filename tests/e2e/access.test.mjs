// Access of a browser without the token, with a wrong one, with the right one, and after a restart of
// the server.
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import { browserMissing, openBrowser } from './support/browser.mjs';
import { Dashboard } from './support/dashboard.mjs';
import { openPrefixProxy } from './support/prefix_proxy.mjs';
import { makeRunsFolder, serverMissing, startServer } from './support/server.mjs';
import { makeStep } from './support/steps.mjs';

let dashboard;
const step = makeStep(() => dashboard);
const skip = serverMissing() || browserMissing();

describe('the token', { skip, timeout: 120_000 }, () => {
  const runs = makeRunsFolder();
  let server;
  let browser;

  before(async () => {
    server = await startServer({ runs: runs.folder });
    browser = await openBrowser({ width: 1280, height: 800 });
    dashboard = new Dashboard(browser.page);
  });

  after(async () => {
    await browser?.close();
    await server?.stop();
    runs.remove();
  });

  const untilOpen = () =>
    dashboard.until(
      () => document.querySelector('[data-role=connection]')?.dataset.status === 'open',
    );

  step('is asked for on a page that says where it is found', async () => {
    const answer = await browser.page.goto(`${server.url}/#run=none`);
    assert.equal(answer.status(), 401);
    const text = await browser.page.locator('main').innerText();
    assert.match(text, /requires its token/);
    assert.match(text, /http:\/\/127\.0\.0\.1:8480\/\?token=/);
    await dashboard.screenshot('token_1280x800');
    await browser.page.setViewportSize({ width: 360, height: 640 });
    await dashboard.screenshot('token_360x640');
    await browser.page.setViewportSize({ width: 1280, height: 800 });
  });

  step('is refused when it is another one', async () => {
    await browser.page.getByLabel('Token').fill('x'.repeat(32));
    await browser.page.getByRole('button', { name: 'Open' }).click();
    await browser.page.getByRole('alert').waitFor();
    assert.match(await browser.page.getByRole('alert').innerText(), /token is wrong/);
    await dashboard.screenshot('token_wrong_1280x800');
  });

  step('opens the dashboard and leaves the address bar, the place in the page stays', async () => {
    await browser.page.goto(`${server.url}/#run=none`);
    await browser.page.getByLabel('Token').fill(server.address);
    await browser.page.keyboard.press('Enter');
    await untilOpen();
    assert.doesNotMatch(browser.page.url(), /token/);
    const cookies = await browser.page.context().cookies();
    assert.equal(cookies.length, 1);
    assert.equal(cookies[0].name, `overfly_${server.port}`);
    assert.equal(cookies[0].httpOnly, true);
    assert.equal(cookies[0].sameSite, 'Strict');
    assert.equal(await browser.page.evaluate(() => document.cookie), '');
    await dashboard.until(() => document.querySelector('.notice')?.textContent.includes('none'));
  });

  step('is kept over a reload, and another page of the server', async () => {
    await browser.page.reload();
    await untilOpen();
    await browser.page.goto(`${server.url}/`);
    await untilOpen();
  });

  step('reports the end of the session after a restart of the server', async () => {
    await server.stop();
    server = await startServer({ runs: runs.folder, port: server.port });
    await dashboard.until(
      () => document.querySelector('[data-role=connection]').dataset.status === 'locked',
    );
    const chip = browser.page.locator('[data-role=connection]');
    assert.match(await chip.innerText(), /Session over/);
    await dashboard.screenshot('session_over_1280x800');
    await chip.click();
    await browser.page.getByLabel('Token').fill(server.token);
    await browser.page.keyboard.press('Enter');
    await untilOpen();
  });

  step('opens the dashboard behind a proxy under a path of its own', async () => {
    const proxy = await openPrefixProxy(server.port, '/overfly');
    try {
      await browser.page.context().clearCookies();
      await browser.page.goto(`${proxy.url}/?token=${server.token}#run=none`);
      await untilOpen();
      assert.equal(browser.page.url().split('#')[0], `${proxy.url}/`);
      const [cookie] = await browser.page.context().cookies();
      assert.equal(cookie.path, '/overfly');
      await browser.page.reload();
      await untilOpen();
      await dashboard.until(() => document.querySelector('#scenario')?.options.length > 0);
    } finally {
      await proxy.close();
    }
    await browser.page.goto(`${server.url}/?token=${server.token}`);
    await untilOpen();
  });

  step('logged no error in the page', () => {
    assert.deepEqual(dashboard.complaints, []);
  });
});
