// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Work and memory are in proportion to the bytes of a file, whatever its JSON says: counted, not timed. tools/check/growth web
// measures the same families at sizes that hurt.
import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
// Counts what is compiled after it is loaded, which functions are when they are called.
import { assertLinear, countOf } from './support/counting.mjs';
import { decodeGlbBlocks, decodePayload, MccError, unpackTile } from '../../lib/web/index.mjs';
import { payloadsOf } from '../../lib/web/document.mjs';
import { readGlb, unpackGlb } from '../../lib/web/unpack.mjs';
import { unpackGltf } from '../../lib/web/unpack_gltf.mjs';
import { usesOf } from '../../lib/web/uses.mjs';
import { PayloadViews } from '../../lib/web/views.mjs';
import { FAMILIES } from './support/families.mjs';
import { glbOf } from './support/glb.mjs';

const SMALL = 60;
const OVERLAPPING = 'primitives whose payloads overlap in 10 MB';
const AT_A_TIME = 16;

/** Settles, and fails only by an MccError. */
const settles = (promise) => promise.catch((error) => assert.ok(error instanceof MccError, error.stack));

/** A decodePayload() that takes its time, and what may be seen of it. */
function standIn(fails = () => false) {
  const seen = { calls: 0, now: 0, most: 0, bytes: [] };
  const decode = async (bytes) => {
    const call = seen.calls++;
    seen.most = Math.max(seen.most, ++seen.now);
    seen.bytes.push(bytes);
    await new Promise((resolve) => { setTimeout(resolve, 1); });
    --seen.now;
    if (fails(call)) throw new MccError('damaged', 'BadChecksum');
    return decodePayload(bytes);
  };
  return { seen, decode };
}

describe('linear', () => {
  for (const [name, { make }] of Object.entries(FAMILIES)) {
    test(`unpackTile(): ${name}`, () => assertLinear(SMALL, (n) => settles(unpackTile(make(n, 4096)))));
    if (!/tile/.test(name)) {
      test(`decodeGlbBlocks(): ${name}`, () => assertLinear(SMALL, (n) => settles(listOf(decodeGlbBlocks(make(n, 4096))))));
      test(`loaders: ${name}`, () => assertLinear(SMALL, (n) => settles(loadAll(make(n, 4096)))));
      test(`unpackGltf(): ${name}`, () => assertLinear(SMALL, (n) => settles(unpackAsGltf(make(n, 4096)))));
    }
  }

  test('blocks of many pieces, which many primitives draw', () => assertLinear(SMALL, async (n) => {
    const { json, chunks: [{ data }] } = readGlb(FAMILIES['primitives of one payload'].make(n));
    json.meshes[0].primitives.forEach(({ extensions }, i) => { Object.values(extensions)[0].piece = i; });
    const decodeBlocks = async function* pieces() {
      for (let piece = 0; piece < n; ++piece) yield { piece };
    };
    const blocks = await listOf(decodeGlbBlocks(glbOf(json, data), { decodeBlocks }));
    assert.deepEqual(blocks.map(({ uses }) => uses.map(({ primitive }) => primitive)), blocks.map((_, i) => [i]));
  }));

  test('blocks whose primitives plugins ask for', () => assertLinear(SMALL, async (n) => {
    const [{ claims }] = payloadsOf(readGlb(FAMILIES['primitives of one payload'].make(n)).json);
    for (let block = 0; block < n; ++block) assert.equal(usesOf(claims).length, n);
  }));
});

async function listOf(iterable) {
  const list = [];
  for await (const entry of iterable) list.push(entry);
  return list;
}

async function loadAll(glb) {
  const { json, chunks: [{ data }] } = readGlb(glb);
  const fetchPayload = async (number) => {
    const { byteOffset = 0, byteLength } = json.bufferViews[number];
    return data.subarray(byteOffset, byteOffset + byteLength);
  };
  const views = new PayloadViews(json, fetchPayload);
  // All of them end before the next count begins, although one may be refused at once.
  const loads = await Promise.allSettled(views.bufferViews.map((_, number) => views.load(number)));
  for (const { reason } of loads) if (reason) throw reason;
}

async function unpackAsGltf(glb) {
  const { json, chunks: [{ data }] } = readGlb(glb);
  const { decode } = unpackGltf(json, 'more.bin');
  await decode(async (number) => {
    const { byteOffset = 0, byteLength } = json.bufferViews[number];
    return data.subarray(byteOffset, byteOffset + byteLength);
  });
}

test('work that is quadratic is noticed', async () => {
  const { originOf } = await import('../../lib/web/document.mjs');
  const quadratic = async (n) => { for (let i = 0; i < n * n; ++i) originOf({}, {}); };
  await assert.rejects(assertLinear(SMALL, quadratic), /for 60, 120 and 240/);
  assert.ok(await countOf(() => quadratic(10)) >= 100);
});

test('payloads that overlap are refused before one is decoded', async () => {
  const { seen, decode } = standIn();
  const glb = FAMILIES[OVERLAPPING].make(20, 4096);
  for (const unpack of [unpackGlb, unpackTile]) {
    await assert.rejects(unpack(glb, { decode }), { code: 'Document', message: '/bufferViews/1: overlaps another payload' });
  }
  await assert.rejects(listOf(decodeGlbBlocks(glb)), { message: '/bufferViews/1: overlaps another payload' });
  const { json } = readGlb(glb);
  assert.throws(() => new PayloadViews(json, () => assert.fail()), { message: '/bufferViews/1: overlaps another payload' });
  // The same in a .gltf whose buffers are one file.
  json.buffers = json.bufferViews.map(() => ({ uri: 'one.bin', byteLength: 4096 }));
  json.bufferViews.forEach((view, i) => { view.buffer = i; });
  assert.throws(() => unpackGltf(json, 'more.bin'), { message: '/bufferViews/1: overlaps another payload' });
  json.buffers.forEach((buffer, i) => { buffer.uri = `${i}.bin`; });
  unpackGltf(json, 'more.bin'); // of many files, they do not overlap
  assert.equal(seen.calls, 0);
});

test('payloads are decoded in place, a few at a time', async () => {
  const glb = FAMILIES.payloads.make(100);
  const { seen, decode } = standIn();
  await unpackGlb(glb, { decode });
  assert.equal(seen.calls, 100);
  assert.equal(seen.most, AT_A_TIME);
  assert.ok(seen.bytes.every(({ buffer }) => buffer === glb.buffer), 'they are views, not copies');
});

test('loaders and services fetch and decode a few at a time', async () => {
  const { json, chunks: [{ data }] } = readGlb(FAMILIES.payloads.make(100));
  let [now, most] = [0, 0];
  const fetchPayload = async (number) => {
    most = Math.max(most, ++now);
    const { byteOffset, byteLength } = json.bufferViews[number];
    return data.subarray(byteOffset, byteOffset + byteLength);
  };
  const decode = async (bytes) => {
    await new Promise((resolve) => { setTimeout(resolve, 1); });
    --now;
    return decodePayload(bytes);
  };
  const views = new PayloadViews(json, fetchPayload, { decode });
  // All of them end before the next count begins, although one may be refused at once.
  const loads = await Promise.allSettled(views.bufferViews.map((_, number) => views.load(number)));
  for (const { reason } of loads) if (reason) throw reason;
  assert.equal(most, AT_A_TIME);
  [now, most] = [0, 0];
  await unpackGltf(json, 'more.bin').decode(fetchPayload, { decode });
  assert.equal(most, AT_A_TIME);
});

test('a payload that never comes does not keep others from being loaded', async () => {
  const { json, chunks: [{ data }] } = readGlb(FAMILIES.payloads.make(100));
  const views = new PayloadViews(json, async (number) => {
    if (number < AT_A_TIME - 1) await new Promise(() => {});
    const { byteOffset, byteLength } = json.bufferViews[number];
    return data.subarray(byteOffset, byteOffset + byteLength);
  }, { decode: decodePayload });
  const numberOf = (accessor) => views.accessors[accessor].bufferView;
  const loads = json.meshes[0].primitives.map(({ indices }) => views.load(numberOf(indices)));
  await Promise.all(loads.slice(AT_A_TIME - 1));
});

test('after a failure, no payload is begun', async () => {
  for (const [unpack, file] of [[unpackGlb, FAMILIES.payloads.make(200)], [unpackTile, FAMILIES['tiles in a composite'].make(200)]]) {
    const { seen, decode } = standIn((call) => call === 20);
    await assert.rejects(unpack(file, { decode }), { code: 'BadChecksum' });
    await new Promise((resolve) => { setTimeout(resolve, 50); });
    assert.ok(seen.calls < 21 + 2 * AT_A_TIME, `${seen.calls} were begun`);
  }
});
