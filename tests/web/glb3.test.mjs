// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// GLB files of version 3 and the component types of the draft of glTF 2.1. The files are made here, byte by byte.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { componentBytes } from '../../lib/web/arguments.mjs';
import { namedBytes } from '../../lib/web/budget.mjs';
import { elementsOf, payloadsOf } from '../../lib/web/document.mjs';
import { decodeGlbBlocks, MccError, unpackGlb } from '../../lib/web/index.mjs';
import { readGlb, writeGlb } from '../../lib/web/unpack.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { BIN_TYPE, glb3Of, JSON_TYPE, jsonChunk } from './support/glb.mjs';

const MODEL = readAsset(manifest.assets.find(({ file }) => file.endsWith('_tetrahedron.glb')));
const PLAIN = await unpackGlb(MODEL);
const OTHER_TYPE = 0x45524f4d;

const other = { type: OTHER_TYPE, data: Uint8Array.of(1, 2, 3, 4) };

/** The model with its payload in a second buffer; `chunkOf` are the numbers of the chunks of both. */
function twoBuffers(chunkOf) {
  const { json, chunks: [{ data }] } = readGlb(MODEL);
  const [{ bufferView }] = payloadsOf(json);
  const view = json.bufferViews[bufferView];
  const payload = data.slice(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength);
  Object.assign(view, { buffer: 1, byteOffset: 0 });
  json.bufferViews.push({ buffer: 0, byteOffset: 1, byteLength: 4 });
  json.images = [{ bufferView: json.bufferViews.length - 1, mimeType: 'image/png' }];
  json.buffers = [{ byteLength: 5, chunk: chunkOf[0] }, { byteLength: payload.length, chunk: chunkOf[1] }];
  return { json, first: { type: BIN_TYPE, data: Uint8Array.of(9, 8, 7, 6, 5) }, second: { type: BIN_TYPE, data: payload } };
}

const orders = {
  'the document first': ({ json, first, second }) => [jsonChunk(json), other, first, second],
  'the document in the middle': ({ json, first, second }) => [second, other, jsonChunk(json), first],
  'the document last': ({ json, first, second }) => [first, second, other, jsonChunk(json), jsonChunk([])],
};
const numbers = { 'the document first': [2, 3], 'the document in the middle': [3, 0], 'the document last': [0, 1] };

for (const [name, order] of Object.entries(orders)) {
  test(`buffers in several chunks, ${name}`, async () => {
    const { json, chunks } = readGlb(await unpackGlb(glb3Of(order(twoBuffers(numbers[name])))));
    const plain = readGlb(PLAIN);
    assert.equal(json.buffers.length, 1);
    assert.equal(json.buffers[0].chunk, undefined);
    const bytesOf = ({ json: { accessors, bufferViews }, chunks: [{ data }] }, number) => {
      const { byteOffset = 0, byteLength } = bufferViews[accessors[number].bufferView];
      return data.subarray(byteOffset, byteOffset + byteLength);
    };
    plain.json.accessors.forEach((_, i) => assert.deepEqual(bytesOf({ json, chunks }, i), bytesOf(plain, i)));
    const { byteOffset, byteLength } = json.bufferViews[json.images[0].bufferView];
    assert.deepEqual([...chunks[0].data.subarray(byteOffset, byteOffset + byteLength)], [8, 7, 6, 5]);
    assert.deepEqual(chunks.slice(1), [other]);
  });
}

test('a buffer that names no chunk', async () => {
  const { json, chunks: [{ data }] } = readGlb(MODEL);
  const bin = { type: BIN_TYPE, data };
  assert.deepEqual(await unpackGlb(glb3Of([jsonChunk(json), bin])), PLAIN);
  await assert.rejects(unpackGlb(glb3Of([jsonChunk(json), other, bin])), /reaches beyond its buffer/);
  await assert.rejects(unpackGlb(glb3Of([bin, jsonChunk(json)])), /reaches beyond its buffer/);
});

test('version 3 is written on request', async () => {
  const wide = await unpackGlb(MODEL, { glbVersion: 3 });
  assert.equal(new DataView(wide.buffer).getUint32(4, true), 3);
  const { json, chunks: [{ data }] } = readGlb(PLAIN);
  const text = new TextEncoder().encode(JSON.stringify(json));
  const spaces = new Uint8Array(Math.ceil(text.length / 8) * 8).fill(0x20);
  spaces.set(text);
  const zeros = new Uint8Array(Math.ceil(json.buffers[0].byteLength / 8) * 8);
  zeros.set(data.subarray(0, json.buffers[0].byteLength));
  assert.deepEqual(wide, glb3Of([{ type: JSON_TYPE, data: spaces }, { type: BIN_TYPE, data: zeros }]));
  assert.deepEqual(await unpackGlb(MODEL, { glbVersion: 2 }), PLAIN);
  await assert.rejects(unpackGlb(MODEL, { glbVersion: 1 }), { code: 'BadArgument' });
});

test('what is wrong is refused', async () => {
  const { json, first, second } = twoBuffers([1, 2]);
  const good = [jsonChunk(json), first, second];
  const changed = (change) => {
    const copy = structuredClone(json);
    change(copy);
    return glb3Of([jsonChunk(copy), first, second, other]);
  };
  const patched = (at, ...words) => {
    const bytes = glb3Of(good);
    words.forEach((word, i) => new DataView(bytes.buffer).setUint32(at + 4 * i, word, true));
    return bytes;
  };
  for (const [bytes, what] of [
    [patched(4, 4), /^byte 4: only versions/],
    [patched(8, 0xffffffff, 0xffffffff), /^byte 8: /],
    [patched(12, 1), /^byte 8: /],
    [patched(20, 1), /^byte 20: the chunk is encoded/],
    [patched(24, 0xfffffff0, 0xffffffff), /^byte 16: .*past the end/],
    [patched(28, 1), /^byte 16: .*past the end/],
    [glb3Of([first]), /there is no JSON chunk/],
    [glb3Of([jsonChunk(json), first, { ...second, encoding: 7 }]), /the chunk is encoded/],
    [changed(({ buffers }) => { buffers[1].chunk = 3; }), /^\/buffers\/1\/chunk: chunk 3 is not a BIN chunk/],
    [changed(({ buffers }) => { buffers[1].chunk = 4; }), /^\/buffers\/1\/chunk/],
    [changed(({ buffers }) => { buffers[1].chunk = 0; }), /^\/buffers\/1\/chunk/],
    [changed(({ buffers }) => { buffers[1].chunk = '2'; }), /^\/buffers\/1\/chunk/],
    [changed(({ buffers }) => { buffers[1].chunk = 'length'; }), /^\/buffers\/1\/chunk/],
    [changed(({ buffers }) => { buffers[1].uri = 'a.bin'; }), /^\/buffers\/1\/chunk: the buffer has a URI/],
    [changed(({ buffers }) => { buffers[1].byteLength += 1000; }), /^\/buffers\/1\/byteLength/],
    [changed(({ buffers }) => { --buffers[1].byteLength; }), /reaches beyond its buffer/],
    [changed(({ buffers }) => { buffers[0] = { byteLength: 5, uri: 'a.bin' }; }), /^\/buffers\/0: /],
    [changed((document) => { document.buffers = 5; }), /./],
  ]) {
    await assert.rejects(unpackGlb(bytes), (error) => error instanceof MccError && what.test(error.message), String(what));
  }
  for (let length = 0; length < glb3Of(good).length - 8; ++length) {
    await assert.rejects(unpackGlb(glb3Of(good).subarray(0, length)), MccError, `${length} bytes`);
  }
});

test('payloads that are decoded while a GLB is loaded', async () => {
  const listOf = async (bytes) => {
    const list = [];
    for await (const { pieces, uses, ...block } of decodeGlbBlocks(bytes)) list.push(block);
    return list;
  };
  const expected = await listOf(MODEL);
  const { json, first, second } = twoBuffers([3, 1]);
  assert.deepEqual(await listOf(glb3Of([jsonChunk(json), second, other, first])), expected);
  const implicit = readGlb(MODEL);
  assert.deepEqual(await listOf(glb3Of([jsonChunk(implicit.json), { type: BIN_TYPE, data: implicit.chunks[0].data }])), expected);
  await assert.rejects(listOf(glb3Of([second, jsonChunk(json), other, first])), /the first chunk of a GLB must be its JSON/);
  await assert.rejects(listOf(glb3Of([jsonChunk(json), other, second, first])), /reaches beyond its buffer/);
  await assert.rejects(listOf(glb3Of([jsonChunk(json), { ...second, encoding: 1 }, other, first])), /the chunk is encoded/);
});

test('component types of glTF 2.1', () => {
  const sizes = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5124: 4, 5125: 4, 5126: 4, 5130: 8, 5131: 2, 5134: 8, 5135: 8 };
  for (const [type, size] of Object.entries(sizes)) {
    assert.equal(componentBytes(Number(type)), size);
    const attribute = { attribute: 0, accessor: { count: 10 }, componentType: Number(type), componentCount: 3 };
    assert.equal(namedBytes({ claims: [{ piece: 0, part: 0, indices: { count: 6 }, attributes: [attribute] }] }), 24 + 30 * size);
  }
});

test('signed ids of 32 bits are unsigned in payloads', () => {
  const { json } = readGlb(MODEL);
  const { primitives: [{ attributes, extensions }] } = json.meshes[0];
  const [extension] = Object.values(extensions);
  attributes._ID = json.accessors.length;
  extension.attributes._ID = 1;
  json.accessors.push({ componentType: 5124, type: 'SCALAR', count: json.accessors[attributes.POSITION].count });
  const [{ claims: [claim], targets }] = payloadsOf(json);
  assert.equal(claim.attributes.find(({ attribute }) => attribute === 1).componentType, 5125);
  const target = targets.find(({ attribute }) => attribute === 1);
  const array = Uint32Array.of(0xffffffff, 7);
  const elements = elementsOf({ pieces: [{ attributes: [undefined, { array }] }] }, target, json.accessors[target.accessor]);
  assert.deepEqual(elements, Int32Array.of(-1, 7));
  assert.equal(elements.buffer, array.buffer);
});

test('what does not fit in 4 GiB', () => {
  assert.throws(() => writeGlb({}, [{ type: BIN_TYPE, data: { length: 2 ** 32, parts: [] } }], 2), /4 GiB/);
});
