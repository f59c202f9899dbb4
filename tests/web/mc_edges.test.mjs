// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// mcEdges() of encoder.mjs: the edges along which a mesh was contracted are edges of it and join all of its vertices.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { decodePayload } from '../../lib/web/index.mjs';
import { encodeGlb, mcEdges } from '../../lib/web/encoder.mjs';
import { payloadOf } from './support/conformance.mjs';
import { readSample } from './support/program.mjs';

const encoded = async (name, options) => payloadOf((await encodeGlb(readSample(name), options)).glb);

for (const options of [{}, { keepVertexOrder: true, keepTriangleOrder: true }]) {
  test(`the edges are a tree of the mesh, ${JSON.stringify(options)}`, async () => {
    const payload = await encoded('sphere', options);
    const { pieces: [{ wedgeCount, parts: [{ indices }] }] } = await decodePayload(payload);
    const sides = new Set();
    indices.forEach((a, c) => {
      const b = indices[c % 3 === 2 ? c - 2 : c + 1];
      sides.add(`${a} ${b}`).add(`${b} ${a}`);
    });
    const [edges, ...others] = await mcEdges(payload);
    assert.equal(others.length, 0);
    const parents = Array.from({ length: wedgeCount }, (_, i) => i);
    const rootOf = (v) => (parents[v] === v ? v : (parents[v] = rootOf(parents[v])));
    for (let i = 0; i < edges.length; i += 2) {
      assert.ok(sides.has(`${edges[i]} ${edges[i + 1]}`), `edge ${i / 2} is none of the mesh`);
      parents[rootOf(edges[i])] = rootOf(edges[i + 1]);
    }
    assert.equal(new Set(parents.map((_, v) => rootOf(v))).size, 1);
  });
}

test('pieces have their own', async () => {
  const payload = await encoded('two_materials', {});
  const { pieces } = await decodePayload(payload);
  const edges = await mcEdges(payload);
  assert.equal(edges.length, pieces.length);
  pieces.forEach(({ wedgeCount }, i) => {
    assert.ok(edges[i].length / 2 >= wedgeCount - 2, `piece ${i}`);
    assert.ok(edges[i].every((vertex) => vertex < wedgeCount));
  });
});

test('a damaged payload rejects with what is wrong', async () => {
  const payload = await encoded('torus', {});
  payload[payload.length - 1] ^= 1;
  await assert.rejects(mcEdges(payload), { name: 'MccError', message: /checksum/ });
  await assert.rejects(mcEdges('no bytes'), { code: 'BadArgument' });
});
