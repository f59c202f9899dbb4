// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import './support/peers.mjs';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { createDecoderPool, decodePayload } from '../../lib/web/index.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { blocksGlb, trianglesOf, trianglesOfBlocks } from './support/blocks.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { compareWithManifest, refusesNegatives } from './support/loaders.mjs';
import { convert, convertWithFallback, readSample } from './support/program.mjs';

const { MeshCollapsePlugin } = await import('../../lib/web/three.mjs');

// What the loader takes for granted in browsers.
globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= Event;

function load(bytes, options) {
  const loader = new GLTFLoader();
  loader.register((parser) => new MeshCollapsePlugin(parser, options));
  return loader.parseAsync(bytes.buffer, '');
}

// Ordinary attributes may be interleaved or padded.
function tightElements({ isInterleavedBufferAttribute, array, data, count, itemSize, offset }) {
  if (!isInterleavedBufferAttribute) return array;
  const result = new array.constructor(count * itemSize);
  for (let i = 0; i < result.length; ++i) {
    result[i] = data.array[Math.floor(i / itemSize) * data.stride + offset + i % itemSize];
  }
  return result;
}

test('three.js has the elements of the conformance assets in its accessors', async () => {
  for (const asset of manifest.assets) {
    const { parser } = await load(readAsset(asset));
    const elementsOf = async (accessor) => tightElements(await parser.getDependency('accessor', accessor));
    await compareWithManifest(asset, parser.json, elementsOf);
  }
});

test('three.js refuses the negative assets', () => refusesNegatives(load));

test('three.js decodes a payload once, with the options of the plugin', async () => {
  const calls = [];
  const decode = (payload, options) => {
    calls.push(options);
    return decodePayload(payload, options);
  };
  const glb = convert(readSample('shared_vertices')); // three primitives with one payload
  const { scene } = await load(glb, { decode, limits: { maxVertices: 10_000 } });
  const geometries = scene.getObjectsByProperty('isMesh', true).map(({ geometry }) => geometry);
  assert.equal(geometries.length, 3);
  assert.equal(new Set(geometries.map(({ attributes }) => attributes.position)).size, 1, 'they share their vertices');
  assert.equal(calls.length, 1);
  await assert.rejects(load(glb, { limits: { maxVertices: 100 } }), { code: 'Limit' });
});

test('three.js loads a document again, which stays as it was, and no fallback', async () => {
  const { json, chunks: [{ data }] } = readGlb(convertWithFallback('torus').glb); // whose .bin is nowhere
  json.buffers[0].uri = `data:application/octet-stream;base64,${Buffer.from(data).toString('base64')}`;
  for (const accessor of json.accessors) accessor.byteOffset = 4; // of the fallback
  const copy = structuredClone(json);
  for (let i = 0; i < 2; ++i) {
    const loader = new GLTFLoader().register((parser) => new MeshCollapsePlugin(parser));
    const { scene } = await loader.parseAsync(json, '');
    assert.equal(scene.getObjectsByProperty('isMesh', true)[0].geometry.index.count, 3 * 4096);
    assert.deepEqual(json, copy);
  }
});

test('three.js shows the blocks of a large primitive before all of it is there', async (t) => {
  const pool = createDecoderPool({ workers: 2 });
  t.after(() => pool.dispose());
  // What trianglesOf() takes.
  const plain = ({ attributes, index }) => ({
    attributes: ['position', 'normal'].map((name) => ({ array: attributes[name].array, componentCount: attributes[name].itemSize })),
    parts: [{ indices: index.array }],
  });
  for (const decode of [undefined, pool.decodePayload]) {
    const told = [];
    const onBlock = (geometry, info) => told.push({ geometry, info });
    const { scene } = await load(blocksGlb('torus'), { decode, onBlock });
    const [{ geometry: whole }] = scene.getObjectsByProperty('isMesh', true);
    assert.ok(told.length > 3);
    assert.deepEqual(told.map(({ info }) => info), told.map((_, index) => ({ index, blockCount: told.length, mesh: 0, primitive: 0 })));
    assert.deepEqual(trianglesOfBlocks(told.map(({ geometry }) => plain(geometry))), trianglesOf(plain(whole)));
    for (const { geometry } of told) {
      const { boundingBox, boundingSphere } = geometry;
      geometry.computeBoundingBox();
      assert.deepEqual(boundingBox, geometry.boundingBox);
      assert.ok(boundingSphere.radius > 0);
    }
  }
  const uses = new Set();
  await load(blocksGlb('shared_vertices', 100), { onBlock: (_, { primitive }) => uses.add(primitive) });
  assert.deepEqual([...uses].sort(), [0, 1, 2], 'for each primitive');
  await assert.rejects(load(blocksGlb('torus'), { onBlock() { throw new Error('mine'); } }), /mine/);
  await load(readAsset(manifest.assets[0]), { onBlock: () => assert.fail('it has no blocks') });
});
