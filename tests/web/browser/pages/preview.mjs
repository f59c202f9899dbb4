// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Loads a model with loadWithPreview(), and says how many triangles three.js draws whenever something was shown.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { loadWithPreview, registerMeshCollapse } from 'gltf-mcc/three';
import { HEIGHT, newCanvas, WIDTH } from './stage.mjs';

const renderer = new THREE.WebGLRenderer({ canvas: newCanvas() });
renderer.setSize(WIDTH, HEIGHT, false);
const loader = registerMeshCollapse(new GLTFLoader());

/** Returns the number of triangles that three.js drew. */
function draw(scene) {
  const camera = new THREE.PerspectiveCamera(50, WIDTH / HEIGHT, 0.01, 100);
  camera.position.set(0, 0, 10);
  renderer.render(scene, camera);
  return renderer.info.render.triangles;
}

/** Begins to load. `state` has the triangles that were drawn, and in the end `result`. */
globalThis.begin = (url) => {
  const scene = new THREE.Scene();
  const controller = new AbortController();
  const state = { previews: [], blocks: [], abort: () => controller.abort(new Error('enough')), left: () => draw(scene), memory: renderer.info.memory };
  const show = (drawn) => (group) => {
    scene.add(group);
    drawn.push(draw(scene));
  };
  const options = { onPreview: show(state.previews), onBlock: show(state.blocks), signal: controller.signal };
  loadWithPreview(loader, url, options).then((gltf) => {
    scene.add(gltf.scene);
    state.result = 'loaded';
  }, (error) => { state.result = error.message; });
  globalThis.state = state;
};
