// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Every engine shows compressed models as it shows the others, through the snippets of lib/web/README.md, under a
// Content-Security-Policy. MCC_SCREENSHOTS=FOLDER saves a picture of each engine.
import assert from 'node:assert/strict';
import { writeFile } from 'node:fs/promises';
import path from 'node:path';
import { test } from 'node:test';
import { openPage } from './support/browser.mjs';
import { coverageOf, differenceOf, readPicture, writePicture } from './support/pixels.mjs';
import { useSite } from './support/site.mjs';

const ALL = ['textured', 'skinned', 'tentacle', 'morphed', 'materials', 'shared', 'integers', 'ordinary', 'lossless', 'instances'];
const WITH_SKINS_AND_TARGETS = ['textured', 'skinned', 'morphed', 'materials', 'integers'];
const ENGINES = [
  { page: 'three', models: ALL, hasWorkers: true, without: /only 0.00 %/ },
  { page: 'babylon', models: ALL, hasWorkers: true, without: /Required extension .* is not available/ },
  { page: 'playcanvas', models: WITH_SKINS_AND_TARGETS, hasWorkers: false, without: /only 0.00 %/ },
  { page: 'model_viewer', models: ['textured', 'materials'], hasWorkers: false, without: /only 0.00 %/ },
  { page: 'cesium', query: 'eval', models: ['textured', 'materials'], hasWorkers: true, without: /Unsupported glTF Extension/ },
];
const SCREENSHOT = 'materials';

/** Decoding is exact, and so is drawing the same numbers twice, but for a pixel at an edge. */
const MAX_DIFFERENCE_FROM_PLAIN = 0.001;
/** Quantization moves edges by parts of a pixel. */
const MAX_DIFFERENCE_FROM_SOURCE = 0.02;
const MIN_COVERAGE = 0.1;

const site = useSite();

const open = ({ page, query = '' }, more = '') =>
  openPage(site.browser, `${site.server.origin}/pages/${page}.html?${query}&${more}`, () => globalThis.draw !== undefined);

const draw = async (page, model, snippet) => readPicture(await page.evaluate(([name, heading]) => globalThis.draw(name, heading ?? undefined), [model, snippet]));

/** What is wrong with the picture of a compressed model. */
function problemsOf(name, { picture, plain, source }) {
  const problems = [];
  const check = (isGood, what) => isGood || problems.push(`${name}: ${what}`);
  const percent = (x) => `${(100 * x).toFixed(2)} %`;
  const coverage = coverageOf(picture);
  const [fromPlain, fromSource] = [differenceOf(picture, plain), differenceOf(picture, source)];
  check(coverage >= MIN_COVERAGE, `only ${percent(coverage)} of the pixels are not background`);
  check(fromPlain <= MAX_DIFFERENCE_FROM_PLAIN, `${percent(fromPlain)} of the pixels differ from the decoded model`);
  check(fromSource <= MAX_DIFFERENCE_FROM_SOURCE, `${percent(fromSource)} of the pixels differ from the source`);
  return problems;
}

for (const engine of ENGINES) {
  test(`${engine.page} shows what it shows of the uncompressed models`, async () => {
    const { page, violations } = await open(engine);
    const references = new Map();
    for (const name of engine.models) {
      const plain = await draw(page, `${name}.plain`);
      const source = await draw(page, name);
      const picture = await draw(page, `${name}.mcc`);
      assert.deepEqual(problemsOf(name, { picture, plain, source }), []);
      references.set(name, { plain, source });
      if (name === SCREENSHOT) await saveScreenshot(engine.page, picture);
    }
    assert.deepEqual(violations(), [], 'the page keeps its Content-Security-Policy');
    assert.equal(page.workers().length > 0, engine.hasWorkers, 'workers that decode');
    await assert.rejects(draw(page, 'damaged'), /checksum/);
    await page.close();
    await failsWithoutLibrary(engine, engine.models[0], references.get(engine.models[0]));
  });
}

/** The check must fail where the library is missing: what is drawn then, or why nothing is. */
async function failsWithoutLibrary(engine, name, references) {
  const { page } = await open(engine, 'without');
  const problems = await draw(page, `${name}.mcc`).then((picture) => problemsOf(name, { picture, ...references }), String);
  assert.match(String(problems), engine.without);
  await page.close();
}

const INTEGERS = [
  {
    engine: ENGINES[0], snippet: 'Integers in three.js',
    types: { position: 'Uint16Array', normal: 'Int16Array', uv: 'Uint16Array', tangent: 'Int16Array' }, skinned: 'Uint16Array', float: 'Float32Array',
  },
  {
    engine: ENGINES[1], snippet: 'Integers in Babylon.js',
    types: { position: 5123, normal: 5122, uv: 5123, tangent: 5122 }, skinned: 5126, float: 5126,
  },
];

/** Of which a lattice would move something else. */
const FIXED = ['skinned', 'morphed', 'instances'];

for (const { engine, snippet, types, skinned, float } of INTEGERS) {
  test(`${engine.page} shows the same with integers`, async () => {
    const { page, violations } = await open(engine);
    const uploads = () => page.evaluate(() => globalThis.uploads());
    for (const name of ALL) {
      const plain = await draw(page, `${name}.plain`);
      const floats = await uploads();
      const picture = await draw(page, `${name}.mcc`, snippet);
      const integers = await uploads();
      assert.deepEqual(problemsOf(name, { picture, plain, source: plain }), []);
      if (name === 'textured') assert.deepEqual(integers.types, types);
      if (name === 'tentacle') assert.equal(integers.types.position, skinned, 'of a skinned mesh');
      if (FIXED.includes(name)) assert.equal(integers.types.position, float, name);
      if (name === 'materials' && floats.bytes !== undefined) assert.ok(integers.bytes <= 0.67 * floats.bytes, `${integers.bytes} of ${floats.bytes} bytes`);
    }
    assert.deepEqual(violations(), []);
    await page.close();
  });
}

test('where workers cannot start, plugins decode on the thread of the page', async () => {
  const { page, violations } = await open({ page: 'three' }, 'noworkers');
  const picture = await draw(page, 'shared.mcc');
  assert.equal(page.workers().length, 0);
  assert.ok(violations().length > 0, 'the policy is in force');
  const [plain, source] = [await draw(page, 'shared.plain'), await draw(page, 'shared')];
  assert.deepEqual(problemsOf('shared', { picture, plain, source }), []);
  await page.close();
});

test('pictures inside of a GLB need blob: in connect-src, as the README says', async () => {
  const { page, violations } = await open({ page: 'three' }, 'noblobs');
  await draw(page, 'textured.mcc').catch(() => {});
  assert.match(violations().join(), /blob:.*connect-src/);
  await page.close();
});

async function saveScreenshot(engine, picture) {
  const folder = process.env.MCC_SCREENSHOTS;
  if (folder) await writeFile(path.join(folder, `${engine}.png`), writePicture(picture));
}
