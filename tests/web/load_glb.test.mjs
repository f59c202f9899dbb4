// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// loadGlb(): previews and blocks while a file is on its way, from streams that are cut anywhere, damaged or aborted.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { decodeBlocks, decodeGlbBlocks, EXTENSION_NAME, loadGlb, unpackGlb } from '../../lib/web/index.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { blocksGlb, listOf, payloadsIn, streamOf } from './support/blocks.mjs';
import { binOf, withPreview } from './support/previews.mjs';
import { convert, readSample } from './support/program.mjs';

const here = { decodeBlocks };
let glb;
let preview; // its payload
let binAt; // where the BIN chunk's bytes begin

before(() => {
  // Samples are too small for previews, so that of another one serves: both have only positions and normals.
  preview = payloadsIn(convert(readSample('torus')))[0].bytes;
  glb = withPreview(blocksGlb('torus'), preview);
  binAt = binOf(glb);
});

/** What loadGlb() tells, in its order. */
async function toldBy(source, options = {}) {
  const told = [];
  const tell = (kind) => ({ bufferView, uses, isPreview, ...block }) => told.push({ kind, uses, block });
  const bytes = await loadGlb(source, { ...here, onPreview: tell('preview'), onBlock: tell('block'), ...options });
  return { told, bytes };
}

test('the preview comes first, then the blocks, then the file', async () => {
  const { told, bytes } = await toldBy(glb);
  assert.deepEqual(bytes, glb);
  let document;
  await loadGlb(glb, { onDocument: (json) => { document = json; } });
  assert.deepEqual(document, (await readGlb(glb)).json);
  const blocks = await listOf(decodeBlocks(payloadsIn(glb)[0].bytes));
  assert.deepEqual(told.map(({ kind }) => kind), ['preview', ...blocks.map(() => 'block')]);
  assert.deepEqual(told.slice(1).map(({ block }) => block), blocks);
  assert.deepEqual([told[0].block], await listOf(decodeBlocks(preview)));
  const { mesh, primitive, part, attributes } = told[0].uses[0];
  assert.deepEqual({ mesh, primitive, part, attributes }, { mesh: 0, primitive: 0, part: 0, attributes: told[1].uses[0].attributes });
});

test('streams may be cut anywhere', async () => {
  const { told: expected } = await toldBy(glb);
  for (const sizes of [[1], [7, 1, 113], [binAt, 1], [binAt + preview.length - 1, 1], [4096], [glb.length]]) {
    const { told, bytes } = await toldBy(streamOf(glb, sizes));
    assert.deepEqual(told, expected, `chunks of ${sizes}`);
    assert.deepEqual(bytes, glb);
  }
});

test('the preview is told of before the rest is there', async () => {
  let release;
  const rest = new Promise((resolve) => { release = resolve; });
  async function* slowly() {
    yield glb.subarray(0, binAt + preview.length);
    await rest;
    yield glb.subarray(binAt + preview.length);
  }
  let whole;
  await new Promise((resolve, reject) => {
    whole = loadGlb(slowly(), { ...here, onPreview: resolve });
    whole.catch(reject);
  });
  release();
  assert.deepEqual(await whole, glb);
});

test('in workers of the page, by default', async () => {
  const { told } = await toldBy(glb, { decodeBlocks: undefined });
  assert.deepEqual(told, (await toldBy(glb)).told);
});

test('nothing is decoded that nobody asks for', async () => {
  const none = { decodeBlocks: () => assert.fail('decodes') };
  assert.deepEqual(await loadGlb(streamOf(glb, [100]), none), glb);
  const { told } = await toldBy(glb, { onBlock: undefined });
  assert.deepEqual(told.map(({ kind }) => kind), ['preview']);
  assert.ok((await toldBy(glb, { onPreview: undefined })).told.every(({ kind }) => kind === 'block'));
});

test('other loaders ignore previews, also damaged ones', async () => {
  const damaged = glb.slice();
  damaged[binAt + 9] ^= 0x55;
  for (const file of [glb, damaged]) {
    assert.ok((await listOf(decodeGlbBlocks(file, here))).every(({ isPreview }) => isPreview === undefined));
    assert.equal((await readGlb(await unpackGlb(file))).json.extensionsRequired, undefined);
  }
});

test('damaged previews are refused', async () => {
  for (const at of [0, 1, 9, preview.length >> 1, preview.length - 1]) {
    const damaged = glb.slice();
    damaged[binAt + at] ^= 0x55;
    const told = [];
    await assert.rejects(loadGlb(streamOf(damaged, [500]), { ...here, onPreview: (block) => told.push(block) }),
      ({ name, message }) => name === 'MccError' && message.startsWith('/bufferViews/') && !message.includes('\n'), `byte ${at}`);
    assert.equal(told.length, 0);
  }
  const path = `/meshes/0/primitives/0/extensions/${EXTENSION_NAME}/preview`;
  const refuses = (change, message) => assert.rejects(
    loadGlb(withPreview(blocksGlb('torus'), preview, change), { ...here, onPreview() {} }), { name: 'MccError', message });
  await refuses((object) => { object.bufferView = 99; }, `${path}/bufferView: there is no bufferView 99`);
  await refuses((object) => { delete object.bufferView; }, `${path}/bufferView: must be a non-negative integer`);
  await refuses((object) => { object.piece = 1; }, `${path}/piece: there is no piece 1 in the preview`);
  await refuses((object) => { object.part = 7; }, `${path}/part: there is no part 7 in the preview`);
  await refuses((object, json) => { json.meshes[0].primitives[0].extensions[EXTENSION_NAME].preview = 7; }, `${path}: must be an object`);
});

test('a preview of other attributes is refused', async () => {
  const other = payloadsIn(convert(readSample('torus'), ['--indices-only']))[0].bytes;
  await assert.rejects(loadGlb(withPreview(blocksGlb('torus'), other), { ...here, onPreview() {} }), { name: 'MccError', message: /attribute 0 has another/ });
});

test('limits hold for previews', async () => {
  await assert.rejects(toldBy(glb, { limits: { maxDecodedBytes: 1000 }, onBlock: undefined }), { code: 'Limit' });
});

test('a load can be aborted anywhere', async () => {
  for (const stop of [1, 25, binAt, binAt + 100, binAt + preview.length + 10, glb.length - 1]) {
    const controller = new AbortController();
    const state = {};
    let at = 0;
    const source = new ReadableStream({
      pull(stream) {
        if (at < stop) {
          stream.enqueue(glb.slice(at, (at = stop)));
        } else {
          setTimeout(() => controller.abort(new Error('enough')), 5);
          return new Promise(() => {}); // nothing more will come
        }
      },
      cancel() {
        state.cancelled = true;
      },
    }, { highWaterMark: 0 });
    await assert.rejects(toldBy(source, { signal: controller.signal }), { message: 'enough' }, `after ${stop} bytes`);
    await new Promise((resolve) => { setTimeout(resolve, 5); });
    assert.ok(state.cancelled, `the source is told after ${stop} bytes`);
  }
  await assert.rejects(loadGlb(glb, { signal: AbortSignal.abort(new Error('never')) }), { message: 'never' });
});

test('what throws ends the load', async () => {
  const state = {};
  await assert.rejects(loadGlb(streamOf(glb, [100], state), { ...here, onPreview: () => { throw new Error('mine'); } }), { message: 'mine' });
  await new Promise((resolve) => { setTimeout(resolve, 5); });
  assert.ok(state.cancelled);
});

test('wrong arguments', async () => {
  await assert.rejects(loadGlb(null), { code: 'BadArgument' });
  await assert.rejects(loadGlb(glb, { onPreview: 7 }), { code: 'BadArgument' });
  await assert.rejects(loadGlb(glb.slice(0, 30), { ...here, onPreview() {} }), { name: 'MccError' });
});
