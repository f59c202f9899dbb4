// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A city that `gltf-mcc tiles` has compressed looks in CesiumJS as it did before, by the README's service worker and by gltf-mcc/cesium, and
// what one picks in it is the same.
// MCC_SCREENSHOTS=FOLDER saves the pictures.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtemp, readdir, readFile, rm, stat, writeFile } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { payloadsOf } from '../../../lib/web/document.mjs';
import { readGlb } from '../../../lib/web/unpack.mjs';
import { SAMPLES } from '../support/paths.mjs';
import { convert, PROGRAM, readSample } from '../support/program.mjs';
import { isDecoding, launchBrowser, openPage } from './support/browser.mjs';
import { coverageOf, differenceOf, readPicture, writePicture } from './support/pixels.mjs';
import { startServer } from './support/server.mjs';

/** Places of the camera and what it looks at, in metres to the east, to the north and up from the market; how many pixels it picks. */
const CAMERAS = {
  whole: { from: [-230, -420, 190], to: [20, -20, 0], columns: 10, rows: 6 },
  houses: { from: [-42, -128, 44], to: [-8, -50, 5], columns: 12, rows: 8 },
  north: { from: [0, 4, 46], to: [12, 80, 5], columns: 9, rows: 6 },
};

/**
 * The default promises 1/16 of a tile's geometric error. CesiumJS shows a tile whose error has up to 16 pixels, its default, unless it
 * is a leaf, and these are promised as much as their parents' halves; so vertices move by up to a pixel, which changes pixels at edges
 * alone: silhouettes, and the borders of windows and tiles in pictures. Faces between them change their shading only by what
 * normals of 8 to 10 bits do, which is below the tolerance. 0.5 to 2 % of the pixels were seen to differ.
 */
const MAX_DIFFERENCE = 0.05;
const TOLERANCE = 40; // of 255
const MIN_COVERAGE = 0.6;

/** Only pixels at silhouettes, which one pixel's movement can give to a neighbour, may pick something else. At most 2 % were seen to. */
const MAX_OTHER_PICKS = 0.06;
const MIN_PICKED_IDS = { glb: 12, b3dm: 6 };

/** In a payload. */
const CHECKSUM_AT = 2;

const site = {};

before(async () => {
  site.folder = await mkdtemp(path.join(os.tmpdir(), 'gltf-mcc-city-'));
  const [source, compressed] = [path.join(SAMPLES, 'city'), path.join(site.folder, 'city')];
  execFileSync(PROGRAM, ['tiles', '--quiet', path.join(source, 'tileset.json'), compressed]);
  [site.server, site.browser] = await Promise.all([startServer(new Map()), launchBrowser()]);
  site.bytes = { source: await serveFolder('source', source), compressed: await serveFolder('compressed', compressed) };
});

after(async () => {
  await site.browser?.close();
  await site.server?.close();
  if (site.folder) await rm(site.folder, { recursive: true });
});

/** Serves the files of a tileset as /files/NAME/…; returns how many bytes its tiles and tilesets have. */
async function serveFolder(name, folder) {
  let bytes = 0;
  for (const file of await readdir(folder, { recursive: true })) {
    const full = path.join(folder, file);
    if (!(await stat(full)).isFile() || file.startsWith('.')) continue;
    const body = await readFile(full);
    const type = { '.json': 'application/json', '.glb': 'model/gltf-binary', '.png': 'image/png' }[path.extname(file)];
    site.server.files.set(`${name}/${file.split(path.sep).join('/')}`, { body, headers: { 'Content-Type': type ?? 'application/octet-stream' } });
    bytes += body.length;
  }
  return bytes;
}

const isRegistered = () => globalThis.draw !== undefined && globalThis.isRegistered;

/** Opens the page, whose requests go through the service worker or, with `isInPage`, are decoded by gltf-mcc/cesium. */
async function openCity(name, isInPage = false) {
  const address = `${site.server.origin}/plain/tiles.html?eval&${isInPage ? 'cesium' : 'worker'}`;
  const { page } = await openPage(site.browser, address, isInPage ? isRegistered : isDecoding);
  await page.setViewportSize({ width: 600, height: 400 });
  await page.evaluate((url) => globalThis.load(url), `/files/${name}/tileset.json`);
  return page;
}

/** The middles of a grid of pixels. */
function gridOf({ width, height }, { columns, rows }) {
  const pixels = [];
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      pixels.push([(column + 0.5) * width / columns, (row + 0.5) * height / rows].map(Math.floor));
    }
  }
  return pixels;
}

/** Looks at a city from all places: { CAMERA: { picture, tiles, picks } }. */
async function viewsOf(name) {
  const page = await openCity(name);
  const views = {};
  for (const [camera, place] of Object.entries(CAMERAS)) {
    const { picture, failures, tiles } = await page.evaluate((at) => globalThis.look(at), place);
    assert.deepEqual(failures, [], `${name}, ${camera}`);
    views[camera] = { picture: readPicture(picture), tiles };
    views[camera].picks = await page.evaluate((pixels) => globalThis.pickAll(pixels), gridOf(views[camera].picture, place));
    const folder = process.env.MCC_SCREENSHOTS;
    if (folder) await writeFile(path.join(folder, `city_${camera}_${name}.png`), writePicture(views[camera].picture));
  }
  await page.close();
  return views;
}

const stemOf = (tile) => tile.replace(/\.[^.]+$/, '');
/** What a pixel picks, as text: the tile without the kind of its file, the id, and all properties. */
const textOf = (pick) => (pick === null ? 'nothing' : JSON.stringify([stemOf(pick.tile), pick.id, pick.properties]));

test('a compressed city looks the same in CesiumJS, and the same is picked in it', async (t) => {
  const views = { source: await viewsOf('source'), compressed: await viewsOf('compressed') };
  assert.deepEqual(site.server.missing, []);
  assert.ok(site.bytes.compressed < 0.7 * site.bytes.source, `${site.bytes.compressed} of ${site.bytes.source} bytes`);
  for (const camera of Object.keys(CAMERAS)) {
    await t.test(`the picture of ${camera}`, () => comparePictures(views.source[camera], views.compressed[camera]));
    await t.test(`picking in ${camera}`, () => comparePicks(views.source[camera].picks, views.compressed[camera].picks));
  }
  await t.test('all levels and kinds of tiles were seen', () => checkTiles(views.source));
  await t.test('ids of property tables and of batch tables were picked', () => checkIds(views.compressed));
});

test('gltf-mcc/cesium shows the same as the service worker, and says why a tile fails', async () => {
  const lookFrom = async (page) => page.evaluate((at) => globalThis.look(at), CAMERAS.houses);
  const [byWorker, inPage] = [await openCity('compressed'), await openCity('compressed', true)];
  const [expected, seen] = [await lookFrom(byWorker), await lookFrom(inPage)];
  assert.deepEqual([seen.failures, seen.tiles], [[], expected.tiles]);
  assert.ok(differenceOf(readPicture(expected.picture), readPicture(seen.picture)) < 0.001);
  await byWorker.close();

  const { files } = site.server;
  const kept = new Map([...files].filter(([name]) => /^compressed.*\.(glb|b3dm|i3dm|cmpt)$/.test(name)));
  for (const [name, { body, headers }] of kept) files.set(name, { body: damaged(body), headers });
  await inPage.evaluate((url) => globalThis.load(url), '/files/compressed/tileset.json?again');
  const { failures } = await lookFrom(inPage);
  for (const [name, file] of kept) files.set(name, file);
  assert.ok(failures.length > 0);
  for (const failure of failures) assert.match(failure, /the payload is damaged/);
  await inPage.close();
});

test('gltf-mcc/cesium loads a .gltf with its buffers', async () => {
  const { json, chunks: [{ data }] } = readGlb(convert(readSample('textured')));
  json.buffers[0].uri = 'model.bin';
  const root = { boundingVolume: { sphere: [0, 0, 0, 100] }, geometricError: 0, refine: 'ADD', content: { uri: 'model.gltf' } };
  const tileset = { asset: { version: '1.1' }, geometricError: 100, root };
  const files = { 'tileset.json': JSON.stringify(tileset), 'model.gltf': JSON.stringify(json), 'model.bin': data };
  for (const [name, body] of Object.entries(files)) site.server.files.set(`document/${name}`, { body: Buffer.from(body) });
  const page = await openCity('document', true);
  const { failures, tiles } = await page.evaluate((at) => globalThis.look(at), CAMERAS.whole);
  assert.deepEqual([failures, tiles], [[], ['model.gltf']]);
  await page.close();
});

/** A tile with a wrong checksum in each payload of the models inside. */
function damaged(tile) {
  const copy = Buffer.from(tile);
  for (let at = -1; (at = copy.indexOf('glTF', at + 1)) >= 0;) {
    if (copy.readUint32LE(at + 4) !== 2) continue; // these four letters of something else
    const { json, chunks } = readGlb(copy.subarray(at, at + copy.readUint32LE(at + 8)));
    for (const { bufferView } of payloadsOf(json)) chunks[0].data[(json.bufferViews[bufferView].byteOffset ?? 0) + CHECKSUM_AT] ^= 1;
  }
  return copy;
}

function comparePictures(source, compressed) {
  assert.deepEqual(compressed.tiles.map(stemOf), source.tiles.map(stemOf));
  const [coverage, difference] = [coverageOf(source.picture), differenceOf(source.picture, compressed.picture, TOLERANCE)];
  if (process.env.MCC_SCREENSHOTS) console.log({ coverage, difference });
  assert.ok(coverage > MIN_COVERAGE, `${coverage} of the picture is not background`);
  assert.ok(difference < MAX_DIFFERENCE, `${difference} of the pixels differ`);
}

function comparePicks(source, compressed) {
  const others = source.filter((pick, i) => textOf(pick) !== textOf(compressed[i])).length / source.length;
  if (process.env.MCC_SCREENSHOTS) console.log({ others });
  assert.ok(others <= MAX_OTHER_PICKS, `${others} of the pixels pick something else`);
}

function checkTiles(views) {
  const seen = new Set(Object.values(views).flatMap(({ tiles }) => tiles));
  for (const kind of [/^1-/, /^2-/, /-blocks\.glb$/, /^district-\d\.glb$/, /-lamps\.glb$/, /\.b3dm$/, /\.i3dm$/, /\.cmpt$/]) {
    assert.ok([...seen].some((tile) => kind.test(tile)), `no tile ${kind} among ${[...seen].join(', ')}`);
  }
}

/** Each feature that was picked has a name and is one of a property table (glb) or of a batch table (district-1 is a b3dm). */
function checkIds(views) {
  const names = { glb: new Set(), b3dm: new Set() };
  for (const { picks } of Object.values(views)) {
    for (const pick of picks) {
      if (pick?.properties.name === undefined) continue;
      names[/district-1\.|district-3\./.test(pick.tile) ? 'b3dm' : 'glb'].add(`${pick.tile} ${pick.id} ${pick.properties.name}`);
    }
  }
  if (process.env.MCC_SCREENSHOTS) console.log(names.glb.size, names.b3dm.size);
  for (const [kind, count] of Object.entries(MIN_PICKED_IDS)) {
    assert.ok(names[kind].size >= count, `only ${names[kind].size} features of ${kind} were picked`);
  }
}
