// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Shows a tileset (3D Tiles 1.1) whose four tiles are the model.
globalThis.CESIUM_BASE_URL = '/engines/cesium/Build/Cesium/'; // wanted when the module is loaded
const { Cartesian3, Cesium3DTileset, Color, DirectionalLight, HeadingPitchRange, Scene } = await import('/engines/cesium/Build/Cesium/index.js');

const canvas = document.querySelector('canvas');
const scene = new Scene({ canvas, contextOptions: { webgl: { preserveDrawingBuffer: true } } });
scene.backgroundColor = Color.WHITE;
scene.light = new DirectionalLight({ direction: new Cartesian3(-3, -1, -2), intensity: 4 }); // the sun moves

globalThis.draw = async (url) => {
  scene.primitives.removeAll();
  const tileset = await Cesium3DTileset.fromUrl(url.replace(/[^/]+$/, 'tileset.json'), { maximumScreenSpaceError: 1 });
  tileset.imageBasedLighting.imageBasedLightingFactor.x = tileset.imageBasedLighting.imageBasedLightingFactor.y = 0;
  scene.primitives.add(tileset);
  const failure = new Promise((_, reject) => tileset.tileFailed.addEventListener(({ message }) => reject(new Error(message))));
  scene.camera.lookAt(tileset.boundingSphere.center, new HeadingPitchRange(0.5, -0.6, 2.2 * tileset.boundingSphere.radius));
  for (let last = ''; ;) {
    for (let i = 0; i < 10; ++i) await Promise.race([nextFrame(), failure]);
    const picture = canvas.toDataURL();
    if (tileset.tilesLoaded && picture === last) return picture;
    last = picture;
  }
};

async function nextFrame() {
  await new Promise(requestAnimationFrame);
  scene.initializeFrame();
  scene.render();
}
