// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the service worker answers and keeps, without a browser: its events are a stand-in here.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { unpackGlb } from '../../lib/web/index.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { manifest, readAsset } from './support/conformance.mjs';

const MODEL = readAsset(manifest.assets.find(({ file }) => file.endsWith('_tetrahedron.glb')));
const ORIGIN = 'https://example.org/';

/** A service worker in front of files by name: { ask, requests }. `ask` answers as the worker does. */
async function start(files, options) {
  const listeners = {};
  const requests = [];
  globalThis.self = { addEventListener: (name, listener) => { listeners[name] = listener; }, skipWaiting() {} };
  globalThis.fetch = async (resource) => {
    const { pathname } = new URL(resource.url ?? resource);
    requests.push(pathname.slice(1));
    const body = files.get(pathname.slice(1));
    return body === undefined ? new Response('', { status: 404 }) : new Response(body);
  };
  const { decodeFetches } = await import('../../lib/web/service_worker.mjs');
  decodeFetches(options);
  const ask = async (name) => {
    let answer;
    listeners.fetch({ request: new Request(`${ORIGIN}${name}`), respondWith: (promise) => { answer = promise; } });
    const response = await answer;
    return { status: response.status, statusText: response.statusText, bytes: new Uint8Array(await response.arrayBuffer()) };
  };
  return { ask, requests };
}

/** A .gltf of the model, and its buffer; `change` may change the document. */
function gltfOf(change = () => {}) {
  const { json, chunks: [{ data }] } = readGlb(MODEL);
  json.buffers[0].uri = 'model.bin';
  change(json);
  return { text: JSON.stringify(json), data };
}

const jsonOf = ({ bytes }) => JSON.parse(new TextDecoder().decode(bytes));
const { text, data } = gltfOf();

test('added buffers are kept until they are asked for, the newest ones; others are decoded again', async (t) => {
  t.mock.method(console, 'error', () => {});
  const count = 200;
  const files = new Map([['model.bin', data], ...Array.from({ length: count }, (_, i) => [`${i}.gltf`, text])]);
  let decoded = 0;
  const { decodePayload } = await import('../../lib/web/index.mjs');
  const { ask } = await start(files, { decode: (...args) => { ++decoded; return decodePayload(...args); } });
  const uris = [];
  for (let i = 0; i < count; ++i) uris.push(jsonOf(await ask(`${i}.gltf`)).buffers.at(-1).uri);
  await new Promise((resolve) => { setTimeout(resolve, 50); });
  assert.equal(decoded, count);
  const newest = await ask(uris[count - 1]);
  const oldKept = await ask(uris[count - 64]);
  assert.equal(decoded, count, 'they were kept');
  const dropped = await ask(uris[0]);
  assert.equal(decoded, count + 1, 'it was decoded again');
  assert.ok(newest.bytes.length > 0);
  for (const { bytes } of [oldKept, dropped]) assert.deepEqual(bytes, newest.bytes);
});

test('of large ones fewer are kept, and always the newest', async () => {
  // 256 MB of indices that the decoder, a stand-in, never makes: their documents say so, and that counts.
  const large = gltfOf((json) => {
    const primitive = json.meshes[0].primitives[0];
    json.accessors[primitive.indices].count = 2 ** 28;
  });
  const files = new Map([['model.bin', data], ['small.gltf', text], ['large.gltf', large.text]]);
  let decoded = 0;
  const decode = async () => { ++decoded; };
  const { ask } = await start(files, { decode, limits: { maxDecodedBytes: 2 ** 40 } });
  const small = jsonOf(await ask('small.gltf')).buffers.at(-1).uri;
  await ask('large.gltf');
  await new Promise((resolve) => { setTimeout(resolve, 50); });
  assert.equal(decoded, 2);
  assert.equal((await ask('large.gltf?gltf-mcc-buffer=')).status, 502);
  assert.equal(decoded, 2, 'the large one was kept, though it is too large');
  assert.equal((await ask(small)).status, 502);
  assert.equal(decoded, 3, 'the small one was not');
});

test('what is refused has the name of the file and the place', async (t) => {
  const logged = t.mock.method(console, 'error', () => {});
  const damaged = MODEL.slice();
  damaged[damaged.length - 6] ^= 1;
  const files = new Map([['models/damaged.glb', damaged], ['lost.gltf', text], ['nowhere.gltf', gltfOf((json) => { delete json.buffers[0].uri; }).text],
    ['bad%20name.gltf', gltfOf((json) => { json.buffers[0].uri = 'http://['; }).text], ['odd.gltf', gltfOf((json) => { json.skins = 5; }).text]]);
  const { ask } = await start(files);
  const { status, statusText } = await ask('models/damaged.glb');
  assert.deepEqual([status, statusText], [502, 'damaged.glb: /bufferViews/0: the payload is damaged: its checksum does not match']);
  const bufferOf = async (name) => ask(jsonOf(await ask(name)).buffers.at(-1).uri);
  assert.match((await bufferOf('lost.gltf')).statusText, /^lost.gltf: https:\/\/example.org\/model.bin: status 404$/);
  assert.match((await bufferOf('nowhere.gltf')).statusText, /^nowhere.gltf: \/buffers\/0: has no URI$/);
  assert.match((await bufferOf('bad%20name.gltf')).statusText, /^bad%20name.gltf: \/buffers\/0\/uri: Invalid URL$/);
  assert.match((await ask('odd.gltf')).statusText, /^odd.gltf: \/skins: must be an array$/);
  assert.ok(logged.mock.callCount() >= 5);
});

test('what is not ours passes, whatever it is', async () => {
  const others = {
    'a.gltf': '{"extensionsUsed":{"includes":5}}', 'b.gltf': '{"extensionsUsed":"KHR_mesh_collapse_compression"}', 'c.gltf': 'null',
    'd.gltf': '{"extensionsUsed":["KHR_mesh_collapse_compression"]}', 'e.glb': 'glTF', 'f.glb': await unpackGlb(MODEL),
  };
  const { ask } = await start(new Map(Object.entries(others)));
  for (const [name, body] of Object.entries(others)) {
    assert.deepEqual((await ask(name)).bytes, typeof body === 'string' ? new TextEncoder().encode(body) : body, name);
  }
});

test('the files of payloads are fetched once', async () => {
  const { ask, requests } = await start(new Map([['model.bin', data], ['model.gltf', text]]));
  const { buffers } = jsonOf(await ask('model.gltf'));
  assert.equal((await ask(buffers.at(-1).uri)).bytes.length, buffers.at(-1).byteLength);
  assert.deepEqual(requests, ['model.gltf', 'model.bin']);
});
