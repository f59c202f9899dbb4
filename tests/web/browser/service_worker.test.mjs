// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Pages that know nothing of the library but the README's line show compressed models in engines without a plugin; what is not ours
// goes past the service worker untouched. MCC_SCREENSHOTS=FOLDER saves a picture of each engine.
import assert from 'node:assert/strict';
import { readdir, readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { test } from 'node:test';
import { build } from 'esbuild';
import { readGlb } from '../../../lib/web/unpack.mjs';
import { LIBRARY } from '../support/paths.mjs';
import { snippetOf } from '../support/readme.mjs';
import { b3dm, cmpt, i3dm, i3dmOf, pnts, readTile, textBytes } from '../support/tiles.mjs';
import { isDecoding, openPage } from './support/browser.mjs';
import { coverageOf, differenceOf, readPicture, writePicture } from './support/pixels.mjs';
import { useSite } from './support/site.mjs';

const ENGINES = [
  { page: 'babylon' }, { page: 'model_viewer' }, { page: 'playcanvas' }, { page: 'cesium', query: 'eval' },
];
const MAX_DIFFERENCE = 0.001;
const MIN_COVERAGE = 0.05;

const site = useSite();

const open = ({ page, query = '' }, more = 'worker', isReady = isDecoding) =>
  openPage(site.browser, `${site.server.origin}/plain/${page}.html?${query}&${more}`, isReady);
const draw = async (page, url) => readPicture(await page.evaluate((at) => globalThis.draw(at), url));

for (const engine of ENGINES) {
  test(`${engine.page} shows compressed models by one line in the page`, async () => {
    const { page, violations } = await open(engine);
    const plain = await draw(page, '/models/textured.plain/model.glb');
    const picture = await draw(page, '/models/textured.mcc/model.glb');
    assert.ok(coverageOf(picture) > MIN_COVERAGE, `${coverageOf(picture)} of the picture is not background`);
    assert.ok(differenceOf(picture, plain) < MAX_DIFFERENCE, `${differenceOf(picture, plain)} of the pixels differ`);
    const folder = process.env.MCC_SCREENSHOTS;
    if (folder) await writeFile(path.join(folder, `service_worker_${engine.page}.png`), writePicture(picture));
    assert.deepEqual(violations(), []);
    await page.close();
    const without = await open(engine, 'nothing', () => globalThis.draw !== undefined);
    const shown = await draw(without.page, '/models/textured.mcc/model.glb').then((other) => differenceOf(other, plain), () => 1);
    assert.ok(shown > MIN_COVERAGE / 2, 'without the line the model is not shown');
    await without.page.close();
  });
}

/** Fetches in a page: { status, statusText, bytes, headers }. */
const fetchIn = (page, url, options) => page.evaluate(async ([at, init]) => {
  const response = await fetch(at, init);
  const bytes = [...new Uint8Array(await response.arrayBuffer())];
  return { status: response.status, statusText: response.statusText, bytes, headers: Object.fromEntries(response.headers) };
}, [url, options]);

const asArray = (bytes) => [...new Uint8Array(bytes)];

async function openPlain() {
  const opened = await open({ page: 'playcanvas' });
  const put = (name, body, headers = {}, status = 200) => site.server.files.set(name, { body: Buffer.from(body), headers, status });
  return { ...opened, put };
}

test('files that are not ours, parts of files and errors pass through untouched', async () => {
  const { page, put } = await openPlain();
  const [compressed, source] = [site.models.get('textured.mcc'), site.models.get('textured')];
  put('ours.glb', compressed, { ETag: '"1"' });
  put('other.glb', source, { 'ETag': '"2"', 'X-Other': 'kept', 'Content-Type': 'model/gltf-binary' });
  put('page.glb', '<!doctype html>no model');
  put('short.glb', compressed.subarray(0, 15));
  put('cut.glb', compressed.subarray(0, 100));
  put('empty.glb', '');
  put('broken.gltf', '{ "asset": ');
  put('gone.glb', compressed, {}, 404);
  put('ours.bin', compressed);
  for (const name of ['other.glb', 'page.glb', 'short.glb', 'cut.glb', 'empty.glb', 'broken.gltf', 'gone.glb', 'ours.bin']) {
    const { body, status } = site.server.files.get(name);
    const answer = await fetchIn(page, `/files/${name}`);
    assert.deepEqual([answer.status, answer.bytes], [status, asArray(body)], name);
  }
  const { headers } = await fetchIn(page, '/files/other.glb');
  assert.deepEqual([headers.etag, headers['x-other'], headers['content-type']], ['"2"', 'kept', 'model/gltf-binary']);
  const part = await fetchIn(page, '/files/ours.glb', { headers: { Range: 'bytes=8-19' } });
  assert.deepEqual([part.status, part.bytes], [206, asArray(compressed.subarray(8, 20))]);
  const posted = await fetchIn(page, '/files/ours.glb', { method: 'POST' });
  assert.deepEqual(posted.bytes, asArray(compressed));
  const ours = await fetchIn(page, '/files/ours.glb');
  assert.equal(ours.headers.etag, undefined);
  assert.ok(!JSON.stringify(readGlb(new Uint8Array(ours.bytes)).json).includes('KHR_mesh_collapse'));
  await page.close();
});

const TABLES = [textBytes('{"BATCH_LENGTH":0}')];

test('the models inside of tiles are decoded', async () => {
  const { page, put } = await openPlain();
  const [compressed, plain] = ['textured.mcc', 'textured'].map((name) => site.models.get(name));
  const headers = { 'ETag': '"1"', 'X-Other': 'kept', 'Content-Type': 'application/octet-stream' };
  put('ours.b3dm', b3dm(compressed, { tables: TABLES }), headers);
  put('ours.i3dm', i3dm(compressed), headers);
  put('OURS.CMPT', cmpt([cmpt([b3dm(compressed), i3dm(plain)])]), headers);
  const glbs = [];
  for (const name of ['ours.b3dm?version=1', 'ours.i3dm', 'OURS.CMPT']) {
    const answer = await fetchIn(page, `/files/${name}`);
    assert.deepEqual([answer.status, answer.headers.etag, answer.headers['x-other']], [200, undefined, 'kept'], name);
    let tile = readTile(new Uint8Array(answer.bytes));
    while (tile.tiles !== undefined) [tile] = tile.tiles;
    glbs.push(tile.glb);
  }
  const { bytes } = await fetchIn(page, '/models/textured.mcc/model.glb');
  for (const glb of glbs) assert.deepEqual(asArray(glb), bytes);
  const part = await fetchIn(page, '/files/ours.b3dm', { headers: { Range: 'bytes=8-19' } });
  assert.deepEqual([part.status, part.bytes], [206, asArray(site.server.files.get('ours.b3dm').body.subarray(8, 20))]);
  await page.close();
});

test('tiles that are not ours pass through untouched, also those that cannot be read', async () => {
  const { page, put } = await openPlain();
  const source = site.models.get('textured');
  const headers = { 'ETag': '"2"', 'Content-Type': 'application/octet-stream' };
  const old = new Uint8Array(Buffer.concat([textBytes('b3dm'), new Uint8Array(new Uint32Array([1, 20 + source.length, 0, 0]).buffer), source]));
  const tiles = {
    'other.b3dm': b3dm(source, { tables: TABLES, padding: 3 }),
    'old.b3dm': old, // the header of a draft of 3D Tiles, which CesiumJS reads
    'cut.b3dm': b3dm(source).subarray(0, 200),
    'short.b3dm': textBytes('b3dm'),
    'linked.i3dm': i3dmOf('textured.glb'),
    'other.cmpt': cmpt([b3dm(source), pnts(new Uint8Array(4))], 1),
    'page.cmpt': textBytes('<!doctype html>no tile'),
    'empty.i3dm': new Uint8Array(0),
  };
  for (const [name, tile] of Object.entries(tiles)) {
    put(name, tile, headers);
    const answer = await fetchIn(page, `/files/${name}`);
    assert.deepEqual([answer.status, answer.bytes, answer.headers.etag], [200, asArray(tile), '"2"'], name);
  }
  put('gone.b3dm', b3dm(site.models.get('textured.mcc')), {}, 404);
  assert.equal((await fetchIn(page, '/files/gone.b3dm')).status, 404);
  await page.close();
});

test('a tile of ours that is damaged is refused with its reason', async () => {
  const { page, put } = await openPlain();
  const whole = b3dm(site.models.get('textured.mcc'));
  put('checksum.cmpt', cmpt([b3dm(site.models.get('textured')), b3dm(site.models.get('damaged'))]));
  put('cut.b3dm', whole.subarray(0, whole.length - 100));
  for (const [name, why] of [['checksum.cmpt', /^checksum.cmpt: in the GLB at byte \d+: .*checksum/], ['cut.b3dm', /^cut.b3dm: byte 8: the tile claims \d+ bytes/]]) {
    const { status, statusText } = await fetchIn(page, `/files/${name}`);
    assert.equal(status, 502, name);
    assert.match(statusText, why);
  }
  await page.close();
});

test('a damaged file is refused with its reason', async () => {
  const { page } = await openPlain();
  const { status, statusText, bytes } = await fetchIn(page, '/models/damaged/model.glb');
  assert.equal(status, 502);
  assert.match(statusText, /checksum/);
  assert.match(new TextDecoder().decode(new Uint8Array(bytes)), /checksum/);
  await assert.rejects(draw(page, '/models/damaged/model.glb'));
  await page.close();
});

test('the cache of the browser holds what came over the network', async () => {
  const { page } = await openPlain();
  let count = 0;
  const body = Buffer.from(site.models.get('textured.mcc'));
  site.server.files.set('counted.glb', { headers: { 'Cache-Control': 'max-age=600' }, get body() { ++count; return body; } });
  const first = await fetchIn(page, '/files/counted.glb');
  assert.deepEqual((await fetchIn(page, '/files/counted.glb')).bytes, first.bytes);
  assert.equal(count, 1);
  await page.close();
});

/** A .gltf document with a buffer beside it, and one that nothing needs. */
function asGltf(glb, uri) {
  const { json, chunks: [{ data }] } = readGlb(glb);
  json.buffers[0].uri = uri;
  json.buffers.push({ uri: 'missing.bin', byteLength: 4 });
  return { json, data };
}

test('a .gltf file gets a further buffer', async () => {
  const { page, put, violations } = await openPlain();
  for (const name of ['textured', 'materials', 'shared', 'morphed']) {
    const { json, data } = asGltf(site.models.get(`${name}.mcc`), 'a%20buffer.bin');
    put(`${name}/scene.gltf`, JSON.stringify(json));
    put(`${name}/a%20buffer.bin`, data);
    const url = `/files/${name}/scene.gltf?version=1`;
    const { bytes } = await fetchIn(page, url);
    const decoded = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes)));
    const { uri, byteLength } = decoded.buffers.at(-1);
    const [once, twice] = [await fetchIn(page, new URL(uri, `${site.server.origin}${url}`).href), await fetchIn(page, `/files/${name}/${uri}`)];
    assert.equal(once.bytes.length, byteLength);
    assert.deepEqual(twice.bytes, once.bytes, 'the worker may have forgotten it');
    assert.ok(!JSON.stringify(decoded).includes('KHR_mesh_collapse'));
    const plain = await draw(page, `/models/${name}.plain/model.glb`);
    assert.ok(differenceOf(await draw(page, url), plain) < MAX_DIFFERENCE, name);
  }
  assert.deepEqual(violations(), []);
  await page.close();
});

test('a .gltf file whose buffer is damaged or missing is refused when the buffer is asked for', async () => {
  const { page, put } = await openPlain();
  const { json, data } = asGltf(site.models.get('damaged'), 'bad.bin');
  put('bad.gltf', JSON.stringify(json));
  put('bad.bin', data);
  json.buffers[0].uri = 'nowhere.bin';
  put('lost.gltf', JSON.stringify(json));
  for (const [name, why] of [['bad', /checksum/], ['lost', /status 404/]]) {
    const { bytes } = await fetchIn(page, `/files/${name}.gltf`);
    const { uri } = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes))).buffers.at(-1);
    const answer = await fetchIn(page, `/files/${uri}`);
    assert.equal(answer.status, 502);
    assert.match(answer.statusText, why);
  }
  await page.close();
});

test('the worker as a classic one, bundled as the README says', async () => {
  const { outputFiles: [{ contents }] } = await build({
    stdin: { contents: (await snippetOf('sw.js')).replace('/gltf-mcc/', './'), resolveDir: LIBRARY },
    bundle: true, format: 'iife', define: { 'import.meta.url': 'self.location.href' }, write: false, logLevel: 'silent',
  });
  const policy = "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'";
  const headers = { 'Content-Type': 'text/javascript', 'Content-Security-Policy': policy, 'Service-Worker-Allowed': '/' };
  site.server.files.set('classic.js', { body: Buffer.from(contents), headers });
  for (const file of await readdir(path.join(LIBRARY, 'wasm'))) {
    site.server.files.set(`wasm/${file}`, { body: await readFile(path.join(LIBRARY, 'wasm', file)), headers: { 'Content-Type': 'application/wasm' } });
  }
  const { page } = await open({ page: 'playcanvas' }, 'nothing', () => globalThis.draw !== undefined);
  await page.evaluate(async () => {
    const { serviceWorker } = navigator;
    const isThere = new Promise((resolve) => serviceWorker.addEventListener('controllerchange', resolve, { once: true }));
    await serviceWorker.register('/files/classic.js', { scope: '/' });
    await isThere;
  });
  const { bytes } = await fetchIn(page, '/models/textured.mcc/model.glb');
  assert.ok(!JSON.stringify(readGlb(new Uint8Array(bytes)).json).includes('KHR_mesh_collapse'));
  await page.close();
});
