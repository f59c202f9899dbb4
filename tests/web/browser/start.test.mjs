// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What pages load when, and on which thread they decode.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { readGlb } from '../../../lib/web/unpack.mjs';
import { convert, readSample } from '../support/program.mjs';
import { openPage } from './support/browser.mjs';
import { useSite } from './support/site.mjs';

const site = useSite();

const open = async (query = '') => {
  const { page, violations } = await openPage(site.browser, `${site.server.origin}/pages/three.html?${query}`, () => globalThis.draw !== undefined);
  const requests = [];
  page.on('request', (request) => requests.push(new URL(request.url()).pathname));
  return { page, violations, requests };
};

/** Waits until the worker of a page has been told of the core. */
const preload = (page, module = '/lib/three.mjs') => page.evaluate(async (name) => (await import(name)).preload(), module);

test('preload() loads the core and starts one worker, before there is a file', async () => {
  const { page, violations, requests } = await open();
  await preload(page);
  assert.deepEqual(requests.filter((path) => path.endsWith('.wasm')), ['/lib/wasm/mcc_decoder_core_simd.wasm']);
  // The browser may tell of a worker later than the page knows it.
  if (page.workers().length === 0) await page.waitForEvent('worker');
  assert.equal(page.workers().length, 1);
  assert.deepEqual(violations(), []);
  await page.close();
});

test('a script with the core inside takes no request for it', async () => {
  const { page, violations, requests } = await open();
  await preload(page, '/lib/inline.mjs');
  await page.evaluate((name) => globalThis.draw(name), 'materials.mcc');
  assert.deepEqual(requests.filter((path) => path.endsWith('.wasm')), []);
  assert.deepEqual(violations(), []);
  await page.close();
});

test('preload() is no error where workers are forbidden', async () => {
  const { page } = await open('noworkers');
  await preload(page);
  await page.evaluate((name) => globalThis.draw(name), 'textured.mcc');
  await page.close();
});

test('small payloads are decoded on the page\'s thread, large ones in a worker, with the same results', async () => {
  site.models.set('small.mcc', convert(readSample('modes')));
  site.models.set('large.mcc', convert(readSample('genus3')));
  const { page, violations } = await open();
  const decoded = await page.evaluate(async () => {
    const [{ decodeAnywhere, preload: load }, { decodePayload }, { payloadsOf }, { readGlb }] = await Promise.all(
      ['threads', 'decode', 'document', 'unpack'].map((name) => import(`/lib/${name}.mjs`)));
    await load();
    const posted = [];
    const { postMessage } = Worker.prototype;
    Worker.prototype.postMessage = function post(message, ...rest) {
      posted.push(message.jobs?.length);
      return postMessage.call(this, message, ...rest);
    };
    const results = {};
    for (const name of ['small', 'large']) {
      const { json, chunks: [{ data }] } = readGlb(new Uint8Array(await (await fetch(`/models/${name}.mcc/model.glb`)).arrayBuffer()));
      const [{ bufferView, claims }] = payloadsOf(json);
      const { byteOffset = 0, byteLength } = json.bufferViews[bufferView];
      const bytes = data.slice(byteOffset, byteOffset + byteLength);
      // As if this machine were slow, whatever it is: the large one is repeated until it counts as large.
      const factor = name === 'large' ? 1000 : 1;
      const told = claims.map((claim) => ({ ...claim, indices: { ...claim.indices, count: factor * claim.indices.count } }));
      posted.length = 0;
      const found = await decodeAnywhere(bytes, { claims: factor === 1 ? claims : told }).catch((error) => error.code);
      const same = JSON.stringify(await decodeAnywhere(bytes)) === JSON.stringify(await decodePayload(bytes));
      results[name] = { posted: posted[0], found: typeof found === 'string' ? found : 'decoded', same };
    }
    return results;
  });
  assert.deepEqual(decoded.small, { posted: undefined, found: 'decoded', same: true }, 'no worker is told');
  assert.deepEqual(decoded.large, { posted: 1, found: 'Document', same: true }, 'a worker refuses the counts');
  assert.deepEqual(violations(), []);
  await page.close();
});

test('the whole decoder is requested when a document says that there are tangents, before their payload is there', async () => {
  const { page, requests } = await open();
  const read = (name) => page.evaluate(async (json) => {
    const { PayloadViews } = await import('/lib/views.mjs');
    new PayloadViews(json, () => new Promise(() => {})).begin(json);
  }, readGlb(convert(readSample(name))).json);
  const wholeRequests = () => requests.filter((path) => path.endsWith('/mcc_decoder_simd.wasm')).length;
  await read('genus3');
  await preload(page);
  assert.equal(wholeRequests(), 0);
  const whole = page.waitForRequest(/mcc_decoder_simd\.wasm$/);
  await read('textured');
  await whole;
  await page.close();
});
