// A headless Chromium with a new profile.
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { chromium } from 'playwright-core';

const kExecutable = process.env.CHROMIUM_BIN ?? '/usr/bin/chromium';
const kFlags = [
  '--headless',
  '--no-sandbox',
  '--disable-gpu',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

/** Why there is no browser; false when there is one. */
export function browserMissing() {
  return existsSync(kExecutable) ? false : `${kExecutable} is not installed`;
}

export async function openBrowser({ width, height }) {
  const profile = mkdtempSync(path.join(tmpdir(), 'overfly-chromium-'));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: kExecutable,
    headless: true,
    args: kFlags,
    viewport: { width, height },
  });
  const page = context.pages()[0] ?? (await context.newPage());
  return {
    page,
    async close() {
      await context.close();
      rmSync(profile, { recursive: true, force: true });
    },
  };
}
