// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshCollapsePlugin } from '../../lib/web/three.mjs';
import { assets, bytesOf, compareWithManifest, refusesNegatives } from './support/conformance.mjs';

globalThis.self ??= globalThis; // the loader looks for URL there

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
  for (const asset of assets) {
    const { parser } = await load(bytesOf(asset));
    await compareWithManifest(asset, parser.json, async (accessor) => tightElements(await parser.getDependency('accessor', accessor)));
  }
});

test('three.js refuses the negative assets', () => refusesNegatives(load));
