// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Every promise settles, and only an MccError leaves the package, whatever is read: mutated documents, GLBs, tiles and options.
//
//     MCC_FUZZ=20000 MCC_FUZZ_SEED=1 node --test fuzz.test.mjs
//
// Seeds follow one another from the first one; what fails prints its own, which alone is run again by MCC_FUZZ=1.
import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { NodeIO } from '@gltf-transform/core';
import './support/peers.mjs';
import { encodeGlb, initEncoder } from '../../lib/web/encoder.mjs';
import { decodeBlocks, decodeGlbBlocks, decodePayload, decodePayloadSync, MccError, ready, unpackGlb, unpackTile } from '../../lib/web/index.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { unpackGltf } from '../../lib/web/unpack_gltf.mjs';
import { PayloadViews } from '../../lib/web/views.mjs';
import { blocksGlb } from './support/blocks.mjs';
import { manifest, payloadOf, readAsset } from './support/conformance.mjs';
import { glbOf } from './support/glb.mjs';
import { mutateBytes, mutateText, randomOf } from './support/mutations.mjs';
import { readSample } from './support/program.mjs';
import { b3dm, cmpt, i3dm } from './support/tiles.mjs';

const { KHRMeshCollapseCompression } = await import('../../lib/web/gltf-transform.mjs');

const COUNT = Number(process.env.MCC_FUZZ ?? 2000);
const FIRST = Number(process.env.MCC_FUZZ_SEED ?? Math.floor(Math.random() * 2 ** 31));
console.log(`seeds from ${FIRST}: MCC_FUZZ=${COUNT} MCC_FUZZ_SEED=${FIRST}`);

const limits = { maxDecodedBytes: 2 ** 24 };
await Promise.all([ready, initEncoder()]);

const rejections = [];
process.on('unhandledRejection', (reason) => rejections.push(reason));

/** Small assets of many kinds. */
const GLBS = manifest.assets.map(readAsset).filter(({ length }) => length < 4000).filter((_, i) => i % 3 === 0);
const FILES = GLBS.map((glb) => {
  const { json, chunks: [{ data }] } = readGlb(glb);
  return { glb, text: JSON.stringify(json), data };
});
const BLOCKS = blocksGlb('torus', 2000);
const pick = (list, random) => list[random(list.length)];

/** Runs `call` for `count` seeds. It is given random numbers and returns a promise. */
async function fuzz(count, call, isOurs = () => true) {
  let refused = 0;
  for (let seed = FIRST; seed < FIRST + count; ++seed) {
    try {
      await call(randomOf(seed));
    } catch (error) {
      ++refused;
      if (!isOurs(error)) continue;
      assert.ok(error instanceof MccError, `MCC_FUZZ=1 MCC_FUZZ_SEED=${seed}: ${error?.stack}`);
      assert.ok(error.message.length > 5 && typeof error.code === 'string', `MCC_FUZZ_SEED=${seed}: ${error.message}`);
    }
  }
  return refused;
}

async function drain(iterable) {
  let count = 0;
  for await (const _ of iterable) ++count;
  return count;
}

async function loadAll(json, data) {
  const fetchPayload = async (number) => {
    const { byteOffset = 0, byteLength } = json.bufferViews[number];
    return data.subarray(byteOffset, byteOffset + byteLength);
  };
  const views = new PayloadViews(json, fetchPayload, { decode: decodePayload, limits });
  for (const [number] of views.bufferViews.entries()) await views.load(number);
  const unpacked = unpackGltf(json, 'more.bin');
  if (unpacked !== undefined) await unpacked.decode(fetchPayload, { limits });
}

function someGlb(random) {
  const { text, data } = pick(FILES, random);
  return glbOf(mutateText(text, random), data);
}

describe('mutated', () => {
  test('documents: unpackGlb()', async () => {
    const refused = await fuzz(COUNT, (random) => unpackGlb(someGlb(random), { limits }));
    assert.ok(COUNT < 100 || (refused > COUNT / 10 && refused < COUNT), `${refused} of ${COUNT} were refused`);
  });

  test('documents: loaders with a hook, and .gltf', async () => {
    await fuzz(COUNT / 4, (random) => {
      const { text, data } = pick(FILES, random);
      return loadAll(JSON.parse(mutateText(text, random)), data);
    });
  });

  test('documents: decodeGlbBlocks()', async () => {
    await fuzz(COUNT / 10, (random) => drain(decodeGlbBlocks(someGlb(random), { limits })));
  });

  test('documents: unpackTile()', async () => {
    await fuzz(COUNT / 10, (random) => unpackTile(cmpt([b3dm(someGlb(random)), i3dm(someGlb(random))]), { limits }));
  });

  test('documents: the plugin for glTF-Transform', async () => {
    const io = new NodeIO().registerExtensions([KHRMeshCollapseCompression])
      .registerDependencies({ 'mcc.decoder': { decodePayloadSync }, 'mcc.limits': limits });
    // glTF-Transform itself throws errors of many kinds.
    const isOurs = ({ stack }) => /^\s+at .*\/lib\/web\//.test(String(stack).split('\n').find((line) => /^\s+at /.test(line)) ?? '');
    await fuzz(COUNT / 10, (random) => io.readBinary(someGlb(random)), isOurs);
  });

  test('GLBs: unpackGlb(), decodeGlbBlocks()', async () => {
    await fuzz(COUNT / 4, (random) => unpackGlb(mutateBytes(pick(GLBS, random), random), { limits }));
    await fuzz(COUNT / 20, (random) => drain(decodeGlbBlocks(mutateBytes(pick([...GLBS, BLOCKS], random), random), { limits })));
  });

  test('tiles: unpackTile()', async () => {
    await fuzz(COUNT / 4, (random) => {
      const [a, b] = [pick(GLBS, random), pick(GLBS, random)];
      return unpackTile(mutateBytes(pick([b3dm(a), i3dm(b), cmpt([b3dm(a), cmpt([i3dm(b), a])])], random), random), { limits });
    });
  });

  test('payloads: decodePayload(), decodeBlocks()', async () => {
    const payloads = GLBS.map(payloadOf);
    await fuzz(COUNT / 4, (random) => decodePayload(mutateBytes(pick(payloads, random), random), { limits: { maxOutputBytes: 2 ** 24 } }));
    const blocks = payloadOf(BLOCKS);
    await fuzz(COUNT / 50, (random) => drain(decodeBlocks(mutateBytes(blocks, random))));
  });

  test('sources: encodeGlb()', async () => {
    const sources = ['two_materials', 'morphed'].map(readSample).filter(({ length }) => length < 200_000).map((glb) => {
      const { json, chunks: [{ data }] } = readGlb(glb);
      return { glb, text: JSON.stringify(json), data };
    });
    sources.push(...FILES.slice(0, 3));
    await fuzz(COUNT / 200, (random) => {
      const { glb, text, data } = pick(sources, random);
      return encodeGlb(random(3) === 0 ? mutateBytes(glb, random) : glbOf(mutateText(text, random), data));
    });
  });
});

/** Anything that a caller may pass by mistake. */
const ANYTHING = [undefined, null, 0, -1, NaN, Infinity, 1e9, 2n, '', 'x', true, Symbol('s'), [], {}, () => {}, new Uint8Array(3), new ArrayBuffer(4),
  new DataView(new ArrayBuffer(4)), Object.create(null), new Map(), Promise.resolve(), { length: 4 }];
const OPTIONS = ['decode', 'limits', 'indexType', 'claims', 'order', 'signal', 'payloadBytes', 'decodeBlocks', 'transfer', 'onBlock', 'lossless',
  'positionBits', 'grid', 'maxPositionError', 'positionLattice', 'step', 'quality', 'prefer', 'fallback', 'meshoptDecoder', 'blockTriangles', 'constructor', 'toString', '__proto__'];
const LIMITS = ['maxVertices', 'maxTriangles', 'maxAttributes', 'maxPieces', 'maxElements', 'maxOutputBytes', 'maxDecodedBytes'];

test('arguments of all kinds', async () => {
  const [{ glb }] = FILES;
  const payload = payloadOf(glb);
  const set = (name, value) => Object.defineProperty({}, name, { value, enumerable: true });
  const options = [...ANYTHING, ...OPTIONS.flatMap((name) => ANYTHING.map((value) => set(name, value))),
    ...LIMITS.flatMap((name) => ANYTHING.map((value) => ({ limits: set(name, value) }))), ...ANYTHING.map((value) => ({ claims: [value] }))];
  const calls = [
    (bytes, more) => decodePayload(bytes ?? payload, more), async (bytes, more) => decodePayloadSync(bytes ?? payload, more),
    (bytes, more) => unpackGlb(bytes ?? glb, more), (bytes, more) => unpackTile(bytes ?? b3dm(glb), more),
    (bytes, more) => drain(decodeBlocks(bytes ?? payload, more)), (bytes, more) => drain(decodeGlbBlocks(bytes ?? glb, more)),
    (bytes, more) => encodeGlb(bytes ?? new Uint8Array(4), more),
  ];
  const assertOnlyOurs = async (call) => {
    try {
      await call();
    } catch (error) {
      assert.ok(error instanceof MccError, error?.stack);
    }
  };
  for (const call of calls) {
    for (const more of options) await assertOnlyOurs(() => call(undefined, more));
    for (const bytes of ANYTHING) await assertOnlyOurs(() => call(bytes ?? 'x', undefined));
  }
});

test('no rejection was left to nobody', async () => {
  await new Promise((resolve) => { setTimeout(resolve, 50); });
  assert.deepEqual(rejections, []);
});
