// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What preview.mjs does, with Babylon.js.
import '@babylonjs/loaders/glTF/2.0/index.js';
import '@babylonjs/loaders/glTF/glTFFileLoader.js';
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { HemisphericLight } from '@babylonjs/core/Lights/hemisphericLight.js';
import { SceneLoaderFlags } from '@babylonjs/core/Loading/sceneLoaderFlags.js';
import { Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Scene } from '@babylonjs/core/scene.js';
import { loadWithPreview, registerMeshCollapse } from 'gltf-mcc/babylon';
import { newCanvas } from './stage.mjs';

SceneLoaderFlags.ShowLoadingScreen = false;
const engine = new Engine(newCanvas(), true, { preserveDrawingBuffer: true });
registerMeshCollapse();

/** Returns the number of triangles in sight, which are drawn once shaders are compiled. */
function draw(scene) {
  scene.render();
  const { data, length } = scene.getActiveMeshes();
  return data.slice(0, length).reduce((sum, mesh) => sum + mesh.getTotalIndices() / 3, 0);
}

/** Whether something is seen then. */
async function isSeen(scene) {
  await scene.whenReadyAsync();
  scene.render();
  return new Uint32Array((await engine.readPixels(0, 0, engine.getRenderWidth(), engine.getRenderHeight())).buffer).some((pixel, _, all) => pixel !== all[0]);
}

globalThis.begin = (url) => {
  const scene = new Scene(engine);
  scene.clearColor = new Color4(0, 0, 0, 1);
  scene.useRightHandedSystem = true;
  new HemisphericLight('sky', new Vector3(0, 1, 0), scene);
  new FreeCamera('camera', new Vector3(0, 0, 10), scene).setTarget(Vector3.Zero());
  const controller = new AbortController();
  const memory = { get geometries() { return scene.geometries.length; } };
  const state = { previews: [], blocks: [], abort: () => controller.abort(new Error('enough')), left: () => draw(scene), isSeen: () => isSeen(scene), memory };
  const show = (drawn) => () => { drawn.push(draw(scene)); };
  loadWithPreview(url, scene, { onPreview: show(state.previews), onBlock: show(state.blocks), signal: controller.signal }).then((container) => {
    container.addAllToScene();
    state.result = 'loaded';
  }, (error) => { state.result = error.message; });
  globalThis.state = state;
};
