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
import { unpackGlb } from '../../lib/web/unpack.mjs';
import { assets, bytesOf, refusesNegatives } from './support/conformance.mjs';

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
  const usable = assets.filter(isForBabylon);
  assert.ok(usable.length > 0.95 * assets.length, `${usable.length} of ${assets.length}`);
  for (const asset of usable) {
    const bytes = bytesOf(asset);
    const geometry = await load(bytes);
    assert.ok(geometry.length > 0, asset.file);
    assert.deepEqual(geometry, await load(await unpackGlb(bytes)), asset.file);
  }
});

test('Babylon.js refuses the negative assets', () => refusesNegatives(load));
