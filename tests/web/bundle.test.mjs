// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the plugins add to a page that loads models anyway: scripts, minified by Vite, after brotli. The README's figures are from here.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { brotliBytes, scriptBytesOf } from './support/bundle.mjs';
import { LIBRARY } from './support/paths.mjs';

const THREE = (imports, setup) => `
import { HemisphereLight, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
${imports}
const renderer = new WebGLRenderer();
document.body.append(renderer.domElement);
const scene = new Scene().add(new HemisphereLight());
const camera = new PerspectiveCamera();
camera.position.z = 3;
const loader = new GLTFLoader();
${setup}
const { scene: model } = await loader.loadAsync('model.glb');
scene.add(model);
renderer.setAnimationLoop(() => renderer.render(scene, camera));
`;

const BABYLON = (imports, setup) => `
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { AppendSceneAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { Scene } from '@babylonjs/core/scene.js';
import '@babylonjs/loaders/glTF/2.0/index.js';
import '@babylonjs/loaders/glTF/glTFFileLoader.js';
${imports}
const canvas = document.createElement('canvas');
document.body.append(canvas);
const engine = new Engine(canvas);
const scene = new Scene(engine);
${setup}
await AppendSceneAsync('model.glb', scene);
scene.createDefaultCameraOrLight(true, true, true);
engine.runRenderLoop(() => scene.render());
`;

/** With the worker, and with the decoder of the page's thread, which both have. */
const LARGEST_BYTES = { three: 12_400, babylon: 11_900 };

/** Returns what a page has more than without the plugin. */
async function added(plain, page, imports, setup) {
  const { page: bytes, worker, later } = await scriptBytesOf(page(imports, setup));
  const more = { page: bytes - plain.page, worker, later };
  return { ...more, all: more.page + worker };
}

const count = (bytes) => bytes.toLocaleString('en-US');

function report(name, plain, { page, worker, later, all }) {
  console.log(`${name}: ${count(plain.page)} bytes without the plugin, which adds ${count(all)} (page ${count(page)}, worker ${count(worker)}); `
    + `for large surfaces, and where no worker can start, ${count(later)} more`);
}

test('what the plugin adds to a page with three.js', async () => {
  const plain = await scriptBytesOf(THREE('', ''));
  const ours = await added(plain, THREE, "import { MeshCollapsePlugin } from 'gltf-mcc/three';",
    'loader.register((parser) => new MeshCollapsePlugin(parser));');
  report('three.js, GLTFLoader', plain, ours);
  const meshopt = await added(plain, THREE, "import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';",
    'loader.setMeshoptDecoder(MeshoptDecoder);');
  const module = brotliBytes(readFileSync(path.join(LIBRARY, 'wasm/mcc_decoder_core_simd.wasm')));
  console.log(`to compare: meshopt adds ${count(meshopt.all)}, with its WebAssembly in the script; ours, mcc_decoder_core_simd.wasm, has ${count(module)}`);
  assert.ok(ours.all <= LARGEST_BYTES.three, `${ours.all} bytes`);
});

test('what the plugin adds to a page with Babylon.js', async () => {
  const plain = await scriptBytesOf(BABYLON('', ''));
  const ours = await added(plain, BABYLON, "import { registerMeshCollapse } from 'gltf-mcc/babylon';", 'registerMeshCollapse();');
  report('Babylon.js, glTF loader', plain, ours);
  assert.ok(ours.all <= LARGEST_BYTES.babylon, `${ours.all} bytes`);
});
