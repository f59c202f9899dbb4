// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { NullEngine } from '@babylonjs/core/Engines/nullEngine.js';
import { LoadAssetContainerAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Logger } from '@babylonjs/core/Misc/logger.js';
import { Scene } from '@babylonjs/core/scene.js';
import '@babylonjs/loaders/glTF/2.0/index.js';
import '@babylonjs/loaders/glTF/glTFFileLoader.js';
import './support/peers.mjs';
import { decodePayload, unpackGlb } from '../../lib/web/index.mjs';
import { changed, skinnedAlone } from './support/changed.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { refusesNegatives } from './support/loaders.mjs';
import { binOf, previewedGlb } from './support/previews.mjs';
import { convert, convertWithFallback, readSample } from './support/program.mjs';

const { loadWithPreview, registerMeshCollapse } = await import('../../lib/web/babylon.mjs');

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

/** What a scene has of a model: of each mesh its types, and its vertices and its box in the world. */
async function inWorld(glb, options) {
  registerMeshCollapse(options);
  const scene = new Scene(engine);
  try {
    const { meshes } = await LoadAssetContainerAsync(glb, scene, { pluginExtension: '.glb' });
    return meshes.filter(({ geometry }) => geometry).map((mesh) => {
      mesh.computeWorldMatrix(true);
      const world = mesh.getWorldMatrix();
      const corners = mesh.getVerticesData('position');
      const points = Array.from({ length: corners.length / 3 }, (_, i) => Vector3.TransformCoordinates(Vector3.FromArray(corners, 3 * i), world).asArray());
      const { minimumWorld, maximumWorld } = mesh.getBoundingInfo().boundingBox;
      const types = Object.fromEntries(mesh.geometry.getVerticesDataKinds().map((kind) => [kind, mesh.geometry.getVertexBuffer(kind).type]));
      return { types, points, box: [minimumWorld.asArray(), maximumWorld.asArray()], isInstance: mesh.isAnInstance };
    });
  } finally {
    scene.dispose();
    registerMeshCollapse();
  }
}

/** Loads with integers and with floats, checks that everything is in the same places, and returns the types of each mesh with integers. */
async function loadBoth(glb) {
  const [found, expected] = [await inWorld(glb, { integers: true }), await inWorld(glb)];
  assert.equal(found.length, expected.length);
  for (const [m, { points, box, isInstance }] of expected.entries()) {
    assert.equal(found[m].isInstance, isInstance);
    const distance = (a, b) => Math.hypot(...a.map((value, c) => value - b[c]));
    const slack = 1e-6 * (distance(...box) + Math.hypot(...box[0]));
    for (const [i, point] of points.entries()) assert.ok(distance(point, found[m].points[i]) <= slack, `vertex ${i}: ${found[m].points[i]} and ${point}`);
    for (const [end, corner] of box.entries()) assert.ok(distance(corner, found[m].box[end]) <= slack, `box: ${found[m].box[end]} and ${corner}`);
  }
  return found.map(({ types }) => types);
}

test('Babylon.js gets integers if it is asked for them, in the same places', async () => {
  const [usual] = await loadBoth(convert(readSample('textured')));
  assert.deepEqual(usual, { position: 5123, normal: 5122, tangent: 5122, uv: 5123 });
  const several = convert(readSample('shared_vertices'));
  assert.deepEqual((await loadBoth(several)).map(({ position }) => position), [5123, 5123, 5123]);
  const [{ position }] = await loadBoth(convert(readSample('textured'), ['--lossless']));
  assert.equal(position, 5126);
  await loadBoth(convert(readSample('quantized')));
});

test('Babylon.js keeps positions float where a lattice would move something else', async () => {
  const glb = convert(readSample('textured'));
  const positionsOf = async (change, source = glb) => (await loadBoth(changed(source, change))).map(({ position }) => position);
  const node = ({ nodes }) => nodes.find(({ mesh }) => mesh === 0);
  const turned = { translation: [1, 2, 3], rotation: [0.6, 0, 0, 0.8], scale: [1, 2, -3] };
  const twice = (json) => {
    json.nodes.push({ mesh: 0, ...turned });
    json.scenes[0].nodes.push(json.nodes.length - 1);
  };
  const parent = (json) => {
    json.nodes.push({ mesh: 0, translation: [5, 5, 5] });
    Object.assign(node(json), { ...turned, children: [json.nodes.length - 1] });
  };
  assert.deepEqual(await positionsOf((json) => Object.assign(node(json), turned)), [5123]);
  assert.deepEqual(await positionsOf((json) => Object.assign(node(json), { matrix: [0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 3, 0, 7, 8, 9, 1] })), [5123]);
  assert.deepEqual(await positionsOf(twice), [5123, 5123], 'two nodes with one mesh');
  assert.deepEqual(await positionsOf(parent), [5126, 5126], 'a node with a child');
  assert.deepEqual(new Set(await positionsOf(parent, convert(readSample('two_materials')))), new Set([5123]), 'a node of primitives, with a child');
  assert.deepEqual(await positionsOf((json) => {
    json.materials[0].extensions = { KHR_materials_volume: { thicknessFactor: 1 } };
    json.extensionsUsed.push('KHR_materials_volume');
  }), [5126], 'a volume');
  const [morphed] = await loadBoth(convert(readSample('morphed')));
  assert.equal(morphed.position, 5126);
  const [{ position, normal, matricesWeights }] = await loadBoth(skinnedAlone());
  assert.deepEqual({ position, normal, matricesWeights }, { position: 5126, normal: 5122, matricesWeights: 5126 }, 'skinned');
});

/** The corners of the box of each mesh, in the world. */
const boxesOf = (meshes) => meshes.filter(({ geometry }) => geometry).map((mesh) => {
  mesh.computeWorldMatrix(true);
  const { minimumWorld, maximumWorld } = mesh.getBoundingInfo().boundingBox;
  return [...minimumWorld.asArray(), ...maximumWorld.asArray()].map((value) => value.toFixed(4));
}).sort();

for (const isRightHanded of [false, true]) {
  test(`Babylon.js shows a preview where the primitive will be, and blocks that replace it; right-handed: ${isRightHanded}`, async () => {
    const scene = new Scene(engine);
    scene.useRightHandedSystem = isRightHanded;
    const told = [];
    let [boxes, preview] = [];
    const onPreview = (group, info) => {
      told.push(info);
      preview = group.getChildMeshes();
      boxes = boxesOf(preview);
      const [{ material, sideOrientation }] = preview;
      assert.deepEqual(material.albedoColor.asArray(), [0.25, 0.5, 0.75]);
      assert.deepEqual([material.backFaceCulling, material.roughness, material.metallic, sideOrientation], [false, 0.5, 1, isRightHanded ? 1 : 0]);
      assert.equal(preview[0].getTotalIndices(), 3 * 4096);
    };
    const container = await loadWithPreview(previewedGlb(), scene, { onPreview });
    assert.deepEqual(told, [{ index: 0, blockCount: 1, mesh: 0, primitive: 0 }]);
    assert.deepEqual([scene.meshes.length, scene.materials.length, scene.transformNodes.length], [0, 0, 0], 'what was shown is gone');
    container.addAllToScene();
    assert.equal(boxes.length, 2);
    assert.deepEqual(boxes, boxesOf(container.meshes));

    const counts = [];
    await loadWithPreview(previewedGlb(), scene, { onPreview, onBlock: (group, { index, blockCount }) => {
      counts.push(group.getChildMeshes().length);
      assert.equal(preview[0].isDisposed(), index === blockCount - 1);
    } });
    assert.ok(counts.length > 3);
    assert.deepEqual(counts, counts.map((_, i) => 2 * (i + 1) + (i < counts.length - 1 ? 2 : 0)));
    scene.dispose();
  });
}

test('Babylon.js refuses damaged previews, and shows nothing of a load that ends early', async () => {
  const scene = new Scene(engine);
  const refuses = async (glb, options, error) => {
    await assert.rejects(loadWithPreview(glb, scene, options), error);
    assert.deepEqual([scene.meshes.length, scene.materials.length, scene.transformNodes.length], [0, 0, 0]);
  };
  const damaged = previewedGlb();
  damaged[binOf(damaged) + 9] ^= 0x55;
  await refuses(damaged, { onPreview: () => assert.fail('shows it') }, { name: 'MccError', message: /^\/bufferViews\// });
  await refuses(previewedGlb((json) => { json.nodes[1].children = [0]; }), { onPreview() {} }, { message: '/nodes/0: is in the scene twice' });
  await refuses(previewedGlb(), { onPreview() { throw new Error('mine'); } }, { message: 'mine' });
  const controller = new AbortController();
  await refuses(previewedGlb(), { onPreview: () => controller.abort(new Error('mine')), signal: controller.signal }, { message: 'mine' });
  await refuses(new Uint8Array(), { onPreview: 7 }, { code: 'BadArgument' });
  scene.dispose();
});
