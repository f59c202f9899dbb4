// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { NullEngine } from '@babylonjs/core/Engines/nullEngine.js';
import { LoadAssetContainerAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { Logger } from '@babylonjs/core/Misc/logger.js';
import { Scene } from '@babylonjs/core/scene.js';
import '@babylonjs/loaders/glTF/2.0/index.js';
import '@babylonjs/loaders/glTF/glTFFileLoader.js';
import './support/peers.mjs';
import { decodePayload, unpackGlb } from '../../lib/web/index.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { refusesNegatives } from './support/loaders.mjs';
import { convert, convertWithFallback, readSample } from './support/program.mjs';

const { registerMeshCollapse } = await import('../../lib/web/babylon.mjs');

Logger.LogLevels = Logger.NoneLogLevel;
const engine = new NullEngine();
registerMeshCollapse();

async function load(bytes) {
  const scene = new Scene(engine);
  try {
    return geometryOf(await LoadAssetContainerAsync(bytes, scene, { pluginExtension: '.glb' }));
  } finally {
    scene.dispose();
  }
}

function geometryOf({ meshes }) {
  return meshes.filter((mesh) => mesh.geometry).map((mesh) => ({
    indices: Array.from(mesh.getIndices()),
    attributes: Object.fromEntries(mesh.getVerticesDataKinds().map((kind) => [kind, mesh.getVerticesData(kind)])),
    targets: targetsOf(mesh.morphTargetManager),
  }));
}

function targetsOf(morphs) {
  return Array.from({ length: morphs?.numTargets ?? 0 }, (_, i) => {
    const target = morphs.getTarget(i);
    return [target.getPositions(), target.getNormals(), target.getTangents(), target.getUVs(), target.getColors?.()];
  });
}

// The engine wants as many morph targets in each primitive of a mesh.
const isForBabylon = ({ primitives }) => new Set(primitives.map(({ targets = [] }) => targets.length)).size === 1;

test('Babylon.js makes of the conformance assets what it makes of their unpacked form', async () => {
  const usable = manifest.assets.filter(isForBabylon);
  assert.ok(usable.length > 0.95 * manifest.assets.length, `${usable.length} of ${manifest.assets.length}`);
  for (const asset of usable) {
    const bytes = readAsset(asset);
    const geometry = await load(bytes);
    assert.ok(geometry.length > 0, asset.file);
    assert.deepEqual(geometry, await load(await unpackGlb(bytes)), asset.file);
  }
});

test('Babylon.js refuses the negative assets', () => refusesNegatives(load));

test('Babylon.js decodes a payload once, with the options of the registration', async (context) => {
  context.after(() => registerMeshCollapse());
  const calls = [];
  const decode = (payload, options) => {
    calls.push(options);
    return decodePayload(payload, options);
  };
  const glb = convert(readSample('shared_vertices')); // three primitives with one payload
  registerMeshCollapse({ decode });
  assert.equal((await load(glb)).length, 3);
  assert.equal(calls.length, 1);
  registerMeshCollapse({ limits: { maxVertices: 100 } });
  await assert.rejects(load(glb), ({ innerError }) => innerError.code === 'Limit');
});

test('Babylon.js loads what has a fallback without the fallback', async () => {
  const { glb } = convertWithFallback('torus');
  const [{ indices }] = await load(glb); // its .bin is nowhere
  assert.equal(indices.length, 3 * 4096);
});
