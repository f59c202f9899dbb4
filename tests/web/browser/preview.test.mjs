// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// three.js and Babylon.js in Chromium draw a preview while the rest of the file is still on the server.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { blocksGlb, payloadsIn } from '../support/blocks.mjs';
import { binOf, withPreview } from '../support/previews.mjs';
import { convert, readSample } from '../support/program.mjs';
import { openPage } from './support/browser.mjs';
import { useSite } from './support/site.mjs';

const site = useSite();
const TRIANGLES = 4096;

/** Opens a page that loads a model. The server keeps all that comes after the preview until release() is called. */
async function beginLoad(engine, change = () => {}) {
  const preview = payloadsIn(convert(readSample('torus')))[0].bytes;
  const glb = withPreview(blocksGlb('torus'), preview);
  change(glb);
  const end = binOf(glb) + preview.length;
  let release;
  const rest = new Promise((resolve) => { release = () => resolve(glb.subarray(end)); });
  site.server.files.set('preview.glb', { body: glb.subarray(0, end), rest, headers: { 'Content-Type': 'model/gltf-binary', 'Cache-Control': 'no-store' } });
  const { page, violations } = await openPage(site.browser, `${site.server.origin}/pages/${engine}.html`, () => globalThis.begin !== undefined);
  const requests = [];
  page.on('request', (request) => requests.push(new URL(request.url()).pathname));
  await page.evaluate(() => globalThis.begin('/files/preview.glb'));
  const until = (what) => page.waitForFunction(what);
  const told = () => page.evaluate(() => ({ ...globalThis.state, left: globalThis.state.left(), geometries: globalThis.state.memory.geometries }));
  return { page, violations, requests, release, until, told };
}

for (const engine of ['preview', 'preview_babylon']) {
  test(`${engine}: a preview is drawn before the rest of the file is there, and then the file`, async () => {
    const { page, violations, release, until, told } = await beginLoad(engine);
    await until(() => globalThis.state.previews.length > 0);
    const { previews, blocks, result, left } = await told();
    assert.deepEqual({ previews, blocks, result, left }, { previews: [TRIANGLES], blocks: [], result: undefined, left: TRIANGLES });
    assert.notEqual(await page.evaluate(() => globalThis.state.isSeen?.()), false);
    release();
    await until(() => globalThis.state.result !== undefined);
    const end = await told();
    assert.equal(end.result, 'loaded');
    assert.ok(end.blocks.length > 3);
    assert.ok(end.blocks[0] > TRIANGLES, 'blocks and the preview');
    assert.equal(end.blocks.at(-1), TRIANGLES, 'blocks alone');
    assert.equal(end.left, TRIANGLES, 'the model alone');
    assert.equal(end.geometries, 1, 'the GPU has nothing else');
    assert.deepEqual(violations(), []);
    await page.close();
  });

  test(`${engine}: nothing waits for a script that could have been there`, async () => {
    const { page, requests, release, until } = await beginLoad(engine);
    const whole = page.waitForRequest(/mcc_decoder_simd\.wasm$/);
    await until(() => globalThis.state.previews.length > 0);
    await whole; // the blocks are still on the server
    const at = (end) => requests.findIndex((path) => path.endsWith(end));
    assert.ok(at('/gluing.mjs') >= 0 && at('/gluing.mjs') < at('/preview.glb'), requests.join(' '));
    release();
    await until(() => globalThis.state.result !== undefined);
    await page.close();
  });

  test(`${engine}: a load can be aborted when its preview is shown`, async () => {
    const { page, release, until, told } = await beginLoad(engine);
    await until(() => globalThis.state.previews.length > 0);
    await page.evaluate(() => globalThis.state.abort());
    await until(() => globalThis.state.result !== undefined);
    const { result, left, geometries } = await told();
    assert.deepEqual({ result, left, geometries }, { result: 'enough', left: 0, geometries: 0 });
    release();
    await page.close();
  });

  test(`${engine}: a damaged preview is refused`, async () => {
    const { page, release, until, told } = await beginLoad(engine, (glb) => { glb[binOf(glb) + 9] ^= 0x55; });
    await until(() => globalThis.state.result !== undefined);
    const { result, previews, left } = await told();
    assert.match(result, /^\/bufferViews\/\d+/);
    assert.deepEqual({ previews, left }, { previews: [], left: 0 });
    release();
    await page.close();
  });
}
