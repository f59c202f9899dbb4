// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Meshlets of decoded triangles: each triangle once with its orientation, within the limits, as meshoptimizer reads them.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { MccError } from '../../lib/web/error.mjs';
import { decodePayload } from '../../lib/web/index.mjs';
import { encodeGlb } from '../../lib/web/encoder.mjs';
import { buildMeshlets } from '../../lib/web/meshlets.mjs';
import { payloadOf } from './support/conformance.mjs';
import { readSample } from './support/program.mjs';

const pieceOf = async (name) => (await decodePayload(payloadOf((await encodeGlb(readSample(name))).glb))).pieces[0];

/** The triangles as text, sorted. */
const sorted = (corners) => Array.from({ length: corners.length / 3 }, (_, i) => `${corners[3 * i]} ${corners[3 * i + 1]} ${corners[3 * i + 2]}`).sort();

/** The corners that meshlets stand for. Checks limits and that nothing is between them. */
function cornersOf({ meshlets, vertices, triangles, meshletCount }, { maxVertices = 64, maxTriangles = 124 }) {
  const corners = [];
  let vertexEnd = 0;
  let byteEnd = 0;
  assert.equal(meshlets.length, 4 * meshletCount);
  for (let i = 0; i < meshletCount; ++i) {
    const [vertexOffset, triangleOffset, vertexCount, triangleCount] = meshlets.subarray(4 * i, 4 * i + 4);
    assert.deepEqual([vertexOffset, triangleOffset], [vertexEnd, byteEnd]);
    assert.ok(vertexCount <= maxVertices && triangleCount <= maxTriangles && triangleCount > 0);
    assert.equal(new Set(vertices.subarray(vertexOffset, vertexOffset + vertexCount)).size, vertexCount);
    for (const local of triangles.subarray(triangleOffset, triangleOffset + 3 * triangleCount)) {
      assert.ok(local < vertexCount);
      corners.push(vertices[vertexOffset + local]);
    }
    vertexEnd += vertexCount;
    byteEnd += Math.ceil(3 * triangleCount / 4) * 4;
  }
  assert.deepEqual([vertices.length, triangles.length], [vertexEnd, byteEnd]);
  return corners;
}

for (const name of ['sphere', 'torus', 'koi', 'sheet_with_holes', 'non_manifold', 'textured']) {
  test(`the meshlets of ${name} are its triangles`, async () => {
    const { wedgeCount, parts } = await pieceOf(name);
    for (const { indices } of parts) {
      for (const limits of [{}, { maxVertices: 3, maxTriangles: 512 }, { maxVertices: 256, maxTriangles: 512 }, { maxVertices: 32, maxTriangles: 7 }]) {
        assert.deepEqual(sorted(cornersOf(buildMeshlets(indices, wedgeCount, limits), limits)), sorted(indices));
        const inOrder = cornersOf(buildMeshlets(indices, wedgeCount, { ...limits, shape: 'order' }), limits);
        assert.deepEqual(inOrder, [...indices]);
      }
    }
  });
}

test('the meshlets of a list are known', () => {
  // As tests/unit/reader/meshlets_test.cpp.
  const indices = Uint16Array.of(0, 1, 2, 2, 1, 3, 7, 8, 9, 2, 3, 4, 4, 3, 5);
  const { meshlets, vertices, triangles, meshletCount } = buildMeshlets(indices, 10, { maxVertices: 6, maxTriangles: 16 });
  assert.equal(meshletCount, 2);
  assert.deepEqual([...meshlets], [0, 0, 6, 4, 6, 12, 3, 1]);
  assert.deepEqual([...vertices], [0, 1, 2, 3, 4, 5, 7, 8, 9]);
  assert.deepEqual([...triangles], [0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5, 0, 1, 2, 0]);
});

test('a decoded sphere has few of them', async () => {
  const { wedgeCount, parts: [{ indices }] } = await pieceOf('sphere');
  const { vertices } = buildMeshlets(indices, wedgeCount);
  assert.ok(vertices.length < 0.75 * indices.length / 3, `${vertices.length} vertices for ${indices.length / 3} triangles`);
});

test('a list of nothing has none, and what cannot be is refused', () => {
  const one = Uint16Array.of(0, 1, 2);
  assert.equal(buildMeshlets(new Uint32Array(0), 0).meshletCount, 0);
  const wrong = [
    [[0, 1, 2], 3], [one, 2], [one, -1], [one, 1.5], [one.subarray(1), 3], [one, 3, { maxVertices: 2 }], [one, 3, { maxVertices: 257 }],
    [one, 3, { maxTriangles: 0 }], [one, 3, { maxTriangles: 513 }], [one, 3, { maxTriangles: 1.5 }], [one, 3, { shape: 'flat' }],
    [Float32Array.of(0, 1, 2), 3],
  ];
  for (const [indices, vertexCount, options] of wrong) {
    assert.throws(() => buildMeshlets(indices, vertexCount, options), (error) => error instanceof MccError && error.code === 'BadArgument');
  }
});

test('time is linear for a fan', () => {
  const count = 2 ** 18;
  const fan = new Uint32Array(3 * count);
  for (let i = 0; i < count; ++i) fan.set([0, 2 * i + 1, 2 * i + 2], 3 * i);
  const start = performance.now();
  assert.equal(buildMeshlets(fan, 2 * count + 1).meshletCount, Math.ceil(count / 31));
  assert.ok(performance.now() - start < 2000, 'each meshlet has looked at all triangles of the fan');
});
