// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// samples/viewer: files come in, are compressed and compared, go out; what cannot be shown gets a message. MCC_SCREENSHOTS=FOLDER
// saves koi.png, a picture of a model.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { buffer } from 'node:stream/consumers';
import { after, before, test } from 'node:test';
import { PNG } from 'pngjs';
import { payloadsOf } from '../../../lib/web/document.mjs';
import { BIN_CHUNK, readGlb, unpackGlb, writeGlb } from '../../../lib/web/unpack.mjs';
import { POLICY, serve } from '../../../samples/viewer/serve.mjs';
import { gather } from '../../../samples/viewer/setup.mjs';
import { brotli, encodeFile } from '../support/bench/encode.mjs';
import { blocksGlb, payloadsIn } from '../support/blocks.mjs';
import { ENGINES, LIBRARY, SAMPLES } from '../support/paths.mjs';
import { binOf, withPreview } from '../support/previews.mjs';
import { convert, decode, PROGRAM, readSample } from '../support/program.mjs';
import { launchBrowser, openPage } from './support/browser.mjs';
import { coverageOf, differenceOf } from './support/pixels.mjs';

const DESKTOP = { width: 1000, height: 640 };
const PHONE = { width: 360, height: 740 };
/** Quantization moves edges by parts of a pixel. */
const MAX_DIFFERENCE_FROM_SOURCE = 0.02;
const MIN_COVERAGE = 0.1;
/** What an overlay changes at least. */
const MIN_CHANGE = 0.05;
const MIN_MOTION = 0.02;
/** Lines on a dark surface that takes a tenth of the picture. */
const MIN_LINES = 0.02;

let browser, server;

before(async () => {
  await gather();
  [server, browser] = await Promise.all([serve(0), launchBrowser()]);
});

after(async () => {
  await browser?.close();
  await server?.close();
});

/** @param {object} options isTimedInFull: decoders are timed for as long as users see it; else for a moment, as their figures are not tested */
async function openViewer({ viewport = DESKTOP, isTimedInFull = false } = {}) {
  const isReady = () => document.querySelector('#chips button') !== null;
  const { page, messages, violations } = await openPage(browser, server.address, isReady);
  if (!isTimedInFull) await page.context().route('**/workers/timing.mjs', timeShortly);
  await page.setViewportSize(viewport);
  const problems = () => messages.filter((text) => /^error|^warning/.test(text));
  return { page, violations, problems };
}

/** Answers from the file: a request of our own to the server may meet a connection that the server is just closing. */
async function timeShortly(route) {
  const whole = await readFile(path.join(SAMPLES, 'viewer/workers/timing.mjs'), 'utf8');
  const body = whole.replace('ENOUGH_MILLISECONDS = 500', 'ENOUGH_MILLISECONDS = 10');
  assert.notEqual(body, whole, 'timing.mjs is not what is replaced here');
  await route.fulfill({ body, headers: { 'Content-Security-Policy': POLICY, 'Content-Type': 'text/javascript' } });
}

/** As a user's file manager drops it; until the page has taken it or says why not. */
const drop = (page, name, bytes, claimedSize) => dropAll(page, [[name, bytes]], name, claimedSize);

/** Drops several files together; the page names one of them. @param {[string, Uint8Array][]} files */
async function dropAll(page, files, name, claimedSize) {
  await page.evaluate(dropInPage, [files.map(([file, bytes]) => [file, Buffer.from(bytes).toString('base64')]), claimedSize]);
  const begins = ([id, name]) => document.getElementById(id).textContent.startsWith(name);
  await Promise.any(['file-name', 'error'].map((id) => page.waitForFunction(begins, [id, name])));
}

function dropInPage([contents, size]) {
  const files = contents.map(([name, base64]) => new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
  const dataTransfer = new DataTransfer();
  for (const file of files) dataTransfer.items.add(file);
  if (size !== undefined) Object.defineProperty(dataTransfer, 'files', { value: [Object.defineProperty(files[0], 'size', { value: size })] });
  document.querySelector('main').dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }));
}

/** Until all figures are there. */
async function settle(page) {
  await page.waitForFunction(() => {
    const isHidden = (id) => document.getElementById(id).hidden;
    return !isHidden('error') || (!isHidden('work') && isHidden('progress') && !document.getElementById('report').disabled);
  });
  assert.equal(await textOf(page, 'error'), '');
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

const textOf = (page, id) => page.textContent(`#${id}`);
const isShown = (page, id) => page.locator(`#${id}`).isVisible();

async function picturesOf(page) {
  const picture = async (id) => PNG.sync.read(await page.locator(`#${id}`).screenshot());
  return { original: await picture('original'), compressed: await picture('compressed') };
}

const numberOf = (text) => Number(text.replaceAll(',', ''));

/** What the page says of each codec: rows of text by their name. */
async function codecsOf(page) {
  const rows = await page.$$eval('#codecs tbody tr', (list) => list.map((row) => [row.cells[0].textContent,
    [...row.cells].slice(1).map((cell) => cell.querySelector('.number').textContent)]));
  return Object.fromEntries(rows);
}

const payloadBytesIn = (glb) => payloadsIn(glb).map(({ bytes }) => bytes);

async function click(page, id) {
  await page.click(`#${id}`);
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

test('a dropped GLB is compressed, shown beside its source and compared with other codecs', async () => {
  const { page, violations, problems } = await openViewer();
  const source = readSample('textured');
  await drop(page, 'dropped.glb', source);
  await settle(page);
  const { original, compressed } = await picturesOf(page);
  assert.ok(coverageOf(original) >= MIN_COVERAGE, `only ${coverageOf(original)} of the pixels are not background`);
  assert.ok(coverageOf(compressed) >= MIN_COVERAGE);
  assert.ok(differenceOf(original, compressed) <= MAX_DIFFERENCE_FROM_SOURCE, `${differenceOf(original, compressed)} differ`);

  const expected = convert(source);
  assert.equal(await textOf(page, 'file-name'), 'dropped.glb');
  assert.match(await textOf(page, 'compressed-size'), new RegExp(`^${expected.length.toLocaleString('en-US')} bytes`));
  const rows = await page.$$eval('#streams tbody tr', (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const names = rows.map(([name]) => name);
  for (const name of ['connectivity', 'seams', 'POSITION', 'NORMAL', 'TANGENT', 'TEXCOORD_0', 'header']) assert.ok(names.includes(name), name);
  const totals = await page.$$eval('#streams tfoot .number', (list) => list.map(({ textContent }) => textContent));
  const [ours, draco, meshopt] = totals.map(numberOf);
  assert.equal(ours, payloadBytesIn(expected).reduce((sum, { length }) => sum + length, 0));
  assert.ok(draco > ours && meshopt > ours, totals.join(' '));
  const sumOf = (column) => rows.reduce((sum, row) => sum + (numberOf(row[column]) || 0), 0);
  assert.ok(Math.abs(sumOf(1) - ours) <= rows.length, 'the streams are not all bytes');
  assert.deepEqual([sumOf(2), sumOf(3)], [draco, meshopt]);

  // Linked cameras: dragging one turns both.
  const box = await page.locator('#compressed').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2, { steps: 3 });
  await page.mouse.up();
  const turned = await picturesOf(page);
  assert.ok(differenceOf(turned.original, original) > MIN_CHANGE);
  assert.ok(differenceOf(turned.original, turned.compressed) <= MAX_DIFFERENCE_FROM_SOURCE);
  await click(page, 'reset');
  assert.equal(differenceOf((await picturesOf(page)).original, original), 0);
  assert.deepEqual(violations(), []);
  assert.deepEqual(problems(), []);
  await page.close();
});

test('wireframe, error heat map and collapse order are drawn', async () => {
  const { page } = await openViewer();
  await page.click('#chips button:has-text("sheet")');
  await settle(page);
  const plain = await picturesOf(page);

  await click(page, 'wireframe');
  const wire = await picturesOf(page);
  assert.ok(differenceOf(wire.original, plain.original) > MIN_CHANGE);
  assert.ok(differenceOf(wire.compressed, plain.compressed) > MIN_CHANGE);
  await click(page, 'wireframe');

  await click(page, 'heat');
  const heat = await picturesOf(page);
  assert.equal(differenceOf(heat.original, plain.original), 0);
  assert.ok(differenceOf(heat.compressed, plain.compressed) > MIN_CHANGE);
  assert.match(await textOf(page, 'legend-title'), /Distance/);
  await checkLargestError(page, readSample('sheet_with_holes'));

  await click(page, 'tree');
  assert.equal(await page.getAttribute('#heat', 'aria-pressed'), 'false');
  const tree = await picturesOf(page);
  assert.equal(differenceOf(tree.original, plain.original), 0);
  assert.ok(differenceOf(tree.compressed, heat.compressed) > MIN_CHANGE);
  assert.ok(saturatedPixels(tree.compressed) > MIN_LINES, 'no coloured lines');
  // A tree has an edge less than vertices; divides add a few, holes take a few.
  const edges = Number((await textOf(page, 'legend-high')).match(/last of ([\d,]+)/)[1].replaceAll(',', ''));
  assert.ok(edges > 644 * 0.8 && edges < 644 * 1.2, `${edges} edges`);

  // The order of a payload is not drawn on another one's vertices.
  await page.check('[name=keepVertexOrder]');
  await settle(page);
  const kept = await picturesOf(page);
  assert.ok(saturatedPixels(kept.compressed) > MIN_LINES);
  assert.ok(differenceOf(kept.compressed, tree.compressed) <= MAX_DIFFERENCE_FROM_SOURCE);

  await click(page, 'tree');
  assert.equal(differenceOf((await picturesOf(page)).compressed, plain.compressed), 0);
  assert.equal(await isShown(page, 'legend'), false);
  await page.close();
});

test('animations play in both pictures at the same time, and models return to rest', async () => {
  const { page, problems } = await openViewer();
  await page.click('#chips button:has-text("textured")');
  await settle(page);
  assert.equal(await isShown(page, 'play'), false);
  await drop(page, 'koi.glb', readSample('koi'));
  await settle(page);
  const rest = await picturesOf(page);
  await click(page, 'tree');
  await click(page, 'play');
  assert.equal(await page.getAttribute('#tree', 'aria-pressed'), 'false');
  await page.waitForTimeout(400);
  const [original, compressed] = await picturesOfOneFrame(page);
  assert.ok(differenceOf(original, rest.original) > MIN_MOTION, `only ${differenceOf(original, rest.original)} differ`);
  assert.ok(differenceOf(original, compressed) <= MAX_DIFFERENCE_FROM_SOURCE, `${differenceOf(original, compressed)} differ`);
  await click(page, 'play');
  assert.equal(differenceOf((await picturesOf(page)).original, rest.original), 0);
  assert.equal(differenceOf((await picturesOf(page)).compressed, rest.compressed), 0);
  assert.deepEqual(problems(), []);
  await page.close();
});

/** Both pictures, cut out of one of the page. */
async function picturesOfOneFrame(page) {
  const boxes = await Promise.all(['original', 'compressed'].map((id) => page.locator(`#${id}`).boundingBox()));
  const whole = PNG.sync.read(await page.screenshot({ fullPage: true }));
  return boxes.map(({ x, y, width, height }) => {
    const picture = new PNG({ width: Math.floor(width), height: Math.floor(height) });
    PNG.bitblt(whole, picture, Math.round(x), Math.round(y), picture.width, picture.height, 0, 0);
    return picture;
  });
}

/** The largest distance that the page tells, against all pairs of vertices. */
async function checkLargestError(page, source) {
  const positions = (glb) => {
    const { json, chunks: [{ data }] } = readGlb(glb);
    const { bufferView, byteOffset = 0, count } = json.accessors[json.meshes[0].primitives[0].attributes.POSITION];
    const begin = (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
    return new Float32Array(data.slice(begin, begin + 12 * count).buffer);
  };
  const [before, afterwards] = [positions(source), positions(decode(convert(source)))];
  let most = 0;
  for (let i = 0; i < before.length; i += 3) {
    let least = Infinity;
    for (let j = 0; j < afterwards.length; j += 3) {
      least = Math.min(least, Math.hypot(before[i] - afterwards[j], before[i + 1] - afterwards[j + 1], before[i + 2] - afterwards[j + 2]));
    }
    most = Math.max(most, least);
  }
  const told = Number((await textOf(page, 'legend-high')).match(/^([\d.e-]+) units/)[1]);
  assert.ok(Math.abs(told - most) <= 0.005 * most, `${told} told, ${most} measured`);
}

function saturatedPixels({ width, height, data }) {
  let count = 0;
  for (let i = 0; i < 4 * width * height; i += 4) {
    if (Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 100) ++count;
  }
  return count / (width * height);
}

test('a picture for a README', { skip: process.env.MCC_SCREENSHOTS === undefined && 'MCC_SCREENSHOTS is not set' }, async () => {
  const { page } = await openViewer({ viewport: { width: 1200, height: 600 }, isTimedInFull: true });
  await drop(page, 'koi.glb', readSample('koi'));
  await settle(page);
  await page.locator('#original').screenshot({ path: path.join(process.env.MCC_SCREENSHOTS, 'koi.png') });
  await page.close();
});

test('the download is what the program writes with the same options', async () => {
  const { page } = await openViewer();
  const source = readSample('two_materials');
  await drop(page, 'vase.glb', source);
  await settle(page);
  assert.deepEqual(await downloaded(page), { name: 'vase.mcc.glb', bytes: Buffer.from(convert(source)) });

  await page.check('[name=keepVertexOrder]');
  await page.check('[name=keepTriangleOrder]');
  await page.check('[name=lossless]');
  await settle(page);
  const { bytes } = await downloaded(page);
  assert.deepEqual(bytes, Buffer.from(convert(source, ['--lossless', '--keep-vertex-order', '--keep-triangle-order'])));
  assert.match(await textOf(page, 'summary'), /Largest error0every position is exact/);

  // What was compressed already is opened, too, and its figures are against what it decodes to.
  await drop(page, 'again.glb', bytes);
  await settle(page);
  const decoded = await unpackGlb(new Uint8Array(bytes));
  const [given, plain] = [bytes, decoded].map(({ length }) => length.toLocaleString('en-US'));
  assert.match(await textOf(page, 'notice'), new RegExp(`compressed with mesh collapse already: it has ${given} bytes and decodes to ${plain}`));
  assert.equal(await textOf(page, 'original-size'), `${plain} bytes decoded`);
  assert.match(await textOf(page, 'summary'), new RegExp(`^File${plain} → [\\d,]+bytes, \\d+ % of what the file decodes to`));
  assert.equal((await reported(page)).json.file.decodedBytes, decoded.length);
  assert.ok(coverageOf((await picturesOf(page)).original) >= MIN_COVERAGE);
  decode((await downloaded(page)).bytes);
  await page.close();
});

/** Times are as they are; bytes are what the program and the encoders of tools/bench-web give. */
test('bytes and times of three codecs are shown', async () => {
  const { page, violations, problems } = await openViewer({ isTimedInFull: true });
  const brotliBytes = async (parts) => (await brotli(Buffer.concat(parts))).length;
  for (const name of ['morphed', 'two_materials']) {
    await drop(page, `${name}.glb`, readSample(name));
    await settle(page);
    const rows = await codecsOf(page);
    const { glb, codecs } = await encodeFile(PROGRAM, path.join(SAMPLES, `${name}.glb`));
    const [draco, meshopt] = ['draco 0', 'meshopt'].map((codec) => codecs[codec].map(({ bytes }) => bytes));
    const ours = payloadBytesIn(name === 'morphed' ? convert(withoutTargets(readSample(name))) : glb);
    assert.equal(numberOf(rows.Bytes[0]), Buffer.concat(ours).length, name);
    isNear(numberOf(rows['Bytes after brotli'][0]), await brotliBytes(ours), 0.02, `${name} after brotli`);
    // The benchmark has no morph targets either. Draco's lattice has its own origin here, and gets the vertices in the file's order.
    [draco, meshopt].forEach((payloads, i) => {
      isNear(numberOf(rows.Bytes[i + 1]), Buffer.concat(payloads).length, 0.08, `${name} by codec ${i + 1}`);
      assert.ok(numberOf(rows['Bytes after brotli'][i + 1]) < numberOf(rows.Bytes[i + 1]), `${name}: brotli of codec ${i + 1}`);
    });
    for (const figure of ['Load + first decode', 'Best decode']) {
      for (const time of rows[figure]) assert.match(time, /^[\d.]+ m?s$/, `${name} ${figure}`);
    }
    await (name === 'morphed' ? checkMorphTargets(page, rows, payloadBytesIn(glb)) : checkNoMorphTargets(page, rows));
  }
  assert.match(await textOf(page, 'remarks'), /Draco 1\.5\.\d.*meshopt 1\.\d/);
  assert.deepEqual(violations(), []);
  assert.deepEqual(problems(), []);
  await page.close();
});

/** Two targets with positions and normals, as floats, of 642 vertices. */
const BYTES_OF_TARGETS = 2 * 2 * 12 * 642;

async function checkMorphTargets(page, rows, ours) {
  const { json } = await reported(page);
  const all = rows['Bytes with morph targets'];
  const streams = await streamsOf(page);
  const sums = [0, 1, 2].map((i) => streams.reduce((sum, { bytes }) => sum + bytes[i], 0));
  const totals = await page.$$eval('#streams tfoot .number', (list) => list.map(({ textContent }) => textContent));
  assert.equal(numberOf(all[0]), Buffer.concat(ours).length);
  assert.equal(all[1], '–');
  assert.deepEqual([numberOf(all[2]), totals[0], totals[1], totals[2]], [sums[2], all[0], rows.Bytes[1], all[2]]);
  assert.ok(numberOf(all[2]) > numberOf(rows.Bytes[2]));
  assert.match(await textOf(page, 'codecs'), /^Without morph targets/);
  assert.match(await textOf(page, 'streams'), /without morph targets/);
  const left = BYTES_OF_TARGETS.toLocaleString('en-US');
  assert.match(await textOf(page, 'remarks'), new RegExp(`Draco has no coding for morph targets: it leaves ${left} bytes of them as they are\\.`));
  const figuresOf = ({ bytes, withMorphTargetsBytes, uncodedMorphTargetBytes }) => [bytes, withMorphTargetsBytes, uncodedMorphTargetBytes];
  assert.equal(json.comparedWithoutMorphTargets, true);
  assert.deepEqual(Object.values(json.codecs).map(figuresOf), [0, 1, 2].map((i) => (
    [numberOf(rows.Bytes[i]), i === 1 ? undefined : numberOf(all[i]), i === 1 ? BYTES_OF_TARGETS : undefined])));
}

async function checkNoMorphTargets(page, rows) {
  assert.equal(rows['Bytes with morph targets'], undefined);
  assert.match(await textOf(page, 'codecs'), /^Payloads/);
  assert.doesNotMatch(await textOf(page, 'remarks'), /morph/);
  assert.equal((await reported(page)).json.comparedWithoutMorphTargets, false);
}

function withoutTargets(glb) {
  const { json, chunks } = readGlb(glb);
  for (const mesh of json.meshes) {
    delete mesh.weights;
    for (const primitive of mesh.primitives) delete primitive.targets;
  }
  delete json.animations;
  return writeGlb(json, chunks);
}

const isNear = (value, expected, tolerance, what) =>
  assert.ok(Math.abs(value / expected - 1) <= tolerance, `${what}: ${value} instead of ${expected}`);

/** The bytes of each stream by each codec; 0 where there are none. */
async function streamsOf(page) {
  const rows = await page.$$eval('#streams tbody tr', (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  return rows.map(([stream, ...bytes]) => ({ stream, bytes: bytes.map((text) => numberOf(text) || 0) }));
}

for (const [codec, file, kept] of [
  ['meshopt', 'meshopt/meshopt_encoder.mjs', ['Mesh collapse', 'Draco']],
  ['Draco', 'draco/draco_encoder.wasm', ['Mesh collapse', 'meshopt']],
  ['Draco', 'draco/draco_decoder.mjs', ['Mesh collapse', 'meshopt']],
  ['brotli', 'brotli/brotli_wasm.mjs', []],
]) {
  test(`without ${file} the other figures are there`, async () => {
    const { page } = await openViewer();
    await page.context().route(`**/vendor/${file}`, (route) => route.fulfill({ status: 404, body: 'not found' }));
    await drop(page, 'moebius.glb', readSample('moebius'));
    await settle(page);
    const rows = await codecsOf(page);
    const names = ['Mesh collapse', 'Draco', 'meshopt'];
    for (const name of kept) for (const [figure, cells] of Object.entries(rows)) assert.match(cells[names.indexOf(name)], /\d/, `${name} ${figure}`);
    if (codec === 'brotli') {
      assert.deepEqual(rows['Bytes after brotli'], ['–', '–', '–']);
      for (const time of rows['Best decode']) assert.match(time, /\d/);
    } else {
      assert.equal(rows['Best decode'][names.indexOf(codec)], '–');
    }
    assert.match(await textOf(page, 'remarks'), codec === 'brotli' ? /meshopt: a figure is missing/
      : new RegExp(`No comparison with ${codec}|${codec}: a figure is missing`));
    const { json } = await reported(page);
    assert.equal(json.codecs.draco.errors.length + json.codecs.meshopt.errors.length > 0, true);
    await page.close();
  });
}

test('the report has the numbers of the page, and a picture', async () => {
  const { page, violations, problems } = await openViewer();
  assert.equal(await page.getByRole('button', { name: /^Report/ }).count(), 0, 'there is nothing to report yet');
  await drop(page, 'vase.glb', readSample('two_materials'));
  await settle(page);
  const { json, names, picture } = await reported(page);
  assert.deepEqual(names, ['vase.report.json', 'vase.report.png']);
  const rows = await codecsOf(page);
  const codecs = Object.values(json.codecs);
  assert.deepEqual(codecs.map(({ name }) => name), ['Mesh collapse', 'Draco', 'meshopt']);
  assert.deepEqual(codecs.map(({ bytes }) => bytes), rows.Bytes.map(numberOf));
  assert.deepEqual(codecs.map(({ brotliBytes }) => brotliBytes), rows['Bytes after brotli'].map(numberOf));
  for (const [figure, key] of [['Load + first decode', 'loadAndFirstDecodeMilliseconds'], ['Best decode', 'bestDecodeMilliseconds']]) {
    codecs.forEach((codec, i) => {
      const [value, unit] = rows[figure][i].split(' ');
      isNear(codec[key], Number(value) * (unit === 's' ? 1000 : 1), 0.1, `${codec.name} ${figure}`);
    });
  }
  for (const { stream, bytes } of await streamsOf(page)) {
    assert.deepEqual(codecs.map(({ streamBytes }) => Math.round(streamBytes[stream] ?? 0)), bytes, stream);
  }
  assert.deepEqual(codecs.map(({ errors }) => errors), [[], [], []]);
  const version = async (file) => JSON.parse(await readFile(file, 'utf8')).version;
  const packages = ['draco3d', 'meshoptimizer', 'brotli-wasm'].map((name) => path.join(ENGINES, name));
  const versions = await Promise.all([LIBRARY, ...packages].map((folder) => version(path.join(folder, 'package.json'))));
  assert.deepEqual([...codecs, json.brotli].map((codec) => codec.version), versions);
  const source = readSample('two_materials');
  assert.deepEqual(json.file, { name: 'vase.glb', bytes: source.length, resultBytes: convert(source).length });
  assert.equal(json.triangles, 3680);
  assert.equal(json.options.positionBits, 14);
  assert.equal(json.userAgent, await page.evaluate(() => navigator.userAgent));
  assert.ok(Math.abs(new Date(json.date) - Date.now()) < 600_000);
  assert.equal(json.remarks.join(' '), await textOf(page, 'remarks'));

  const { width, height } = picture;
  assert.deepEqual([width, height], [1200, 960]);
  const left = partOf(picture, 24, 92, 564, 440), right = partOf(picture, 612, 92, 564, 440), text = partOf(picture, 24, 540, 1152, 400);
  for (const part of [left, right]) assert.ok(coverageOf(part) >= MIN_COVERAGE, `${coverageOf(part)} of a view`);
  assert.ok(differenceOf(left, right) <= MAX_DIFFERENCE_FROM_SOURCE);
  assert.ok(coverageOf(text) > 0.02, `${coverageOf(text)} of the figures`);

  // The page's own pictures are as before, and a dark page has a dark report.
  const before = await picturesOf(page);
  assert.ok(coverageOf(before.original) >= MIN_COVERAGE);
  await page.emulateMedia({ colorScheme: 'dark' });
  const dark = await reported(page);
  assert.ok(dark.picture.data[0] < 64 && picture.data[0] > 192);
  await page.emulateMedia({ colorScheme: 'light' });
  assert.equal(differenceOf((await picturesOf(page)).compressed, before.compressed), 0);
  assert.deepEqual(violations(), []);
  assert.deepEqual(problems(), []);
  await page.close();
});

test('the report goes to other programs where files can be shared, else it is downloaded', async () => {
  const { page } = await openViewer();
  await drop(page, 'moebius.glb', readSample('moebius'));
  await settle(page);
  await page.evaluate(() => {
    navigator.canShare = ({ files }) => files.length === 2;
    navigator.share = async ({ files }) => { globalThis.shared = files.map(({ name, type }) => `${name} ${type}`); };
  });
  await page.focus('#report');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => globalThis.shared !== undefined);
  assert.deepEqual(await page.evaluate(() => globalThis.shared), ['moebius.report.json application/json', 'moebius.report.png image/png']);
  await page.evaluate(() => {
    navigator.share = async () => { throw new DOMException('these types cannot be shared', 'NotAllowedError'); };
  });
  assert.equal((await reported(page)).names.length, 2);
  await page.close();
});

async function reported(page) {
  const downloads = [];
  const isThere = new Promise((resolve) => {
    page.on('download', function listen(download) {
      if (downloads.push(download) < 2) return;
      page.off('download', listen);
      resolve();
    });
  });
  await page.click('#report');
  await isThere;
  const [json, picture] = await Promise.all(downloads.map(contentOf));
  return { names: downloads.map((download) => download.suggestedFilename()), json: JSON.parse(json), picture: PNG.sync.read(picture) };
}

function partOf(picture, x, y, width, height) {
  const part = new PNG({ width, height });
  PNG.bitblt(picture, part, x, y, width, height, 0, 0);
  return part;
}

/** The browser is another process's, so that there is no file that this one could read. */
async function contentOf(download) {
  return buffer(await download.createReadStream());
}

async function downloaded(page) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#download')]);
  return { name: download.suggestedFilename(), bytes: await contentOf(download) };
}

/** A document, and the buffer that it has, as a GLB. */
function glbOf(json, ...buffers) {
  return Buffer.from(writeGlb({ asset: { version: '2.0' }, ...json }, buffers.map((data) => ({ type: BIN_CHUNK, data }))));
}

const triangles = (count) => ({
  meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
  accessors: [{ componentType: 5126, type: 'VEC3', count: 3 }, { componentType: 5125, type: 'SCALAR', count: 3 * count }],
});

/** The last byte of its payload is another one. */
function damagedFile() {
  const bytes = convert(readSample('torus'));
  const { json, chunks: [{ data }] } = readGlb(bytes);
  const { byteOffset = 0, byteLength } = json.bufferViews[payloadsOf(json)[0].bufferView];
  data[byteOffset + byteLength - 1] ^= 1;
  return bytes;
}

const textGltf = (buffer, bufferViews) => Buffer.from(JSON.stringify(
  { asset: { version: '2.0' }, ...triangles(1), buffers: [{ byteLength: 9, ...buffer }], bufferViews }));

const BAD_FILES = [
  ['note.txt', () => Buffer.from('no model'), /not a GLB/],
  ['empty.glb', () => Buffer.alloc(0), /is empty/],
  ['model.gltf', () => textGltf({ uri: 'some%20parts.bin' }), /refers to “some%20parts\.bin”\. Drop .*together.*gltf-mcc decode model\.gltf whole\.glb/],
  ['short.gltf', () => textGltf({ uri: 'data:application/octet-stream;base64,AAAA' }), /a buffer has 3 bytes instead of 9/],
  ['uri.gltf', () => textGltf({ uri: 'data:application/octet-stream,abc' }), /is not base64/],
  ['view.gltf', () => textGltf({ uri: `data:;base64,${'A'.repeat(12)}` }, [{ buffer: 1, byteLength: 9 }]), /buffer that is not there/],
  ['half.glb', () => readSample('torus').subarray(0, 40_000), /cut off: .* 74,844 bytes, but 40,000/],
  ['json.glb', () => Buffer.from(readSample('torus')).fill('?', 20, 30), /JSON cannot be read/],
  ['points.glb', () => glbOf({}), /no triangles/],
  ['parts.glb', () => glbOf({ ...triangles(1), buffers: [{ byteLength: 9, uri: 'parts.bin' }] }), /refers to “parts\.bin”.*gltf-mcc decode model\.glb whole\.glb/],
  ['draco.glb', () => glbOf({ ...triangles(1), extensionsUsed: ['KHR_draco_mesh_compression'] }), /compressed with Draco.*gltf-mcc convert/],
  ['ktx.glb', () => glbOf({ ...triangles(1), extensionsRequired: ['KHR_texture_basisu'] }), /textures .* are KTX2/],
  ['odd.glb', () => glbOf({ meshes: 7 }), /is damaged \(/],
  ['many.glb', () => glbOf(triangles(5_000_000)), /has 5,000,000 triangles; this page takes 4,000,000/],
  ['wrong.glb', () => glbOf(triangles(1)), /wrong\.glb: ./],
  ['damaged.glb', damagedFile, /damaged\.glb: .*checksum/i],
];

test('what cannot be shown gets a message near the drop zone, and the next file works', async () => {
  const { page } = await openViewer();
  assert.equal(await page.getAttribute('#error', 'role'), 'alert');
  for (const [name, make, expected] of BAD_FILES) {
    await drop(page, name, make());
    await page.waitForSelector('#error:not([hidden])');
    assert.match(await textOf(page, 'error'), expected, name);
    assert.equal(await isShown(page, 'progress'), false, name);
  }
  await drop(page, 'large.glb', Buffer.from('glTF'), 300 * 2 ** 20);
  assert.match(await textOf(page, 'error'), /has 300 MiB; this page takes 256 MiB/);

  await drop(page, 'good.glb', readSample('moebius'));
  await settle(page);
  assert.equal(await isShown(page, 'error'), false);
  assert.ok(coverageOf((await picturesOf(page)).compressed) >= MIN_COVERAGE);
  // It stays when the next one is bad.
  await drop(page, 'note.txt', Buffer.from('no model'));
  assert.equal(await textOf(page, 'file-name'), 'good.glb');
  assert.ok(coverageOf((await picturesOf(page)).compressed) >= MIN_COVERAGE);
  await page.close();
});

test('after a damaged file no figure or picture of the one before remains', async () => {
  const { page } = await openViewer();
  await drop(page, 'good.glb', readSample('morphed'));
  await settle(page);
  assert.equal(await isShown(page, 'figures'), true);
  await drop(page, 'damaged.glb', damagedFile());
  await page.waitForSelector('#error:not([hidden])');
  assert.equal(await textOf(page, 'file-name'), 'damaged.glb');
  for (const id of ['original-size', 'compressed-size', 'summary', 'codecs', 'streams', 'remarks']) assert.equal(await textOf(page, id), '', id);
  for (const id of ['figures', 'legend', 'play']) assert.equal(await isShown(page, id), false, id);
  for (const picture of Object.values(await picturesOf(page))) assert.ok(coverageOf(picture) < 0.01, 'only its rounded corners');
  for (const id of ['download', 'report', 'heat', 'tree']) assert.equal(await page.isDisabled(`#${id}`), true, id);
  await drop(page, 'good.glb', readSample('moebius'));
  await settle(page);
  assert.equal(await isShown(page, 'figures'), true);
  await page.close();
});

/** A sample as a .gltf, with its buffer in a file and its pictures in others. */
function partsOf(name) {
  const { json, chunks: [{ data }] } = readGlb(readSample(name));
  const pictures = json.images.map(({ bufferView }, i) => {
    const { byteOffset = 0, byteLength } = json.bufferViews[bufferView];
    json.images[i] = { uri: `textures/picture%20${i}.png` };
    return [`picture ${i}.png`, data.slice(byteOffset, byteOffset + byteLength)];
  });
  json.buffers = [{ byteLength: json.buffers[0].byteLength, uri: 'model.bin' }];
  return [['model.bin', data], ...pictures, ['model.gltf', Buffer.from(`\ufeff${JSON.stringify(json)}`)]];
}

test('a .gltf is opened with its buffers and images, dropped or chosen together', async () => {
  const { page, violations, problems } = await openViewer();
  await drop(page, 'textured.glb', readSample('textured'));
  await settle(page);
  const expected = { pictures: await picturesOf(page), rows: (await codecsOf(page)).Bytes };
  const parts = partsOf('textured');
  await page.setInputFiles('#file', parts.map(([name, bytes]) => ({ name, mimeType: '', buffer: Buffer.from(bytes) })));
  await page.waitForFunction(() => document.getElementById('file-name').textContent === 'model.gltf');
  await settle(page);
  assert.equal(await isShown(page, 'notice'), false);
  assert.deepEqual((await codecsOf(page)).Bytes, expected.rows);
  const shown = await picturesOf(page);
  for (const side of ['original', 'compressed']) assert.equal(differenceOf(shown[side], expected.pictures[side]), 0, side);
  assert.equal((await downloaded(page)).name, 'model.mcc.glb');

  await dropAll(page, [...parts, ['note.txt', Buffer.from('not used')]], 'model.gltf');
  await page.waitForSelector('#notice:not([hidden])');
  await settle(page);
  assert.equal(await textOf(page, 'notice'), 'Only model.gltf is opened; note.txt is ignored.');
  assert.deepEqual((await codecsOf(page)).Bytes, expected.rows);
  assert.deepEqual(violations(), []);
  assert.deepEqual(problems(), []);
  await page.close();
});

test('the second of two models is said to be ignored', async () => {
  const { page } = await openViewer();
  await dropAll(page, ['moebius', 'torus'].map((name) => [`${name}.glb`, readSample(name)]), 'moebius.glb');
  await settle(page);
  assert.equal(await textOf(page, 'file-name'), 'moebius.glb');
  assert.equal(await textOf(page, 'notice'), 'Only moebius.glb is opened; torus.glb is ignored.');
  await page.close();
});

test('the keys of the toolbar are seen', async () => {
  const { page } = await openViewer();
  await page.click('#chips button:has-text("koi")');
  await settle(page);
  for (const [id, key] of Object.entries({ wireframe: 'W', heat: 'E', tree: 'C', play: 'P' })) {
    assert.equal(await page.locator(`#${id} kbd`).innerText(), key);
    assert.equal(await page.getAttribute(`#${id}`, 'aria-keyshortcuts'), key);
    await page.keyboard.press(key);
    assert.equal(await page.getAttribute(`#${id}`, 'aria-pressed'), 'true', id);
  }
  await page.close();
});

test('a phone shows everything without scrolling sideways', async () => {
  const { page } = await openViewer({ viewport: PHONE });
  const width = () => page.evaluate(() => document.documentElement.scrollWidth);
  assert.equal(await width(), PHONE.width);
  await page.click('#chips button:has-text("textured")');
  await settle(page);
  assert.equal(await width(), PHONE.width);
  const boxOf = (id) => page.locator(`#${id}`).boundingBox();
  const [original, compressed, heat] = [await boxOf('original'), await boxOf('compressed'), await boxOf('heat')];
  assert.ok(compressed.y >= original.y + original.height, 'the pictures are not one below the other');
  assert.ok(compressed.y + compressed.height <= PHONE.height, 'the second picture is below the fold');
  assert.ok(heat.y + heat.height <= PHONE.height && heat.height >= 44, 'the toolbar is out of reach');
  const { original: picture } = await picturesOf(page);
  assert.ok(coverageOf(picture) >= MIN_COVERAGE);

  const ground = () => page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
  const light = await ground();
  await page.emulateMedia({ colorScheme: 'dark', reducedMotion: 'reduce' });
  assert.notEqual(await ground(), light);
  assert.equal(await page.evaluate(() => getComputedStyle(document.getElementById('heat')).transitionDuration), '0s');
  await page.close();
});

test('a compressed model appears block by block', async () => {
  const { page, violations, problems } = await openViewer();
  await page.evaluate(() => {
    globalThis.seen = [];
    const note = () => globalThis.seen.push(document.getElementById('original').dataset.blocks);
    new MutationObserver(note).observe(document.getElementById('original'), { attributeFilter: ['data-blocks'] });
  });
  await drop(page, 'blocks.glb', convert(readSample('torus'), ['--block-triangles', '500']));
  await settle(page);
  const seen = (await page.evaluate(() => globalThis.seen)).filter(Boolean);
  assert.ok(seen.length > 0 && seen.every((text) => / of 9$/.test(text)), seen.join());
  assert.equal(seen.at(-1), '9 of 9');
  const { original, compressed } = await picturesOf(page);
  assert.ok(coverageOf(original) >= MIN_COVERAGE);
  assert.ok(differenceOf(original, compressed) <= MAX_DIFFERENCE_FROM_SOURCE);
  const damaged = convert(readSample('torus'), ['--block-triangles', '500']);
  damaged[damaged.length - 10] ^= 1;
  await drop(page, 'damaged.glb', damaged);
  await page.waitForFunction(() => document.getElementById('error').textContent.includes('checksum'));
  assert.deepEqual(violations(), []);
  assert.deepEqual(problems(), []);
  await page.close();
});

test('a preview appears first, and damage to it does not matter', async () => {
  const { page, violations, problems } = await openViewer();
  await page.evaluate(() => {
    globalThis.seen = [];
    const { dataset } = document.getElementById('original');
    new MutationObserver(() => globalThis.seen.push({ ...dataset })).observe(document.getElementById('original'),
      { attributeFilter: ['data-blocks', 'data-previews'] });
  });
  const seen = () => page.evaluate(() => globalThis.seen);
  const glb = withPreview(blocksGlb('torus', 500), payloadBytesIn(convert(readSample('torus')))[0]);
  await drop(page, 'preview.glb', glb);
  await settle(page);
  const [first] = await seen();
  assert.equal(first.previews, '1');
  assert.equal((await seen()).at(-1).blocks, '9 of 9');
  const { original, compressed } = await picturesOf(page);
  assert.ok(coverageOf(original) >= MIN_COVERAGE);
  assert.ok(differenceOf(original, compressed) <= MAX_DIFFERENCE_FROM_SOURCE);
  glb[binOf(glb) + 9] ^= 0x55;
  await page.evaluate(() => { globalThis.seen = []; });
  await drop(page, 'damaged.glb', glb);
  await settle(page);
  assert.ok((await seen()).every(({ previews }) => previews === undefined));
  assert.ok(coverageOf((await picturesOf(page)).original) >= MIN_COVERAGE);
  assert.deepEqual(violations(), []);
  assert.deepEqual(problems(), []);
  await page.close();
});

/** A wavy sheet of so many triangles that the encoder cuts it into blocks. */
function largeSheet(side) {
  const positions = Float32Array.from({ length: 3 * side * side }, (_, i) => {
    const [x, y] = [Math.floor(i / 3) % side, Math.floor(i / 3 / side)];
    return [x / side, y / side, 0.1 * Math.sin(x / 40) * Math.cos(y / 60)][i % 3];
  });
  const indices = new Uint32Array(6 * (side - 1) ** 2);
  for (let at = 0, y = 0; y + 1 < side; ++y) {
    for (let x = 0; x + 1 < side; ++x, at += 6) {
      const corner = y * side + x;
      indices.set([corner, corner + 1, corner + side, corner + 1, corner + side + 1, corner + side], at);
    }
  }
  return glbOf({
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    accessors: [{ bufferView: 0, componentType: 5126, type: 'VEC3', count: side * side, min: [0, 0, -0.1], max: [1, 1, 0.1] },
      { bufferView: 1, componentType: 5125, type: 'SCALAR', count: indices.length }],
    bufferViews: [{ buffer: 0, byteLength: positions.byteLength },
      { buffer: 0, byteOffset: positions.byteLength, byteLength: indices.byteLength }],
    buffers: [{ byteLength: positions.byteLength + indices.byteLength }],
  }, Buffer.concat([Buffer.from(positions.buffer), Buffer.from(indices.buffer)]));
}

test('what the page has compressed to blocks appears block by block', async () => {
  const { page, violations, problems } = await openViewer();
  await page.evaluate(() => {
    globalThis.seen = [];
    const canvas = document.getElementById('compressed');
    new MutationObserver(() => globalThis.seen.push(canvas.dataset.blocks)).observe(canvas, { attributeFilter: ['data-blocks'] });
  });
  await drop(page, 'sheet.glb', largeSheet(520));
  await page.waitForFunction(() => document.getElementById('compressed-size').textContent !== '');
  await page.waitForFunction(() => document.getElementById('waiting').textContent === '');
  const seen = (await page.evaluate(() => globalThis.seen)).filter(Boolean);
  assert.ok(seen.length > 0 && seen.every((text) => / of [2-9]$/.test(text)), seen.join());
  await page.keyboard.press('Escape'); // the comparison would take long
  const { original, compressed } = await picturesOf(page);
  assert.ok(coverageOf(compressed) >= MIN_COVERAGE);
  assert.ok(differenceOf(original, compressed) <= MAX_DIFFERENCE_FROM_SOURCE);
  assert.deepEqual(violations(), []);
  assert.deepEqual(problems(), []);
  await page.close();
});

test('the keyboard reaches everything', async () => {
  const { page } = await openViewer();
  const focused = () => page.evaluate(() => document.activeElement.id || document.activeElement.textContent.trim());
  const press = async (...keys) => {
    for (const key of keys) await page.keyboard.press(key);
    return focused();
  };
  assert.equal(await press('Tab', 'Tab'), 'drop-open');
  assert.notEqual(await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle), 'none');
  assert.equal(await press('Tab', 'Tab'), 'textured');
  await press('Enter');
  await settle(page);
  assert.equal(await focused(), 'original', 'the focus is lost with the button');
  const before = await picturesOf(page);
  await press('ArrowUp', 'ArrowUp', '-');
  assert.equal(await press('Tab', 'Tab'), 'wireframe'); // the focus frames a picture
  const turned = await picturesOf(page);
  assert.ok(differenceOf(turned.compressed, before.compressed) > MIN_CHANGE);
  assert.ok(differenceOf(turned.original, turned.compressed) <= MAX_DIFFERENCE_FROM_SOURCE);
  await press('Space');
  assert.equal(await page.getAttribute('#wireframe', 'aria-pressed'), 'true');
  await press('e');
  assert.equal(await page.getAttribute('#heat', 'aria-pressed'), 'true');

  const size = await textOf(page, 'compressed-size');
  assert.equal(await press('Tab', 'Tab', 'Tab', 'Tab'), 'positionBits');
  await press('ArrowLeft');
  await settle(page);
  assert.equal(await page.inputValue('#positionBits'), '13');
  assert.notEqual(await textOf(page, 'compressed-size'), size);
  assert.match(await textOf(page, 'status'), /textured\.glb: 134,580 bytes became/);

  // Esc ends what is under way, and the next change begins anew.
  await press('ArrowLeft', 'Escape');
  assert.match(await textOf(page, 'notice'), /Cancelled/);
  assert.equal(await isShown(page, 'progress'), false);
  await press('ArrowLeft');
  await settle(page);
  assert.equal(await isShown(page, 'notice'), false);
  await page.close();
});
