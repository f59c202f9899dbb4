// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The parts of samples/viewer that need no browser; the page is tested in browser/viewer.test.mjs.
import assert from 'node:assert/strict';
import path from 'node:path';
import { test } from 'node:test';
import { MeshoptDecoder } from 'meshoptimizer/decoder';
import { MeshoptEncoder } from 'meshoptimizer/encoder';
import { measureErrors } from '../../samples/viewer/errors.mjs';
import { readGlb, readNumbers, readTriangles, trianglePrimitivesOf } from '../../samples/viewer/glb.mjs';
import { encodePrimitive } from '../../samples/viewer/meshopt.mjs';
import { readPrimitive } from '../../samples/viewer/primitives.mjs';
import { encodeFile } from './support/bench/encode.mjs';
import { SAMPLES } from './support/paths.mjs';
import { convert, decode, PROGRAM, readSample } from './support/program.mjs';

/** Numbers from 0 to 1, the same ones in every run. */
function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = Math.imul(state, 1664525) + 1013904223 >>> 0;
    return state / 2 ** 32;
  };
}

/** Points, and what a lattice of `bits` bits makes of them, in another order. */
function quantized(count, bits, seed) {
  const random = randomNumbers(seed);
  const points = Float32Array.from({ length: 3 * count }, () => 20 * random() - 5);
  const step = 20 / (2 ** bits - 1);
  const order = Array.from({ length: count }, (_, i) => i).sort(() => random() - 0.5);
  const decoded = new Float32Array(3 * count);
  order.forEach((from, to) => {
    for (let s = 0; s < 3; ++s) decoded[3 * to + s] = Math.round((points[3 * from + s] + 5) / step) * step - 5;
  });
  return { points, decoded, order, promised: step / 2 };
}

const distance = (a, i, b, j) => Math.hypot(a[3 * i] - b[3 * j], a[3 * i + 1] - b[3 * j + 1], a[3 * i + 2] - b[3 * j + 2]);

for (const bits of [2, 6, 14, 20]) {
  test(`errors of ${bits} bits are those of the vertices that came from each other`, () => {
    const { points, decoded, order, promised } = quantized(3000, bits, 7 + bits);
    const { errors, missed } = measureErrors(points, decoded, promised);
    assert.equal(missed, 0);
    // Vertices that became one share the largest of their errors.
    const expected = new Map();
    const key = (to) => decoded.slice(3 * to, 3 * to + 3).join();
    order.forEach((from, to) => expected.set(key(to), Math.max(expected.get(key(to)) ?? 0, distance(points, from, decoded, to))));
    errors.forEach((error, to) => assert.ok(Math.abs(error - expected.get(key(to))) <= 1e-6 * promised + 2e-7, `vertex ${to}`));
  });
}

test('exact positions have no error, and what is too far is counted', () => {
  const { points } = quantized(500, 8, 3);
  const exact = measureErrors(points, points, 0);
  assert.deepEqual([Math.max(...exact.errors), exact.missed], [0, 0]);
  const moved = points.slice();
  moved[3 * 17] += 0.5;
  assert.equal(measureErrors(points, moved, 0).missed, 1);
});

test('strips, fans and sparse accessors are read as the program reads them', () => {
  const source = readGlb(readSample('modes'));
  const plain = readGlb(decode(convert(readSample('modes'), ['--lossless', '--keep-vertex-order', '--keep-triangle-order'])));
  const [primitives, expected] = [source, plain].map(({ json }) => trianglePrimitivesOf(json));
  assert.equal(primitives.length, expected.length);
  assert.ok(primitives.some(({ definition: { mode } }) => mode === 5) && primitives.some(({ definition: { mode } }) => mode === 6));
  primitives.forEach(({ definition }, i) => {
    const other = expected[i].definition;
    assert.deepEqual(readTriangles(source, definition), readTriangles(plain, other), `triangles of primitive ${i}`);
    assert.deepEqual(readNumbers(source, definition.attributes.POSITION), readNumbers(plain, other.attributes.POSITION));
  });
});

const BITS = { positionBits: 14, normalBits: 10, texcoordBits: 12, colorBits: 8, tangentBits: 12, weightBits: 12 };

async function meshoptOf(name, options) {
  await Promise.all([MeshoptEncoder.ready, MeshoptDecoder.ready]);
  const gltf = readGlb(readSample(name));
  const primitives = trianglePrimitivesOf(gltf.json).map(({ definition }) => readPrimitive(gltf, definition));
  return primitives.map((primitive) => ({ primitive, ...encodePrimitive(MeshoptEncoder, primitive, options) }));
}

const bytesOfAttributes = (units) => units.flatMap(({ streams }) => streams).filter(({ name }) => !name?.startsWith('target'))
  .reduce((sum, { length }) => sum + length, 0);

// The benchmark begins with the vertices in the order of Draco's decoder. Where that is the file's, every byte is the same; elsewhere
// the codec begins with another triangle, which is worth up to a tenth where values are noise.
const TOLERANCES = { skinned: 0, morphed: 0, textured: 0.06, genus3: 0.06, two_materials: 0.06, quantized: 0.12 };
for (const [name, tolerance] of Object.entries(TOLERANCES)) {
  test(`meshopt of ${name} has the bytes that the benchmark measures`, async () => {
    const units = await meshoptOf(name, { bits: BITS, lossless: false });
    const { codecs: { meshopt } } = await encodeFile(PROGRAM, path.join(SAMPLES, `${name}.glb`));
    const [ours, expected] = [bytesOfAttributes(units), bytesOfAttributes(meshopt)];
    assert.ok(Math.abs(ours / expected - 1) <= tolerance, `${ours} instead of ${expected}`);
    const shapes = (list) => list.map(({ streams }) => streams.filter(({ name: stream }) => !stream?.startsWith('target'))
      .map(({ count, stride, filter }) => `${count} of ${stride} ${filter}`).sort());
    assert.deepEqual(shapes(units), shapes(meshopt));
  });
}

test('lossless meshopt keeps every triangle', async () => {
  for (const { primitive, bytes, streams } of await meshoptOf('two_materials', { bits: BITS, lossless: true })) {
    const [list, position] = ['connectivity', 'POSITION'].map((wanted) => decodeStream(bytes, streams.find(({ name }) => name === wanted)));
    const positions = new Float32Array(position.buffer);
    const indices = streams[0].stride === 2 ? new Uint16Array(list.buffer) : new Uint32Array(list.buffer);
    assert.deepEqual(corners(indices, positions), corners(primitive.triangles, primitive.attributes[0].array));
  }
});

function decodeStream(bytes, { offset, length, count, stride, mode, filter }) {
  const target = new Uint8Array(count * stride);
  MeshoptDecoder.decodeGltfBuffer(target, count, stride, bytes.subarray(offset, offset + length), mode, filter);
  return target;
}

/** The points of all triangles, whatever the order of triangles and the first corner of each is. */
function corners(indices, positions) {
  const points = Array.from(indices, (index) => positions.slice(3 * index, 3 * index + 3).join());
  return Array.from({ length: indices.length / 3 }, (_, i) => {
    const triangle = points.slice(3 * i, 3 * i + 3);
    const least = triangle.indexOf(triangle.toSorted()[0]);
    return [...triangle.slice(least), ...triangle.slice(0, least)].join(' ');
  }).sort();
}
