// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Shows a tileset of 3D Tiles in CesiumJS from given places, and tells what is under its pixels. ?width=…&height=… make the picture
// larger.
globalThis.CESIUM_BASE_URL = '/engines/cesium/Build/Cesium/'; // wanted when the module is loaded
const Cesium = await import('/engines/cesium/Build/Cesium/index.js');
const { Cartesian2, Cartesian3, Cesium3DTileset, Color, DirectionalLight, Matrix4, Scene } = Cesium;

const canvas = document.querySelector('canvas');
const size = new URLSearchParams(location.search);
for (const side of ['width', 'height']) canvas[side] = size.get(side) ?? canvas[side];
const scene = new Scene({ canvas, contextOptions: { webgl: { preserveDrawingBuffer: true } } });
scene.backgroundColor = Color.fromCssColorString('#bcd3e6');

let tileset;
let failures = [];

/** Loads a tileset in place of the one before. */
globalThis.load = async (url, options = {}) => {
  scene.primitives.removeAll();
  failures = [];
  tileset = await Cesium3DTileset.fromUrl(url, { skipLevelOfDetail: false, ...options });
  tileset.imageBasedLighting.imageBasedLightingFactor = new Cartesian2(0.6, 0);
  tileset.tileFailed.addEventListener(({ url: at, message }) => failures.push(`${at}: ${message}`));
  scene.primitives.add(tileset);
};

/**
 * Looks from a place to another, both in metres to the east, to the north and up of the tileset's origin.
 * @returns {Promise<object>} the picture once all tiles are there and it no longer changes; what failed; the tiles it shows
 */
globalThis.look = async ({ from, to, sun = [0.5, 0.5, -0.75] }) => {
  const place = tileset.root.computedTransform;
  const vector = (v) => Matrix4.multiplyByPointAsVector(place, Cartesian3.fromArray(v), new Cartesian3());
  scene.light = new DirectionalLight({ direction: Cartesian3.normalize(vector(sun), new Cartesian3()), intensity: 3.4 });
  const direction = Cartesian3.normalize(vector(to.map((x, i) => x - from[i])), new Cartesian3());
  const right = Cartesian3.normalize(Cartesian3.cross(direction, vector([0, 0, 1]), new Cartesian3()), new Cartesian3());
  scene.camera.setView({
    destination: Matrix4.multiplyByPoint(place, Cartesian3.fromArray(from), new Cartesian3()),
    orientation: { direction, up: Cartesian3.cross(right, direction, new Cartesian3()) },
  });
  const picture = await stablePicture();
  return { picture, failures, tiles: shownTiles() };
};

/** What is under pixels: [{ id, properties, tile } or null], where `tile` is the name of a file. Each pixel takes a frame. */
globalThis.pickAll = (pixels) => pixels.map(([x, y]) => {
  const picked = scene.pick(new Cartesian2(x, y));
  if (picked?.primitive !== tileset || picked.featureId === undefined) return null;
  const names = picked.getPropertyIds();
  const properties = Object.fromEntries(names.sort().map((name) => [name, picked.getProperty(name)]));
  return { id: picked.featureId, properties, tile: nameOf(picked.content.url) };
});

const SETTLED_COUNT = 2; // equal pictures in a row, each some frames after the one before

async function stablePicture() {
  for (let last = '', equal = 0; ;) {
    for (let i = 0; i < 5; ++i) await nextFrame();
    const picture = canvas.toDataURL();
    equal = tileset.tilesLoaded && picture === last ? equal + 1 : 0;
    if (equal === SETTLED_COUNT) return picture;
    last = picture;
  }
}

async function nextFrame() {
  await new Promise(requestAnimationFrame);
  scene.initializeFrame();
  scene.render();
}

/** The files of the tiles on the last picture, sorted. */
function shownTiles() {
  const urls = [];
  for (const { content } of tileset._selectedTiles) urls.push(...(content.innerContentUrls ?? [content.url]));
  return urls.map(nameOf).sort();
}

const nameOf = (url) => url.slice(url.lastIndexOf('/') + 1).replace(/\?.*$/, '');

globalThis.draw = globalThis.look; // tells that the module is there
