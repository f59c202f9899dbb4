// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { existsSync, readFileSync } from 'node:fs';
import { chromium } from 'playwright-core';

const CHROMIUM = process.env.MCC_CHROMIUM ?? '/usr/bin/chromium';

/** Debian's Chromium without a window; WebGL is drawn by the CPU. */
export const LAUNCH_OPTIONS = {
  executablePath: CHROMIUM,
  args: ['--no-sandbox', '--disable-quic', '--disable-background-networking', '--disable-component-update', '--disable-sync',
    '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
};

/** How long anything in a page may take on a busy machine. It ends what hangs, and judges no speed. */
const PATIENCE_MS = 180_000;

/** A browser for this process, or the one of shared_browser.mjs, of which close() ends only what this process has opened. */
export function launchBrowser() {
  if (process.env.MCC_BROWSER) return chromium.connect(JSON.parse(readFileSync(process.env.MCC_BROWSER)).endpoint);
  if (!existsSync(CHROMIUM)) throw new Error(`${CHROMIUM} is missing; install chromium or name it in MCC_CHROMIUM`);
  return chromium.launch(LAUNCH_OPTIONS);
}

/**
 * Opens a page and waits for its module; `isReady` runs in the page. What the page says on its console is collected, violations of
 * its Content-Security-Policy among it.
 */
export async function openPage(browser, url, isReady) {
  const page = await browser.newPage({ viewport: { width: 400, height: 300 } });
  page.setDefaultTimeout(PATIENCE_MS);
  const messages = [];
  page.on('console', (message) => messages.push(`${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => messages.push(`error: ${error.message}`));
  await page.goto(url);
  try {
    await page.waitForFunction(isReady);
  } catch (error) {
    throw new Error(`${url} did not get ready: ${messages.join('\n')}`, { cause: error });
  }
  return { page, messages, violations: () => messages.filter((text) => text.includes('Content Security Policy')) };
}

/**
 * For openPage() of a plain page with the README's line: whether the service worker answers. The line loads the page again when the
 * worker takes it over; before that, what a test runs in the page may be cut off.
 */
export const isDecoding = () => globalThis.draw !== undefined && performance.getEntriesByType('navigation')[0].type === 'reload';
