// A headless Firefox with a new profile, driven by WebDriver BiDi.
import { execFileSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import puppeteer from 'puppeteer-core';
import { Dashboard } from './dashboard.mjs';

const kExecutable = process.env.FIREFOX_BIN ?? '/usr/bin/firefox-esr';

/** Firefox 140 lacks commands that the driver sends. */
const kTooOld = 140;

/** Why there is no Firefox that can be driven; false when there is one. */
export function firefoxMissing() {
  if (!existsSync(kExecutable)) return `${kExecutable} is not installed`;
  const version = execFileSync(kExecutable, ['--version'], {
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'ignore'],
  }).trim();
  const major = Number(/Firefox (\d+)/.exec(version)?.[1]);
  return major <= kTooOld && `${version} is too old: Debian's security updates have a later one`;
}

export async function openFirefox({ width, height }) {
  const browser = await puppeteer.launch({
    browser: 'firefox',
    executablePath: kExecutable,
    headless: true,
    // Its own search for updates and settings needs a network.
    extraPrefsFirefox: { 'app.update.enabled': false, 'network.captive-portal-service.enabled': false },
  });
  try {
    const [page] = await browser.pages();
    await page.setViewport({ width, height });
    return { page, version: await browser.version(), close: () => browser.close() };
  } catch (error) {
    await browser.close();
    throw error;
  }
}

/** The dashboard in Firefox: its driver differs from Chromium's in how it waits. */
export class FirefoxDashboard extends Dashboard {
  constructor(page) {
    super(page);
    page.on('console', (message) => {
      if (message.type() === 'error') this.complaints.push(message.text());
    });
  }

  async until(condition, argument, timeout = 30_000) {
    await this.page.waitForFunction(condition, { timeout, polling: 50 }, argument);
  }
}
