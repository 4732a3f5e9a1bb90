// A headless Firefox with a new profile, driven by WebDriver BiDi.
import { existsSync } from 'node:fs';
import puppeteer from 'puppeteer-core';
import { Dashboard } from './dashboard.mjs';

const kExecutable = process.env.FIREFOX_BIN ?? '/usr/bin/firefox-esr';

/** Why there is no Firefox; false when there is one. */
export function firefoxMissing() {
  return existsSync(kExecutable) ? false : `${kExecutable} is not installed`;
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
    await setViewport(page, width, height);
    return { page, version: await browser.version(), close: () => browser.close() };
  } catch (error) {
    await browser.close();
    throw error;
  }
}

/** Firefox 140 sets the size, but does not know the orientation, which the driver sets with it. */
async function setViewport(page, width, height) {
  await page.setViewport({ width, height }).catch((error) => {
    if (!/unknown command emulation\.setScreenOrientationOverride/.test(error.message)) throw error;
  });
  await page.waitForFunction((px) => globalThis.innerWidth === px, {}, width);
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
