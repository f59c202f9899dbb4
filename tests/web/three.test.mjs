// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import './support/peers.mjs';
import { Box3, DoubleSide, Group, Scene, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { createDecoderPool, decodePayload } from '../../lib/web/index.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { blocksGlb, trianglesOf, trianglesOfBlocks } from './support/blocks.mjs';
import { changed, skinnedAlone } from './support/changed.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { compareWithManifest, refusesNegatives } from './support/loaders.mjs';
import { binOf, previewedGlb } from './support/previews.mjs';
import { convert, convertWithFallback, readSample } from './support/program.mjs';

const { loadWithPreview, MeshCollapsePlugin, registerMeshCollapse } = await import('../../lib/web/three.mjs');

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

const meshesOf = ({ scene }) => scene.getObjectsByProperty('isMesh', true);
const typeOf = (attribute) => (attribute.data ?? attribute).array.constructor.name;
const typesOf = ({ geometry }) => Object.fromEntries(Object.entries(geometry.attributes).map(([name, attribute]) => [name, typeOf(attribute)]));

/** Checks that the meshes of two models are the same to what integers lose, and returns the types of each with integers. */
function compareModels(integers, floats) {
  for (const { scene } of [integers, floats]) scene.updateMatrixWorld(true);
  const [found, expected] = [meshesOf(integers), meshesOf(floats)];
  assert.equal(found.length, expected.length);
  const countOf = (scene) => {
    let count = 0;
    scene.traverse(() => ++count);
    return count;
  };
  assert.equal(countOf(integers.scene), countOf(floats.scene), 'no node is added');
  const boxes = [integers, floats].map(({ scene }) => new Box3().setFromObject(scene));
  const size = boxes[1].getSize(new Vector3()).length();
  for (const end of ['min', 'max']) assert.ok(boxes[0][end].distanceTo(boxes[1][end]) < 1e-6 * size, 'bounds of the document');
  const [a, b] = [new Vector3(), new Vector3()];
  for (const [m, mesh] of found.entries()) {
    assert.ok(mesh.geometry.boundingSphere.radius > 0);
    const { position, ...others } = mesh.geometry.attributes;
    for (let i = 0; i < position.count; ++i) {
      const moved = [mesh, expected[m]].map((each, k) => each.getVertexPosition(i, [a, b][k]).applyMatrix4(each.matrixWorld));
      assert.ok(moved[0].distanceTo(moved[1]) < 1e-6 * size, `vertex ${i}: ${moved[0].toArray()} and ${moved[1].toArray()}`);
    }
    for (const [name, attribute] of Object.entries(others)) {
      const exact = expected[m].geometry.attributes[name];
      const step = { Int8Array: 1 / 127, Uint8Array: 1 / 255, Int16Array: 1 / 32767, Uint16Array: 1 / 65535 }[typeOf(attribute)] ?? 0;
      const isInteger = typeOf(exact) !== 'Float32Array';
      for (let i = 0; i < attribute.count; ++i) {
        for (let c = 0; c < attribute.itemSize; ++c) {
          const difference = Math.abs(attribute.getComponent(i, c) - exact.getComponent(i, c));
          assert.ok(difference <= (isInteger ? 0 : step / 2 + 1e-6), `${name}: ${difference}`);
        }
      }
    }
    assert.equal(typeOf(mesh.geometry.index), typeOf(expected[m].geometry.index));
  }
  return found.map(typesOf);
}

const loadBoth = async (glb, options) => compareModels(await load(glb, { integers: true, ...options }), await load(glb, options));

test('three.js gets integers if it is asked for them, in the same places', async () => {
  const usual = { position: 'Uint16Array', normal: 'Int16Array', tangent: 'Int16Array', uv: 'Uint16Array' };
  assert.deepEqual(await loadBoth(convert(readSample('textured'))), [usual]);
  assert.deepEqual(await loadBoth(convert(readSample('shared_vertices'))).then((all) => all.map(({ position }) => position)),
    ['Uint16Array', 'Uint16Array', 'Uint16Array']);
  assert.deepEqual(await loadBoth(blocksGlb('torus')).then(([{ position, normal }]) => [position, normal]), ['Uint16Array', 'Int16Array']);
  const [coarse] = await loadBoth(convert(readSample('textured'), ['--normal-bits', '6', '--texcoord-bits', '7']));
  assert.deepEqual(coarse, { ...usual, normal: 'Int8Array', uv: 'Uint8Array' });
  const [fine] = await loadBoth(convert(readSample('textured'), ['--position-bits', '20', '--texcoord-bits', '18']));
  assert.deepEqual(fine, { ...usual, position: 'Float32Array', uv: 'Float32Array' }, 'what has finer steps than 16 bits');
  const [exact] = await loadBoth(convert(readSample('textured'), ['--lossless']));
  assert.deepEqual([...new Set(Object.values(exact))], ['Float32Array']);
  const [through] = await loadBoth(convert(readSample('textured'), ['--step', '2^-10']));
  assert.equal(through.position, 'Uint16Array', 'also of a lattice through the origin');
  await loadBoth(convert(readSample('quantized')));
  await loadBoth(convert(readSample('textured'), ['--indices-only']));
  const decode = (payload, options) => decodePayload(payload, options);
  assert.deepEqual(await loadBoth(convert(readSample('textured')), { decode }), [usual], 'with a function of the application');
});

test('three.js keeps positions float where a lattice would move something else', async () => {
  const glb = convert(readSample('textured'));
  const positionOf = async (change, source = glb) => (await loadBoth(changed(source, change)))[0].position;
  const node = ({ nodes }) => nodes.find(({ mesh }) => mesh === 0);
  const turned = { translation: [1, 2, 3], rotation: [0.6, 0, 0, 0.8], scale: [1, 2, -3] };
  assert.equal(await positionOf((json) => Object.assign(node(json), turned)), 'Uint16Array');
  assert.equal(await positionOf((json) => Object.assign(node(json), { scale: [5, 1, 1] })), 'Uint16Array');
  assert.equal(await positionOf((json) => Object.assign(node(json), { matrix: [0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 3, 0, 7, 8, 9, 1] })), 'Uint16Array');
  assert.equal(await positionOf((json) => {
    json.nodes.push({ mesh: 0, ...turned });
    json.scenes[0].nodes.push(json.nodes.length - 1);
  }), 'Uint16Array', 'two nodes with one mesh');
  assert.equal(await positionOf((json) => {
    json.nodes.push({ translation: [1, 1, 1] });
    node(json).children = [json.nodes.length - 1];
  }), 'Float32Array', 'a node with a child');
  assert.equal(await positionOf((json) => {
    json.materials[0].extensions = { KHR_materials_volume: { thicknessFactor: 1 } };
    json.extensionsUsed.push('KHR_materials_volume');
  }), 'Float32Array', 'a volume');
  for (const name of ['skinned', 'morphed']) assert.equal((await loadBoth(convert(readSample(name))))[0].position, 'Float32Array', name);
  const several = (json) => {
    Object.assign(node(json), turned);
    json.nodes.push({ mesh: 0, translation: [5, 5, 5] });
    node(json).children = [json.nodes.length - 1];
  };
  assert.equal(await positionOf(several, convert(readSample('two_materials'))), 'Uint16Array', 'a group of primitives, with a child');
});

test('three.js puts the lattice of a skinned mesh before its joints', async () => {
  const glb = skinnedAlone();
  const bent = changed(glb, ({ nodes, skins }) => {
    Object.assign(nodes[skins[0].joints.at(-1)], { rotation: [0, 0, 0.6, 0.8] });
    const skinned = nodes.find(({ skin }) => skin !== undefined);
    Object.assign(skinned, { translation: [5, 5, 5] }); // means nothing
    nodes.push({ ...skinned });
    nodes[0].children = [...(nodes[0].children ?? []), nodes.length - 1];
  });
  for (const each of [glb, bent]) {
    for (const { position, normal, skinIndex, skinWeight } of await loadBoth(each)) {
      assert.deepEqual({ position, normal, skinWeight }, { position: 'Uint16Array', normal: 'Int16Array', skinWeight: 'Float32Array' });
      assert.match(skinIndex, /^Uint(8|16)Array$/);
    }
  }
  const both = changed(glb, ({ nodes }) => nodes.push({ mesh: 0 })); // which has no skin
  assert.equal(typesOf(meshesOf(await load(both, { integers: true }))[0]).position, 'Float32Array');
});

test('three.js has one attribute for accessors with the same elements', async () => {
  const glb = changed(convert(readSample('two_materials')), (json) => {
    const [first] = json.meshes[0].primitives;
    const copy = (index) => json.accessors.push({ ...json.accessors[index] }) - 1;
    const attributes = Object.fromEntries(Object.entries(first.attributes).map(([name, index]) => [name, copy(index)]));
    json.meshes.push({ primitives: [{ ...first, attributes, indices: copy(first.indices) }] });
    json.nodes.push({ mesh: json.meshes.length - 1 });
    json.scenes[0].nodes.push(json.nodes.length - 1);
  });
  const all = meshesOf(await load(glb)).map(({ geometry }) => geometry);
  const [first] = all;
  const same = all.filter(({ attributes }) => attributes.position === first.attributes.position && attributes.normal === first.attributes.normal);
  assert.ok(same.length > 1 && same.includes(all.at(-1)));
});

const placeOf = (glb) => `data:model/gltf-binary;base64,${Buffer.from(glb).toString('base64')}`;
const loadShown = (glb, options) => loadWithPreview(registerMeshCollapse(new GLTFLoader()), placeOf(glb), options);
const matricesOf = (object) => object.getObjectsByProperty('isMesh', true).map(({ matrixWorld }) => matrixWorld.toArray()).sort();

test('three.js shows a preview where the primitive will be, and blocks that replace it', async () => {
  const scene = new Scene();
  const told = [];
  let matrices;
  const onPreview = (group, info) => {
    scene.add(group);
    scene.updateMatrixWorld();
    matrices = matricesOf(group);
    told.push(info);
    const [{ material, geometry }] = group.children;
    assert.deepEqual(material.color.toArray(), [0.25, 0.5, 0.75]);
    assert.deepEqual([material.side, material.roughness, material.metalness, material.flatShading], [DoubleSide, 0.5, 1, false]);
    assert.equal(geometry.index.count, 3 * 4096);
    assert.ok(geometry.boundingSphere.radius > 0);
  };
  const gltf = await loadShown(previewedGlb(), { onPreview });
  assert.deepEqual(told, [{ index: 0, blockCount: 1, mesh: 0, primitive: 0 }]);
  assert.equal(scene.children.length, 0, 'what was shown is gone');
  gltf.scene.updateMatrixWorld();
  assert.deepEqual(matrices, matricesOf(gltf.scene));
  assert.equal(matrices.length, 2);

  const counts = [];
  const preview = [];
  const onBlock = (group, { index, blockCount }) => {
    counts.push(group.children.length);
    assert.equal(group.children.includes(preview[0]), index < blockCount - 1);
  };
  await loadShown(previewedGlb(), { onPreview: (group) => preview.push(...group.children), onBlock });
  assert.ok(counts.length > 3);
  assert.deepEqual(counts, counts.map((_, i) => 2 * (i + 1) + (i < counts.length - 1 ? 2 : 0)));
  assert.ok((await loadShown(previewedGlb())).scene, 'without functions');
});

test('three.js refuses damaged previews, and shows nothing of a load that ends early', async () => {
  const damaged = previewedGlb();
  damaged[binOf(damaged) + 9] ^= 0x55;
  await assert.rejects(loadShown(damaged, { onPreview: () => assert.fail('shows it') }), { name: 'MccError', message: /^\/bufferViews\// });
  const onPreview = () => {};
  const refuses = (change, message) => assert.rejects(loadShown(previewedGlb(change), { onPreview }), { name: 'MccError', message });
  await refuses((json) => { json.nodes[1].children = [0]; }, '/nodes/0: is in the scene twice');
  await refuses((json) => { json.nodes[1].children = [99]; }, '/nodes: there is no node 99');
  await refuses((json) => { json.nodes[1] = null; }, '/nodes/1: must be an object');
  for (const end of [
    () => { throw new Error('mine'); },
    (controller) => controller.abort(new Error('mine')),
  ]) {
    const scene = new Group();
    const controller = new AbortController();
    const show = (group) => {
      scene.add(group);
      end(controller);
    };
    await assert.rejects(loadShown(previewedGlb(), { onPreview: show, signal: controller.signal }), { message: 'mine' });
    assert.equal(scene.children.length, 0);
  }
  await assert.rejects(loadWithPreview(new GLTFLoader(), 'data:,', { onPreview: 7 }), { code: 'BadArgument' });
});

test('three.js tells the manager of a load with a preview, and asks for what the loader would ask for', async (t) => {
  const asked = [];
  t.mock.method(globalThis, 'fetch', async (place, options) => {
    asked.push({ place, ...options });
    return new Response(null, { status: 404 });
  });
  const loader = new GLTFLoader().setPath('models/').setRequestHeader({ Token: 'x' }).setWithCredentials(true);
  const told = [];
  loader.manager = { itemStart: () => told.push('start'), itemError: () => told.push('error'), itemEnd: () => told.push('end'),
    resolveURL: (place) => `https://example.com/${place}` };
  await assert.rejects(loadWithPreview(loader, 'a.glb'), { code: 'Load', message: 'cannot load https://example.com/models/a.glb: status 404' });
  assert.deepEqual(asked, [{ place: 'https://example.com/models/a.glb', headers: { Token: 'x' }, credentials: 'include', signal: undefined }]);
  assert.deepEqual(told, ['start', 'error', 'end']);
});
