// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decoder and worker pool under `default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'`.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { test } from 'node:test';
import { unpackGlb } from '../../../lib/web/index.mjs';
import { openPage } from './support/browser.mjs';
import { useSite } from './support/site.mjs';

const site = useSite();

test('a page with a strict Content-Security-Policy decodes on its thread and in workers', async () => {
  const names = [...site.models.keys()].filter((name) => name.endsWith('.mcc'));
  const url = `${site.server.origin}/pages/decoder.html?strict`;
  const { page, violations } = await openPage(site.browser, url, () => globalThis.unpack !== undefined);
  const { size, here, inWorkers } = await page.evaluate((list) => globalThis.unpack(list, 2), [...names, 'damaged', ...names]);
  assert.equal(size, 2);
  assert.deepEqual(inWorkers, here, 'workers and this thread yield the same');
  assert.match(here[names.length], /^MccError: .*checksum/, 'and what follows a damaged file is decoded');
  const expected = await Promise.all(names.map((name) => unpackGlb(site.models.get(name)).then(hashOf)));
  assert.deepEqual(here, [...expected, here[names.length], ...expected], 'as in Node');
  assert.deepEqual(violations(), []);
  await page.close();
});

const hashOf = (bytes) => new Uint8Array(createHash('sha256').update(bytes).digest()).toString();
