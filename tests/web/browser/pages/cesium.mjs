// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { DISTANCE, FIELD_OF_VIEW_DEGREES, HEIGHT, TOWARDS_CAMERA, WIDTH, newCanvas, runSnippet } from './stage.mjs';

globalThis.CESIUM_BASE_URL = '/engines/cesium/Build/Cesium/'; // wanted when the module is loaded
const { Cartesian2, Cartesian3, Color, DirectionalLight, Scene } = await import('cesium');

const canvas = newCanvas();
const scene = new Scene({ canvas, contextOptions: { webgl: { preserveDrawingBuffer: true } } });
scene.backgroundColor = Color.WHITE;
scene.light = new DirectionalLight({ direction: new Cartesian3(-3, -1, -2), intensity: 4 }); // the sun moves
scene.camera.frustum.fov = FIELD_OF_VIEW_DEGREES * (WIDTH / HEIGHT) * Math.PI / 180; // the horizontal one

globalThis.draw = async (name) => {
  scene.primitives.removeAll();
  await runSnippet('CesiumJS', name, { scene }).catch(({ message }) => { throw new Error(message); }); // it throws others
  const model = scene.primitives.get(0);
  model.imageBasedLighting.imageBasedLightingFactor = Cartesian2.ZERO; // it changes while it gets ready
  const failure = new Promise((_, reject) => model.errorEvent.addEventListener(reject));
  while (!model.ready) await Promise.race([nextFrame(), failure]);
  placeCamera(model.boundingSphere);
  return stablePicture();
};

// The camera's own functions use directions of the sky, and the model is in the middle of the Earth.
function placeCamera({ center, radius }) {
  const [x, y, z] = TOWARDS_CAMERA;
  const towards = Cartesian3.normalize(new Cartesian3(z, x, y), new Cartesian3()); // the engine turns y up into z up
  const offset = Cartesian3.multiplyByScalar(towards, DISTANCE * radius, new Cartesian3());
  const destination = Cartesian3.add(center, offset, new Cartesian3());
  const direction = Cartesian3.negate(towards, new Cartesian3());
  const right = Cartesian3.normalize(Cartesian3.cross(direction, Cartesian3.UNIT_Z, new Cartesian3()), new Cartesian3());
  scene.camera.setView({ destination, orientation: { direction, up: Cartesian3.cross(right, direction, new Cartesian3()) } });
}

// Textures come when they are ready, and nothing says so.
async function stablePicture() {
  for (let last = ''; ;) {
    for (let i = 0; i < 10; ++i) await nextFrame();
    const picture = canvas.toDataURL();
    if (picture === last) return picture;
    last = picture;
  }
}

async function nextFrame() {
  await new Promise(requestAnimationFrame);
  scene.initializeFrame();
  scene.render();
}
