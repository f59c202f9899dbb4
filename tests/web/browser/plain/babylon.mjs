// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
const { BABYLON } = globalThis; // of the UMD build
const canvas = document.querySelector('canvas');
const engine = new BABYLON.Engine(canvas, true, { preserveDrawingBuffer: true });
BABYLON.SceneLoader.ShowLoadingScreen = false;

globalThis.draw = async (url) => {
  const scene = new BABYLON.Scene(engine);
  scene.clearColor = new BABYLON.Color4(1, 1, 1, 1);
  new BABYLON.HemisphericLight('sky', new BABYLON.Vector3(0, 1, 0), scene);
  try {
    await BABYLON.AppendSceneAsync(url, scene);
    scene.createDefaultCamera(true);
    scene.activeCamera.alpha += 0.5;
    await scene.whenReadyAsync();
    scene.render();
    return canvas.toDataURL();
  } finally {
    scene.dispose();
  }
};
