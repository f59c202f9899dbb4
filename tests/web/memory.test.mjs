// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// WebAssembly's memory cannot shrink: an instance that has grown large is dropped after a second without work.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { setTimeout as wait } from 'node:timers/promises';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { Decoder } from '../../lib/web/core.mjs';
import { BIN_CHUNK, writeGlb } from '../../lib/web/unpack.mjs';
import { manifest, payloadOf, readAsset, wasm } from './support/conformance.mjs';
import { convert } from './support/program.mjs';

setFlagsFromString('--expose-gc');
const collectGarbage = runInNewContext('gc');
const LARGE = 64 << 20;

/** A flat grid of side * side vertices as a GLB. */
function gridGlb(side) {
  const positions = Float32Array.from({ length: 3 * side * side }, (_, i) => [
    Math.floor(i / 3) % side, Math.floor(i / 3 / side), 0,
  ][i % 3]);
  const indices = Uint32Array.from({ length: 6 * (side - 1) ** 2 }, (_, i) => {
    const [quad, corner] = [Math.floor(i / 6), i % 6];
    const [x, y] = [quad % (side - 1), Math.floor(quad / (side - 1))];
    return x + [0, 1, 0, 0, 1, 1][corner] + (y + [0, 0, 1, 1, 0, 1][corner]) * side;
  });
  const data = new Uint8Array(positions.byteLength + indices.byteLength);
  data.set(new Uint8Array(positions.buffer));
  data.set(new Uint8Array(indices.buffer), positions.byteLength);
  return writeGlb({
    asset: { version: '2.0' },
    buffers: [{ byteLength: data.length }],
    bufferViews: [
      { buffer: 0, byteLength: positions.byteLength },
      { buffer: 0, byteOffset: positions.byteLength, byteLength: indices.byteLength },
    ],
    accessors: [
      { bufferView: 0, componentType: 5126, count: side * side, type: 'VEC3', min: [0, 0, 0], max: [side - 1, side - 1, 0] },
      { bufferView: 1, componentType: 5125, count: indices.length, type: 'SCALAR' },
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
  }, [{ type: BIN_CHUNK, data }]);
}

/** Runs `work`; weak references to the memories of the instances made meanwhile. */
async function memoriesOf(work) {
  const { instantiate } = WebAssembly;
  const memories = [];
  WebAssembly.instantiate = async (...args) => {
    const instance = await instantiate(...args);
    memories.push(new WeakRef(instance.exports.memory));
    return instance;
  };
  try {
    await work();
  } finally {
    WebAssembly.instantiate = instantiate;
  }
  return memories;
}

/** Whether it is collected: in a while, since a garbage collector may take its time. */
async function isGone(reference) {
  for (let i = 0; i < 100; ++i) {
    await wait(100);
    collectGarbage();
    if (reference.deref() === undefined) return true;
  }
  return false;
}

test('the memory of a large model is given back', async () => {
  const large = payloadOf(convert(gridGlb(900), ['--block-triangles', '0'])); // blocks take less
  const decoder = new Decoder(await WebAssembly.compile(wasm('mcc_decoder')));
  const memories = await memoriesOf(async () => {
    await decoder.decode(large);
    await decoder.decode(large); // at once, in the same memory
  });
  assert.equal(memories.length, 1);
  assert.ok(memories[0].deref().buffer.byteLength > LARGE);
  assert.ok(await isGone(memories[0]));

  const small = payloadOf(readAsset(manifest.assets[20]));
  const others = await memoriesOf(async () => {
    await decoder.decode(small);
    await wait(1500);
    await decoder.decode(small); // small ones are kept
  });
  assert.equal(others.length, 1);
  assert.ok(others[0].deref().buffer.byteLength < LARGE);
});
