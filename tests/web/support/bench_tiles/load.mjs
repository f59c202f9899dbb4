// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// How long CesiumJS takes to load a tileset in Chromium, each time in a profile that has seen nothing.
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { launchBrowser } from '../../browser/support/browser.mjs';
import { startServer } from '../../browser/support/server.mjs';
import { startLink } from './link.mjs';
import { BY_WORKER, OURS } from './make.mjs';
import { median } from './runs.mjs';
import { filesIn } from './tileset.mjs';

/**
 * What is added to the address of the page by row, and when it is ready. With the service worker, it loads itself again as soon as the worker
 * has it, so that a worker alone is not enough.
 */
const PAGES = {
  [OURS]: { query: '&cesium', isReady: () => globalThis.load !== undefined && globalThis.isRegistered },
  [BY_WORKER]: {
    query: '&worker',
    isReady: () => globalThis.load !== undefined && navigator.serviceWorker.controller !== null
      && performance.getEntriesByType('navigation')[0].type === 'reload',
  },
};
const PLAIN_PAGE = { query: '', isReady: () => globalThis.load !== undefined };

/**
 * @param {Object<string, string>} folders the tilesets by row; beside each is FOLDER.br with what brotli made of its contents
 * @param {Object<string, object | undefined>} links by name; undefined: none
 * @param {{ runs: number, distances: Object<string, number> }} settings  distances of the camera, in radii of the tileset's sphere
 * @returns { [link]: { [camera]: { [row]: { ms, tiles, bytes, failed } } } }, medians
 */
export async function measureLoads(folders, tileset, links, { runs, distances }, say) {
  const server = await startServer(new Map());
  const places = Object.fromEntries(Object.keys(folders).map((row, i) => [row, `tileset-${i}`])); // engines rewrite names with commas
  for (const [row, folder] of Object.entries(folders)) serveFolder(server.files, places[row], folder);
  const browser = await launchBrowser();
  const results = {};
  try {
    for (const [name, speed] of Object.entries(links)) {
      const link = speed === undefined ? undefined : await startLink(Number(new URL(server.origin).port), speed);
      results[name] = {};
      for (const [camera, distance] of Object.entries(distances)) {
        say(`loading, ${name}, ${camera}`);
        const found = Object.fromEntries(Object.keys(folders).map((row) => [row, []]));
        for (let i = 0; i < runs; ++i) {
          for (const row of Object.keys(folders)) {
            const url = `${link?.origin ?? server.origin}/files/${places[row]}/${tileset}`;
            found[row].push(await loadOnce(browser, url, PAGES[row] ?? PLAIN_PAGE, distance));
          }
        }
        results[name][camera] = Object.fromEntries(Object.entries(found).map(([row, list]) => [row, {
          ...list[0], ms: median(list.map(({ ms }) => ms)), all: list.map(({ ms }) => Math.round(ms)),
        }]));
      }
      link?.close();
    }
  } finally {
    await browser.close();
    await server.close();
  }
  return { version: browser.version(), links: results };
}

/** Tiles are sent as brotli has made them before, like from a server that has its files ready. */
function serveFolder(files, place, folder) {
  const packed = new Set(filesIn(`${folder}.br`));
  for (const name of filesIn(folder)) {
    const isPacked = packed.has(name);
    const body = readFileSync(path.join(isPacked ? `${folder}.br` : folder, name));
    files.set(`${place}/${name.split('/').map(encodeURIComponent).join('/')}`, {
      body, headers: { 'Cache-Control': 'max-age=600', 'Content-Length': `${body.length}`, ...(isPacked ? { 'Content-Encoding': 'br' } : {}) },
    });
  }
}

async function loadOnce(browser, tileset, { query, isReady }, distance) {
  const context = await browser.newContext({ viewport: { width: 480, height: 360 } });
  try {
    const page = await context.newPage();
    const messages = [];
    page.on('console', (message) => messages.push(message.text()));
    await page.goto(`${new URL(tileset).origin}/plain/cesium_load.html?eval${query}`);
    await page.waitForFunction(isReady, undefined, { timeout: 60_000 }).catch((error) => {
      throw new Error(`the page did not get ready: ${messages.join('\n')}`, { cause: error });
    });
    return await page.evaluate(([url, far]) => globalThis.load(url, far), [tileset, distance]);
  } finally {
    await context.close();
  }
}
