// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Loads a tileset (3D Tiles) and says how long it took; for tools/bench-tiles.
globalThis.CESIUM_BASE_URL = '/engines/cesium/Build/Cesium/'; // wanted when the module is loaded
const { Cesium3DTileset, Color, DirectionalLight, Cartesian3, HeadingPitchRange, Resource, Scene } = await import('/engines/cesium/Build/Cesium/index.js');

const FRAME_MS = 10;
const canvas = document.querySelector('canvas');
const scene = new Scene({ canvas });
scene.backgroundColor = Color.WHITE;
scene.light = new DirectionalLight({ direction: new Cartesian3(-3, -1, -2), intensity: 4 });

/**
 * Loads what a camera needs that looks at the middle of a tileset.
 * @param {string} url of its tileset.json
 * @param {number} distance of the camera, in radii of the tileset's sphere
 * @returns {Promise<{ ms: number, tiles: number, failed: number, failure?: string }>} ms: from the first request until all its tiles are there
 */
globalThis.load = async (url, distance) => {
  for (let i = 0; i < 10; ++i) await nextFrame(); // compiles what does not depend on tiles
  // CesiumJS asks this before its first texture: it reads a pixel, which waits for all that was drawn before, seconds without a graphics card.
  await Resource.supportsImageBitmapOptions();
  const begin = performance.now();
  // Hidden: without a graphics card shaders and drawing take seconds, which say nothing about loading.
  const tileset = await Cesium3DTileset.fromUrl(url, { maximumScreenSpaceError: 8, show: false, preloadWhenHidden: true });
  tileset.environmentMapManager.enabled = false; // draws a sky and filters it
  const failures = [];
  tileset.tileFailed.addEventListener(({ message }) => failures.push(message));
  scene.primitives.add(tileset);
  const { center, radius } = tileset.boundingSphere;
  scene.camera.lookAt(center, new HeadingPitchRange(0.5, -0.6, distance * radius));
  let ms;
  for (let idle = 0; idle < 5;) {
    await nextFrame();
    idle = tileset.tilesLoaded ? idle + 1 : 0;
    if (idle === 1) ms = performance.now() - begin; // tiles that come may ask for their children
  }
  return { ms, tiles: tileset.statistics?.numberOfTilesWithContentReady ?? 0, failed: failures.length, failure: failures[0] };
};

async function nextFrame() {
  await new Promise((resolve) => setTimeout(resolve, FRAME_MS)); // not requestAnimationFrame, which waits for the picture
  scene.initializeFrame();
  scene.render();
}
