// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Blocks in Chromium: they appear in their order, from a stream and in three.js, and the tasks of the page can be measured.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { blocksGlb } from '../support/blocks.mjs';
import { CATEGORIES, longestTask } from '../support/bench/tasks.mjs';
import { openPage } from './support/browser.mjs';
import { useSite } from './support/site.mjs';

const site = useSite();
const TORUS_TRIANGLES = 4096;

function open() {
  site.models.set('blocks', blocksGlb('torus'));
  return openPage(site.browser, `${site.server.origin}/pages/blocks.html`, () => globalThis.load !== undefined);
}

for (const way of ['stream', 'three', 'plain']) {
  test(`${way}: a model in blocks is loaded under a Content-Security-Policy`, async () => {
    const { page, violations } = await open();
    for (const workers of [1, 2]) {
      const { triangles, blocks, all } = await page.evaluate((args) => globalThis.load(...args), ['blocks', way, workers]);
      assert.equal(triangles, TORUS_TRIANGLES);
      assert.deepEqual(blocks, [...blocks].sort((a, b) => a - b));
      assert.ok(way === 'plain' ? blocks.length === 0 : blocks.length > 3 && blocks.at(-1) <= all);
    }
    assert.deepEqual(violations(), []);
    await page.close();
  });
}

test('the longest task of a page is found', async () => {
  const { page } = await open();
  await site.browser.startTracing(page, { categories: CATEGORIES });
  await page.evaluate(async () => {
    performance.mark('load-begin');
    await new Promise((resolve) => setTimeout(() => {
      const end = performance.now() + 40;
      while (performance.now() < end);
      resolve();
    }));
    await new Promise((resolve) => setTimeout(resolve, 10));
    performance.mark('load-end');
  });
  const { elapsed, cpu } = longestTask(await site.browser.stopTracing());
  assert.ok(elapsed >= 39 && cpu > 0 && cpu <= elapsed + 1, `${elapsed} ms, ${cpu} ms`);
  await page.close();
});
