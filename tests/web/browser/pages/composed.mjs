// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { HEIGHT, WIDTH, newCanvas, runSnippet } from './stage.mjs';

const renderer = new THREE.WebGLRenderer({ canvas: newCanvas(), antialias: true });
renderer.setSize(WIDTH, HEIGHT, false);

/** Loads by the README's snippet. `isFirst`: plugins run in the order in which they were registered; ours comes before all others. */
globalThis.draw = async (model, isFirst) => {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xffffff);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x444444, 3));
  const { register, loadAsync } = GLTFLoader.prototype;
  let gltf;
  GLTFLoader.prototype.loadAsync = async function (url) {
    if (isFirst) this.pluginCallbacks.unshift(this.pluginCallbacks.pop());
    return (gltf = await loadAsync.call(this, url));
  };
  try {
    await runSnippet('With meshopt and KTX2', model, { scene, renderer });
  } finally {
    Object.assign(GLTFLoader.prototype, { register, loadAsync });
  }
  const mixer = new THREE.AnimationMixer(gltf.scene);
  mixer.clipAction(gltf.animations[0]).play();
  mixer.setTime(1);
  const camera = new THREE.PerspectiveCamera(45, WIDTH / HEIGHT, 0.1, 100);
  camera.position.set(3, 4, 5);
  camera.lookAt(0, 0, -1);
  renderer.render(scene, camera);
  const instanceCounts = [];
  scene.traverse(({ isInstancedMesh, count }) => isInstancedMesh && instanceCounts.push(count));
  const keyCounts = gltf.animations[0].tracks.map(({ times }) => times.length);
  return { picture: renderer.domElement.toDataURL(), instanceCounts, keyCounts };
};
