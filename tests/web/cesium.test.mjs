// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What gltf-mcc/cesium does between CesiumJS and its files; a stand-in for its class Resource fetches them here.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { registerMeshCollapse } from '../../lib/web/cesium.mjs';
import { decodePayload, unpackGlb } from '../../lib/web/index.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { manifest, readAsset } from './support/conformance.mjs';

const MODEL = readAsset(manifest.assets.find(({ file }) => file.endsWith('_tetrahedron.glb')));
const ORIGIN = 'https://example.org/';

/** A class like Resource in front of files by name, which has been registered: { Resource, requests, fetch }. */
function start(files, options = { decode: decodePayload }) {
  const requests = [];
  class Resource {
    constructor(url) {
      this.url = url;
    }

    getDerivedResource({ url }) {
      return new Resource(new URL(url, this.url).href);
    }

    fetchArrayBuffer() {
      const name = this.url.replace(ORIGIN, '');
      if (name === 'throttled.glb') return undefined;
      requests.push(name);
      const body = files[name];
      if (body === undefined) return Promise.reject(new Error(`status 404: ${name}`));
      return Promise.resolve(Uint8Array.from(typeof body === 'string' ? new TextEncoder().encode(body) : body).buffer);
    }
  }
  registerMeshCollapse(Resource, options);
  const fetch = async (name) => new Uint8Array(await new Resource(`${ORIGIN}${name}`).fetchArrayBuffer());
  return { Resource, requests, fetch };
}

/** A .gltf of the model, and its buffer. */
function gltfOf() {
  const { json, chunks: [{ data }] } = readGlb(MODEL);
  json.buffers[0].uri = 'model.bin';
  return { text: JSON.stringify(json), data };
}

test('a GLB comes without the extension', async () => {
  const { fetch } = start({ 'model.glb': MODEL });
  assert.deepEqual(await fetch('model.glb'), await unpackGlb(MODEL));
});

test('a .gltf comes with one more buffer, which needs no request of its own; payloads are fetched once', async () => {
  const { text, data } = gltfOf();
  const { fetch, requests } = start({ 'a/model.gltf?key=1': text, 'a/model.bin': data });
  const { buffers, extensionsUsed } = JSON.parse(new TextDecoder().decode(await fetch('a/model.gltf?key=1')));
  const { uri, byteLength } = buffers.at(-1);
  assert.equal(extensionsUsed, undefined);
  assert.equal((await fetch(`a/${uri}`)).length, byteLength);
  assert.deepEqual(requests, ['a/model.gltf?key=1', 'a/model.bin']);
  // A buffer that is not there any more is decoded again.
  assert.equal((await fetch(`a/${uri}`)).length, byteLength);
  assert.deepEqual(requests.slice(2), ['a/model.gltf?key=1', 'a/model.bin']);
});

test('a .gltf may begin with a byte order mark and spaces, and names may be spelt as JSON allows', async () => {
  const { text, data } = gltfOf();
  const escaped = text.replaceAll('KHR_mesh', 'KHR\\u005fmesh');
  const { fetch } = start({ 'model.gltf': `\ufeff${' '.repeat(50)}\n${escaped}`, 'model.bin': data });
  assert.equal(JSON.parse(new TextDecoder().decode(await fetch('model.gltf'))).extensionsUsed, undefined);
});

test('limits hold', async () => {
  const { fetch } = start({ 'model.glb': MODEL }, { limits: { maxTriangles: 1 } });
  await assert.rejects(fetch('model.glb'), { name: 'MccError', code: 'Limit' });
});

test('what is damaged is refused with the place', async () => {
  const damaged = MODEL.slice();
  damaged[damaged.length - 6] ^= 1;
  const { fetch } = start({ 'damaged.glb': damaged, 'cut.glb': MODEL.subarray(0, MODEL.length - 4), 'lost.gltf': gltfOf().text });
  await assert.rejects(fetch('damaged.glb'), { name: 'MccError', message: /^\/bufferViews\/0: the payload is damaged/ });
  await assert.rejects(fetch('cut.glb'), { message: /it is truncated/ });
  const { buffers } = JSON.parse(new TextDecoder().decode(await fetch('lost.gltf')));
  await assert.rejects(fetch(buffers.at(-1).uri), { message: /404: model.bin/ });
});

test('what is not ours passes as it is, whatever it is', async () => {
  const others = {
    'tileset.json': '{"root":{}}', 'a.gltf': ' {"extensionsUsed":"KHR_mesh_collapse_compression"}', 'b.gltf': '{', 'c.txt': '', 'd.glb': 'glTF',
    'e.b3dm': 'b3dm\x09', 'tileset.gltf': '{"extensions":{"3DTILES_content_gltf":{"extensionsUsed":["KHR_mesh_collapse_compression"]}},"meshes":1}',
    'cut.gltf': '{"extensionsUsed":["KHR_mesh_collapse_compression"]', 'f.glb': await unpackGlb(MODEL), 'g.bin': new Uint8Array(5),
  };
  const { fetch } = start(others);
  for (const [name, body] of Object.entries(others)) {
    assert.deepEqual(await fetch(name), typeof body === 'string' ? new TextEncoder().encode(body) : body, name);
  }
});

test('a request that CesiumJS puts off stays undefined, and a second registration does nothing', async () => {
  let count = 0;
  const decode = (...given) => {
    ++count;
    return decodePayload(...given);
  };
  const { Resource, fetch } = start({ 'model.glb': MODEL }, { decode });
  const registered = Resource.prototype.fetchArrayBuffer;
  registerMeshCollapse(Resource);
  assert.equal(Resource.prototype.fetchArrayBuffer, registered);
  assert.equal(new Resource(`${ORIGIN}throttled.glb`).fetchArrayBuffer(), undefined);
  await fetch('model.glb');
  assert.equal(count, 1);
  assert.throws(() => registerMeshCollapse({}), { message: /class Resource of CesiumJS/ });
});
