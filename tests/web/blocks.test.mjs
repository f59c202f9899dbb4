// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Payloads in blocks: one by one, while they are loaded, and glued by a pool.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { BlockDecoder } from '../../lib/web/block_decoder.mjs';
import { createDecoderPool, decodeBlocks, decodeGlbBlocks, decodePayload, init, MccError, unpackGlb } from '../../lib/web/index.mjs';
import { readAccessor, readGlb as readPlainGlb, trianglePrimitivesOf } from '../../samples/viewer/glb.mjs';
import { blocksGlb, blocksPayload, listOf, payloadsIn, streamOf, trianglesOf, trianglesOfBlocks } from './support/blocks.mjs';
import { DECODERS, manifest, payloadOf, readAsset, wasm } from './support/conformance.mjs';
import { decode } from './support/program.mjs';

const NAMES = ['torus', 'textured', 'shared_vertices', 'quantized', 'morphed'];
const payloads = new Map();
before(() => {
  for (const name of NAMES) payloads.set(name, blocksPayload(name));
});

const pools = [1, 2].map((workers) => createDecoderPool({ workers }));
after(() => pools.forEach((pool) => pool.dispose()));
const WAYS = { 'this thread': decodeBlocks, 'one worker': pools[0].decodeBlocks, 'two workers': pools[1].decodeBlocks };

async function tableOf(bytes) {
  const decoder = await BlockDecoder.make(await WebAssembly.compile(wasm('mcc_decoder')));
  return decoder.open(bytes, bytes.length);
}

/** Lists what is yielded before next() rejects. */
async function untilFailure(iterable) {
  const list = [];
  try {
    for await (const entry of iterable) list.push(entry);
  } catch (error) {
    return { list, error };
  }
  return assert.fail('nothing was wrong');
}

for (const [way, blocksOf] of Object.entries(WAYS)) {
  describe(way, () => {
    for (const name of NAMES) {
      test(`${name}: the blocks have the triangles of the piece`, async () => {
        const bytes = payloads.get(name);
        const { pieces: [piece] } = await decodePayload(bytes);
        const blocks = await listOf(blocksOf(bytes));
        assert.ok(blocks.length > 3, `${blocks.length} blocks`);
        assert.deepEqual(blocks.map(({ index }) => index), blocks.map((_, i) => i));
        assert.ok(blocks.every(({ blockCount, piece: number }) => blockCount === blocks.length && number === 0));
        assert.deepEqual(trianglesOfBlocks(blocks), trianglesOf(piece));
        assert.equal(blocks.reduce((sum, { wedgeCount, repeatedCount }) => sum + wedgeCount - repeatedCount, 0), piece.wedgeCount);
        blocks.forEach(checkBlock);
      });
    }

    test('from streams of any chunks', async () => {
      const bytes = payloads.get('textured');
      const expected = await listOf(decodeBlocks(bytes));
      for (const sizes of [[1], [7, 1, 113], [1000], [bytes.length]]) {
        assert.deepEqual(await listOf(blocksOf(streamOf(bytes, sizes), { payloadBytes: bytes.length })), expected, `chunks of ${sizes}`);
      }
      async function* twoHalves() {
        yield bytes.subarray(0, 500);
        yield bytes.subarray(500).slice().buffer;
      }
      assert.deepEqual(await listOf(blocksOf(twoHalves(), { payloadBytes: bytes.length })), expected);
      assert.deepEqual(await listOf(blocksOf(bytes.slice().buffer)), expected);
    });

    test('the first block is there before the last byte is', async () => {
      const bytes = payloads.get('torus');
      const { blocks } = await tableOf(bytes);
      const end = blocks[1].offset + blocks[1].bytes;
      let go;
      const later = new Promise((resolve) => { go = resolve; });
      async function* slowly() {
        yield bytes.subarray(0, end);
        await later;
        yield bytes.subarray(end);
      }
      const iterator = blocksOf(slowly(), { payloadBytes: bytes.length });
      assert.equal((await iterator.next()).value.index, 0);
      assert.equal((await iterator.next()).value.index, 1);
      go();
      assert.equal((await listOf(iterator)).length, blocks.length - 2);
    });

    test('in any order', async () => {
      const bytes = payloads.get('torus');
      const found = await listOf(blocksOf(bytes, { order: 'any' }));
      assert.deepEqual(found.sort((a, b) => a.index - b.index), await listOf(decodeBlocks(bytes)));
    });

    test('blocks before a damaged one are yielded', async () => {
      const damaged = payloads.get('torus').slice();
      const { blocks } = await tableOf(damaged);
      damaged[blocks[3].offset + (blocks[3].bytes >> 1)] ^= 4;
      for (const source of [damaged, streamOf(damaged, [97])]) {
        const { list, error } = await untilFailure(blocksOf(source, { payloadBytes: damaged.length }));
        assert.ok(error instanceof MccError, error.stack);
        assert.equal(error.code, 'BadChecksum');
        assert.deepEqual(list.map(({ index }) => index), [0, 1, 2]);
      }
      const first = payloads.get('torus').slice();
      first[blocks[0].offset] ^= 4;
      assert.equal((await untilFailure(blocksOf(first))).error.code, 'BadChecksum');
      const header = payloads.get('torus').slice();
      header[blocks[0].offset - 2] ^= 4;
      assert.equal((await untilFailure(blocksOf(header))).error.code, 'BadChecksum');
      assert.equal((await listOf(blocksOf(payloads.get('torus')))).length, blocks.length, 'and then it decodes others');
    });

    test('a source that ends too early', async () => {
      const bytes = payloads.get('torus');
      const { blocks } = await tableOf(bytes);
      for (const end of [0, 3, 20, blocks[0].offset - 1, blocks[0].offset, blocks[2].offset + 1, bytes.length - 1]) {
        const { list, error } = await untilFailure(blocksOf(streamOf(bytes.subarray(0, end), [50]), { payloadBytes: bytes.length }));
        assert.equal(error.code, 'Truncated', `${end} bytes: ${error.message}`);
        assert.equal(list.length, blocks.filter((block) => block.offset + block.bytes <= end).length);
      }
    });

    test('ending the iteration, or a signal', async () => {
      const bytes = payloads.get('torus');
      const state = {};
      for await (const { index } of blocksOf(streamOf(bytes, [400], state), { payloadBytes: bytes.length })) if (index === 1) break;
      await new Promise((resolve) => setTimeout(resolve, 20));
      assert.equal(state.cancelled, true);
      const controller = new AbortController();
      const reason = new Error('enough');
      const never = async function* never() {
        yield bytes.subarray(0, 2000);
        await new Promise(() => {});
      };
      const { list, error } = await untilFailure((async function* watched() {
        for await (const block of blocksOf(never(), { payloadBytes: bytes.length, signal: controller.signal })) {
          yield block;
          setTimeout(() => controller.abort(reason), 20);
        }
      })());
      assert.equal(error, reason);
      assert.ok(list.length > 0);
      assert.equal((await untilFailure(blocksOf(bytes, { signal: AbortSignal.abort(reason) }))).error, reason);
      assert.ok((await listOf(blocksOf(bytes))).length > 3, 'and then it decodes others');
    });

    test('a payload without blocks is one block', async () => {
      const bytes = payloadOf(readAsset(manifest.assets.find(({ file }) => file.endsWith('_tetrahedron.glb'))));
      const { pieces } = await decodePayload(bytes);
      for (const source of [bytes, streamOf(bytes, [11])]) {
        const blocks = await listOf(blocksOf(source, { payloadBytes: bytes.length }));
        assert.equal(blocks.length, pieces.length);
        assert.deepEqual(blocks.map(({ attributes, parts, wedgeCount }) => ({ attributes, parts, wedgeCount })),
          pieces.map(({ attributes, parts, wedgeCount }) => ({ attributes, parts, wedgeCount })));
        blocks.forEach(checkBlock);
      }
    });

    test('options', async () => {
      const bytes = payloads.get('torus');
      const [{ parts: [{ indices }] }] = await listOf(blocksOf(bytes, { indexType: 'uint32' }));
      assert.ok(indices instanceof Uint32Array);
      const wrong = { order: 'size', indexType: 'uint8', payloadBytes: bytes.length - 1 };
      for (const [name, value] of Object.entries(wrong)) {
        assert.equal((await untilFailure(blocksOf(bytes, { [name]: value }))).error.code, 'BadArgument', name);
      }
      assert.equal((await untilFailure(blocksOf(streamOf(bytes, [10])))).error.code, 'BadArgument', 'a stream without a size');
      assert.equal((await untilFailure(blocksOf('bytes', { payloadBytes: 5 }))).error.code, 'BadArgument');
      assert.equal((await untilFailure(blocksOf((async function* texts() { yield 'K'; })(), { payloadBytes: 5 }))).error.code, 'BadArgument');
      for (const limits of [{ maxTriangles: 100 }, { maxVertices: 100 }, { maxOutputBytes: 100 }]) {
        assert.equal((await untilFailure(blocksOf(bytes, { limits }))).error.code, 'Limit');
      }
      const [{ claims }] = payloadsIn(blocksGlb('torus'));
      assert.ok((await listOf(blocksOf(bytes, { claims }))).length > 3);
      claims[0].indices.count -= 3;
      assert.equal((await untilFailure(blocksOf(bytes, { claims }))).error.code, 'Document');
    });
  });
}

function checkBlock({ wedgeCount, triangleCount, box, attributes, parts }) {
  for (const { array, componentCount } of attributes) assert.equal(array.length, wedgeCount * componentCount);
  assert.equal(parts.reduce((sum, part) => sum + part.triangleCount, 0), triangleCount);
  for (const part of parts) {
    assert.equal(part.indices.length, 3 * part.triangleCount);
    assert.ok(part.indices.every((index) => index < wedgeCount));
  }
  for (let axis = 0; axis < 3; ++axis) {
    const values = attributes[0].array.filter((_, i) => i % 3 === axis);
    assert.deepEqual([box.min[axis], box.max[axis]], [Math.min(...values), Math.max(...values)]);
  }
}

describe('a pool glues blocks', () => {
  for (const name of NAMES) {
    test(name, async () => {
      const bytes = payloads.get(name);
      for (const indexType of ['auto', 'uint32']) {
        const expected = await decodePayload(bytes, { indexType });
        for (const pool of pools) {
          const seen = [];
          assert.deepEqual(await pool.decodePayload(bytes, { indexType, onBlock: ({ index }) => seen.push(index) }), expected);
          assert.deepEqual(seen, seen.map((_, i) => i));
          assert.ok(seen.length > 3);
          assert.deepEqual(await pool.decodePayload(bytes, { indexType }), expected);
        }
      }
    });
  }

  test('several payloads at a time, among others without blocks', async () => {
    const list = [...payloads.values(), payloadOf(readAsset(manifest.assets[5])), ...payloads.values()];
    const expected = await Promise.all(list.map((bytes) => decodePayload(bytes)));
    assert.deepEqual(await Promise.all(list.map((bytes) => pools[1].decodePayload(bytes))), expected);
  });

  test('a damaged block, and an application that fails', async () => {
    const damaged = payloads.get('torus').slice();
    damaged[damaged.length - 5] ^= 1;
    await assert.rejects(pools[1].decodePayload(damaged), { code: 'BadChecksum' });
    await assert.rejects(pools[1].decodePayload(payloads.get('torus'), { onBlock() { throw new Error('mine'); } }), /mine/);
    await assert.rejects(pools[1].decodePayload(payloads.get('torus'), { limits: { maxTriangles: 5 } }), { code: 'Limit' });
    await pools[1].decodePayload(payloads.get('torus'));
  });

  test('the conformance assets', async () => {
    for (const asset of manifest.assets) {
      const glb = readAsset(asset);
      assert.deepEqual(await unpackGlb(glb, { decode: pools[1].decodePayload }), await unpackGlb(glb), asset.file);
    }
  });

  test('a pool that is disposed of', async () => {
    const pool = createDecoderPool({ workers: 2 });
    const decoding = pool.decodePayload(payloads.get('torus'));
    const iterating = listOf(pool.decodeBlocks(payloads.get('torus')));
    pool.dispose();
    await assert.rejects(decoding, { code: 'Disposed' });
    await assert.rejects(iterating, { code: 'Disposed' });
  });

  test('the core alone refuses blocks', async (t) => {
    const pool = createDecoderPool({ workers: 2, bytes: wasm('mcc_decoder_core') });
    t.after(() => pool.dispose());
    await assert.rejects(pool.decodePayload(payloads.get('torus')), { code: 'NotInCore' });
    await assert.rejects(listOf(pool.decodeBlocks(payloads.get('torus'))), { code: 'NotInCore' });
  });
});

for (const name of ['mcc_decoder', 'mcc_decoder_simd']) {
  test(`${name} decodes as the program does`, async (t) => {
    await init(DECODERS[name]);
    t.after(() => init());
    for (const sample of NAMES) {
      const glb = blocksGlb(sample);
      const [ours, theirs] = [await unpackGlb(glb), decode(glb)].map((bytes) => readPlainGlb(bytes));
      const primitives = trianglePrimitivesOf(theirs.json);
      trianglePrimitivesOf(ours.json).forEach(({ definition: { indices, attributes } }, i) => {
        const expected = primitives[i].definition;
        assert.deepEqual(readAccessor(ours, indices), readAccessor(theirs, expected.indices));
        for (const [attribute, accessor] of Object.entries(attributes)) {
          assert.deepEqual(readAccessor(ours, accessor), readAccessor(theirs, expected.attributes[attribute]), attribute);
        }
      });
    }
  });
}

describe('decodeGlbBlocks()', () => {
  test('yields the blocks of all payloads while the file is loaded', async () => {
    for (const sample of NAMES) {
      const glb = blocksGlb(sample);
      const expected = payloadsIn(glb);
      for (const source of [glb, streamOf(glb, [3, 4099, 20])]) {
        const blocks = await listOf(decodeGlbBlocks(source, { decodeBlocks: pools[1].decodeBlocks }));
        for (const { bufferView, bytes } of expected) {
          const own = blocks.filter((block) => block.bufferView === bufferView);
          const plain = own.map(({ uses, bufferView: _, ...block }) => block);
          assert.deepEqual(plain, await listOf(decodeBlocks(bytes)));
          assert.ok(own.every(({ uses }) => uses.length > 0 && uses[0].attributes.POSITION === 0));
        }
      }
    }
  });

  test('errors', async () => {
    const glb = blocksGlb('torus');
    const codeOf = async (source, options) => (await untilFailure(decodeGlbBlocks(source, options))).error.code;
    const { error } = await untilFailure(decodeGlbBlocks(null));
    assert.match(`${error.code}: ${error.message}`, /^BadArgument: the source is null: the response has no body$/);
    for (const end of [0, 5, 19, 100]) assert.equal(await codeOf(streamOf(glb.subarray(0, end), [30])), 'Document');
    assert.equal(await codeOf(glb.slice(0, -200)), 'Truncated');
    assert.equal(await codeOf(glb, { limits: { maxDecodedBytes: 1000 } }), 'Limit');
    assert.equal(await codeOf(glb, { limits: { maxTriangles: 1000 } }), 'Limit');
  });
});
