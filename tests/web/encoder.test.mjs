// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { encodeGlb, initEncoder } from '../../lib/web/encoder.mjs';
import { MccError } from '../../lib/web/error.mjs';
import { readGlb, unpackGlb } from '../../lib/web/unpack.mjs';
import { wasm } from './support/conformance.mjs';
import { glbOf } from './support/glb.mjs';

const fileOf = (name) => fileURLToPath(new URL(`../../samples/${name}.glb`, import.meta.url));
const sample = (name) => new Uint8Array(readFileSync(fileOf(name)));
/** What tools/build-web has built. */
const tool = process.env.MCC_TOOL ?? fileURLToPath(new URL('../../build/release/tools/gltf-mcc', import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'encoder-'));
after(() => rmSync(folder, { recursive: true }));

/** Options of the module and of the tool that mean the same. */
const CASES = [
  ['torus', {}, []],
  ['textured', {}, []],
  ['skinned', {}, []],
  ['morphed', {}, []],
  ['two_materials', {}, []],
  ['quantized', {}, []],
  ['modes', {}, []],
  ['moebius', {}, []],
  ['textured', { lossless: true }, ['--lossless']],
  ['textured', { positionBits: 11, normalBits: 8, texcoordBits: 10 },
    ['--position-bits', '11', '--normal-bits', '8', '--texcoord-bits', '10']],
  ['sphere', { maxPositionError: 0.001 }, ['--max-position-error', '0.001']],
  ['sphere', { maxPositionError: 0.0005, isErrorRelative: true }, ['--max-position-error', '0.0005', '--is-error-relative']],
  ['two_materials', { keepVertexOrder: true, keepTriangleOrder: true }, ['--keep-vertex-order', '--keep-triangle-order']],
  ['skinned', { indicesOnly: true }, ['--indices-only']],
  ['two_materials', { grid: 'primitive' }, ['--grid', 'primitive']],
  ['sphere', { prefer: 'speed' }, ['--prefer', 'speed']],
  ['torus', { blockTriangles: 500 }, ['--block-triangles', '500']],
  ['sphere', { allowLarger: true }, ['--allow-larger']],
];

/** Measured angles depend on the C library's arc tangent. */
const rounded = (value) => JSON.parse(JSON.stringify(value ?? null, (key, x) => (typeof x === 'number' ? Number(x.toPrecision(12)) : x)));

describe('the same bytes as the tool', { skip: existsSync(tool) ? false : 'build/release/tools/gltf-mcc is not built' }, () => {
  for (const [name, options, args] of CASES) {
    test(`${name} ${args.join(' ')}`, async () => {
      const output = join(folder, 'out.glb');
      const json = join(folder, 'report.json');
      rmSync(json, { force: true });
      await promisify(execFile)(tool, ['convert', ...args, '--report', json, fileOf(name), output]);
      const { glb, report } = await encodeGlb(sample(name), options);
      assert.deepEqual(Buffer.from(glb), readFileSync(output));
      const expected = JSON.parse(readFileSync(json, 'utf8'));
      for (const key of Object.keys(report)) if (key !== 'seconds') assert.deepEqual(rounded(report[key]), rounded(expected[key]), key);
      assert.ok(report.seconds > 0);
    });
  }
});

test('there and back', async () => {
  const { glb, report } = await encodeGlb(sample('textured'));
  assert.ok(report.checked && !report.copied);
  assert.ok(glb.length < sample('textured').length);
  const { json } = readGlb(await unpackGlb(glb));
  assert.equal(json.extensionsUsed?.includes('KHR_mesh_collapse_compression') ?? false, false);
  assert.equal(json.meshes.length, readGlb(sample('textured')).json.meshes.length);
});

test('a step and a quality', async () => {
  const [usual, step, lattice, fine, coarse] = await Promise.all([{}, { step: 2 ** -10 }, { positionLattice: [0, 0, 0, 2 ** -10] },
    { quality: 4096 }, { quality: 256 }].map((options) => encodeGlb(sample('genus3'), options)));
  assert.deepEqual(step.glb, lattice.glb);
  assert.notDeepEqual(step.glb, usual.glb);
  assert.ok(coarse.glb.length < fine.glb.length);
  assert.equal(fine.report.quality_choices[0].why, 'nothing moves farther than 1/4096 of the longest side of its mesh');
  assert.equal(usual.report.quality_choices, undefined);
});

test('the version of the GLB', async () => {
  const [usual, second, third] = await Promise.all([{}, { glbVersion: 2 }, { glbVersion: 3 }].map((options) => encodeGlb(sample('genus3'), options)));
  const versionOf = (glb) => new DataView(glb.buffer).getUint32(4, true);
  assert.deepEqual([usual, second, third].map(({ glb }) => versionOf(glb)), [2, 2, 3]);
  assert.deepEqual(second.glb, usual.glb);
  assert.deepEqual(await unpackGlb(third.glb, { glbVersion: 2 }), await unpackGlb(usual.glb));
  assert.equal(third.report.options.glb_version, 3);
});

/** A flat sheet of side * side squares as a GLB. */
function sheet(side) {
  const row = side + 1;
  const positions = Float32Array.from({ length: 3 * row * row }, (_, i) => [Math.floor(i / 3) % row, Math.floor(i / 3 / row), 0][i % 3]);
  const corners = [0, 1, row + 1, 0, row + 1, row];
  const indices = Uint32Array.from({ length: 6 * side * side }, (_, i) => Math.floor(i / 6 / side) * row + Math.floor(i / 6) % side + corners[i % 6]);
  const json = {
    asset: { version: '2.0' },
    buffers: [{ byteLength: positions.byteLength + indices.byteLength }],
    bufferViews: [{ buffer: 0, byteLength: positions.byteLength }, { buffer: 0, byteOffset: positions.byteLength, byteLength: indices.byteLength }],
    accessors: [{ bufferView: 0, type: 'VEC3', componentType: 5126, count: row * row, min: [0, 0, 0], max: [side, side, 0] },
      { bufferView: 1, type: 'SCALAR', componentType: 5125, count: indices.length }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
  };
  return glbOf(json, Buffer.concat([positions, indices].map(({ buffer }) => Buffer.from(buffer))));
}

test('a preview', async () => {
  const glb = sheet(224); // just enough triangles
  const [usual, some, share] = await Promise.all([{}, { previewTriangles: 500 }, { previewTriangles: true }].map((options) => encodeGlb(glb, options)));
  const countIn = ({ report }) => report.primitives[0].preview_triangles;
  assert.equal(countIn(usual), undefined);
  assert.ok(countIn(some) > 300 && countIn(some) <= 500, `${countIn(some)}`);
  assert.ok(countIn(share) > 1500 && countIn(share) <= 2007, `${countIn(share)}`);
  assert.deepEqual(await unpackGlb(some.glb), await unpackGlb(usual.glb));
});

test('imports nothing', async () => {
  assert.deepEqual(WebAssembly.Module.imports(await WebAssembly.compile(wasm('mcc_encoder'))), []);
});

test('what is wrong is said', async () => {
  const codeOf = async (...args) => encodeGlb(...args).then(() => 'none', (error) => {
    assert.ok(error instanceof MccError, error.stack);
    assert.ok(error.message.length > 10);
    return error.code;
  });
  for (const options of [{ positionBits: 25 }, { normalBits: 1 }, { positionBits: '14' }, { grid: 'world' }, { maxPositionError: 0 },
    { positionbits: 14 }, { lossless: 1 }, { effort: 1 }, { prefer: 'beauty' }, { blockTriangles: -1 }, { positionLattice: [0, 0, 0, 0] }, { step: 0.001 }, { step: '1' }, { glbVersion: 0 }, { glbVersion: 4 }, { glbVersion: '2' },
    { step: 2 ** -127 }, { step: 1, maxPositionError: 1 }, { step: 1, lossless: true }, { quality: 15 }, { quality: 2 ** 20 + 1 },
    { quality: NaN }, { quality: '64' }, { quality: 64, normalBits: 8 }, { quality: 64, step: 1 }, { quality: 64, lossless: true }, { fallback: true }, { previewTriangles: 0 },
    { previewTriangles: false }, { previewTriangles: 2 ** 32 - 1 }, { previewTriangles: 5, indicesOnly: true }]) {
    assert.equal(await codeOf(sample('torus'), options), 'BadArgument', JSON.stringify(options));
  }
  assert.equal(await codeOf('torus.glb'), 'BadArgument');
  assert.equal(await codeOf(new Uint8Array(10)), 'Encode');
  assert.equal(await codeOf(sample('torus').slice(0, 500)), 'Encode');
  const mutated = sample('torus');
  mutated.fill(0x78, 30, 60);
  assert.equal(await codeOf(mutated), 'Encode');
});

test('from its bytes', async () => {
  await initEncoder({ bytes: wasm('mcc_encoder') });
  await encodeGlb(sample('torus'));
  await initEncoder();
});
