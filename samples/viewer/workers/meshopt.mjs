// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compresses the same primitives with meshoptimizer, with the same bits. This worker gets
// { bytes, bits, lossless }. It posts { name: 'progress', done }, and then { name: 'error', message } or
// { name: 'done', payloads, streams } with bytes by name of stream.
import { MeshoptEncoder } from '../vendor/meshopt/meshopt_encoder.mjs';
import { readGlb, trianglePrimitivesOf } from '../glb.mjs';
import { encodePrimitive } from '../meshopt.mjs';
import { readPrimitive } from '../primitives.mjs';

async function run({ bytes, bits, lossless }) {
  await MeshoptEncoder.ready;
  const gltf = readGlb(bytes);
  const definitions = trianglePrimitivesOf(gltf.json).map(({ definition }) => definition);
  const streams = new Map();
  const payloads = definitions.map((definition, i) => {
    const payload = encodePrimitive(MeshoptEncoder, readPrimitive(gltf, definition), { bits, lossless });
    for (const { name, length } of payload.streams) streams.set(name, (streams.get(name) ?? 0) + length);
    postMessage({ name: 'progress', done: (i + 1) / definitions.length });
    return payload;
  });
  return { payloads, streams };
}

onmessage = async ({ data }) => {
  try {
    postMessage({ name: 'done', ...await run(data) });
  } catch (error) {
    postMessage({ name: 'error', message: error.message });
  }
};
