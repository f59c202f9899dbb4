// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The parts of samples/viewer that need no browser; the page is tested in browser/viewer.test.mjs.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { measureErrors } from '../../samples/viewer/errors.mjs';
import { readGlb, readNumbers, readTriangles, trianglePrimitivesOf } from '../../samples/viewer/glb.mjs';
import { decode, convert, readSample } from './support/program.mjs';

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
  const plain = readGlb(decode(convert(readSample('modes'), ['--lossless', '--keep-order', 'both'])));
  const [primitives, expected] = [source, plain].map(({ json }) => trianglePrimitivesOf(json));
  assert.equal(primitives.length, expected.length);
  assert.ok(primitives.some(({ definition: { mode } }) => mode === 5) && primitives.some(({ definition: { mode } }) => mode === 6));
  primitives.forEach(({ definition }, i) => {
    const other = expected[i].definition;
    assert.deepEqual(readTriangles(source, definition), readTriangles(plain, other), `triangles of primitive ${i}`);
    assert.deepEqual(readNumbers(source, definition.attributes.POSITION), readNumbers(plain, other.attributes.POSITION));
  });
});
