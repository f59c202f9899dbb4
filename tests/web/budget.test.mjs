// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What a file as a whole may cost, whatever its payloads are: the decoder is a stand-in here.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { NodeIO } from '@gltf-transform/core';
import './support/peers.mjs';
import { EXTENSION_NAME } from '../../lib/web/document.mjs';
import { readGlb, unpackGlb, writeGlb } from '../../lib/web/unpack.mjs';
import { PayloadViews } from '../../lib/web/views.mjs';

const { KHRMeshCollapseCompression } = await import('../../lib/web/gltf-transform.mjs');

const BIN_CHUNK = 0x004e4942;
const VERTICES = 3;

/** A document of primitives; primitive i has accessors of its own, and the payload in the buffer view viewOf(i). */
function documentOf(primitiveCount, viewCount, viewOf, count = VERTICES) {
  const json = {
    asset: { version: '2.0' }, extensionsUsed: [EXTENSION_NAME], extensionsRequired: [EXTENSION_NAME],
    buffers: [{ byteLength: 4 * viewCount }], bufferViews: [], accessors: [], meshes: [],
  };
  for (let i = 0; i < viewCount; ++i) json.bufferViews.push({ buffer: 0, byteOffset: 4 * i, byteLength: 4 });
  for (let i = 0; i < primitiveCount; ++i) {
    json.accessors.push({ componentType: 5126, type: 'VEC3', count }, { componentType: 5123, type: 'SCALAR', count: 3 });
    const extension = { bufferView: viewOf(i), attributes: { POSITION: 0 } };
    json.meshes.push({ primitives: [
      { attributes: { POSITION: 2 * i }, indices: 2 * i + 1, extensions: { [EXTENSION_NAME]: extension } },
    ] });
  }
  return json;
}

const glbOf = (json) => writeGlb(json, [{ type: BIN_CHUNK, data: new Uint8Array(json.buffers[0].byteLength) }]);

/** What stands in for decodePayload(); `calls` has the options it got. */
function standIn() {
  const calls = [];
  const decodeSync = (bytes, options) => {
    calls.push(options);
    const positions = new Float32Array(3 * VERTICES).fill(calls.length);
    return { pieces: [{
      wedgeCount: VERTICES, attributes: [{ array: positions }], parts: [{ triangleCount: 1, indices: new Uint16Array([0, 1, 2]) }],
    }] };
  };
  return { calls, decodeSync, decode: async (bytes, options) => decodeSync(bytes, options) };
}

test('a payload is decoded once, however many primitives and views name its bytes, and its elements are there once', async () => {
  const json = documentOf(200, 2, (i) => i % 2);
  json.bufferViews[1] = { ...json.bufferViews[0] };
  const { calls, decode } = standIn();
  const { json: plain, chunks: [{ data }] } = readGlb(await unpackGlb(glbOf(json), { decode }));
  assert.equal(calls.length, 1);
  assert.equal(data.length, 36 + 8);
  assert.equal(plain.bufferViews.length, 2);
  plain.meshes.forEach(({ primitives: [{ attributes, indices }] }) => {
    const positions = plain.bufferViews[plain.accessors[attributes.POSITION].bufferView];
    assert.deepEqual([positions.target, positions.byteLength, positions.byteStride], [34962, 36, 12]);
    assert.deepEqual(plain.bufferViews[plain.accessors[indices].bufferView].target, 34963);
  });

  const again = standIn();
  const views = new PayloadViews(json, async () => new Uint8Array(4), again);
  const numbers = new Set(views.accessors.map(({ bufferView }) => bufferView));
  assert.equal(numbers.size, 2, 'graphics cards get them once');
  for (const number of numbers) await views.load(number);
  assert.equal(again.calls.length, 1);
});

test('index accessors of several types have views of their own', async () => {
  const json = documentOf(2, 1, () => 0);
  json.accessors[3].componentType = 5125;
  const { json: plain } = readGlb(await unpackGlb(glbOf(json), standIn()));
  assert.deepEqual([1, 3].map((i) => plain.bufferViews[plain.accessors[i].bufferView].byteLength), [6, 12]);
});

test('what all payloads decode to is limited before one is decoded', async () => {
  const count = 2 ** 20; // 12 MiB each
  const json = documentOf(30, 30, (i) => i, count);
  const glb = glbOf(json);
  const { calls, decode } = standIn();
  const named = 30 * (12 * count + 12);
  await assert.rejects(unpackGlb(glb, { decode }), ({ code, message }) => {
    assert.equal(code, 'Limit');
    assert.equal(message, `its ${glb.length} bytes decode to ${named}, more than limits.maxDecodedBytes: ${2 ** 28}`);
    return true;
  });
  assert.equal(calls.length, 0);
  await assert.rejects(unpackGlb(glb, { decode, limits: { maxDecodedBytes: named - 1 } }), { code: 'Limit' });
  assert.equal(calls.length, 0);
  await unpackGlb(glb, { decode, limits: { maxDecodedBytes: named } });
  assert.equal(calls.length, 30);
  // What the document does not name of a payload is held against what is left.
  assert.equal(calls[0].limits.maxOutputBytes, 12 * count + 12);
  assert.equal('maxDecodedBytes' in calls[0].limits, false);

  const views = new PayloadViews(json, async () => new Uint8Array(4), { decode });
  const results = await Promise.allSettled(views.accessors.map(({ bufferView }) => views.load(bufferView)));
  const refused = results.filter(({ reason }) => reason?.code === 'Limit').length / 2;
  assert.equal(refused, 30 - Math.floor(2 ** 28 / (12 * count + 12)));
});

test('a large file may decode to more', async () => {
  const json = documentOf(1, 1, () => 0, 2 ** 26); // 768 MiB
  await assert.rejects(unpackGlb(glbOf(json), standIn()), { code: 'Limit' });
  json.buffers[0].byteLength = 2 ** 20;
  await unpackGlb(glbOf(json), standIn());
});

test('counts that are none are refused', async () => {
  for (const count of ['x', -1, 1.5, null, 2 ** 53]) {
    const json = documentOf(1, 1, () => 0, count);
    await assert.rejects(unpackGlb(glbOf(json), standIn()), { code: 'Document' });
  }
});

test('a document without buffers is refused', async () => {
  const glb = glbOf(documentOf(1, 1, () => 0));
  for (const buffers of [undefined, [], [null]]) {
    const { json, chunks } = readGlb(glb);
    await assert.rejects(unpackGlb(writeGlb({ ...json, buffers }, chunks), standIn()), { code: 'Document' });
  }
});

test('a loader whose buffer is shorter than the document says decodes nothing', async () => {
  const { calls, decode } = standIn();
  const views = new PayloadViews(documentOf(1, 1, () => 0), async () => new Uint8Array(3), { decode });
  await assert.rejects(views.load(views.accessors[0].bufferView), { code: 'Document' });
  assert.equal(calls.length, 0);
});

test('glTF-Transform gets accessors that may be changed one by one, within the limits of a dependency', async () => {
  const glb = glbOf(documentOf(3, 1, () => 0));
  const read = async (maxDecodedBytes) => {
    const { calls, decodeSync } = standIn();
    const io = new NodeIO().registerExtensions([KHRMeshCollapseCompression])
      .registerDependencies({ 'mcc.decoder': { decodePayloadSync: decodeSync }, 'mcc.limits': { maxDecodedBytes } });
    const accessors = (await io.readBinary(glb)).getRoot().listAccessors();
    assert.equal(calls.length, 1);
    return accessors;
  };
  const bytes = 36 + 12 + 2 * (36 + 6); // of the payload, and of the copies
  const accessors = await read(bytes);
  assert.equal(new Set(accessors.map((accessor) => accessor.getArray())).size, 6);
  await assert.rejects(read(bytes - 1), { code: 'Limit' });
  await read(undefined);
});

// With time in proportion to the square of the number this would take half an hour.
test('twenty thousand payloads', async () => {
  const { calls, decode } = standIn();
  const { json } = readGlb(await unpackGlb(glbOf(documentOf(20_000, 20_000, (i) => i)), { decode }));
  assert.equal(calls.length, 20_000);
  assert.equal(json.bufferViews.length, 40_000);
});
