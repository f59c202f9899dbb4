// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The workers that make whole files without the extension, those of gltf-mcc/cesium: the same bytes as unpackTile(), the same errors.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { MccError, unpackGlb, unpackTile } from '../../lib/web/index.mjs';
import { readGlb, writeGlb } from '../../lib/web/unpack.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { withWorkers } from './support/node_workers.mjs';
import { convert, readSample } from './support/program.mjs';
import { b3dm, cmpt, i3dm, textBytes } from './support/tiles.mjs';

const TORUS = convert(readSample('torus'));
const MODELS = manifest.assets.map(readAsset);
const MANY = 60;

const made = [];
after(() => made.forEach((worker) => worker.terminate()));

/** Calls `work` with unpackAnywhere(), which looks for workers when it is loaded. */
const unpacking = (work) => withWorkers((worker) => made.push(worker), async () => {
  const { preload, unpackAnywhere } = await import('../../lib/web/tile_threads.mjs');
  await preload();
  await work(unpackAnywhere);
});

/** What workers have answered to files. */
const answersOf = () => made.flatMap(({ messages }) => messages).flatMap(({ answers }) => answers ?? []);

const failureOf = (promise) => promise.then(() => assert.fail('nothing was wrong'), (error) => error);

/** A copy with another byte at the end of its payload. */
function damagedOf(glb) {
  const copy = glb.slice();
  const { json, chunks: [{ data }] } = readGlb(copy);
  const { byteOffset = 0, byteLength } = json.bufferViews[json.meshes[0].primitives[0].extensions.KHR_mesh_collapse_compression.bufferView];
  data[byteOffset + byteLength - 1] ^= 1;
  return copy;
}

test('files of all kinds become what unpackTile() makes of them, many at a time', async () => {
  await unpacking(async (unpackAnywhere) => {
    const whole = convert(readSample('torus'), ['--lossless']); // takes more than the core
    const files = [...MODELS, TORUS, b3dm(TORUS, { tables: [textBytes('{"BATCH_LENGTH":0}')] }), whole, i3dm(whole), cmpt([b3dm(TORUS), i3dm(TORUS)]),
      cmpt(Array(MANY).fill(TORUS)), TORUS];
    const copies = files.map((file) => file.slice());
    const results = await Promise.all(files.map((file) => unpackAnywhere(file)));
    assert.equal(answersOf().filter(({ file }) => file !== undefined).length, files.filter((file, i) => results[i] !== file).length);
    for (const [i, file] of files.entries()) {
      assert.deepEqual(results[i], await unpackTile(file), `file ${i}`);
      assert.deepEqual(file, copies[i], 'the file is as it was');
    }
  });
});

test('files are sent at once, to the worker that has the fewest', async () => {
  const FILES = 12; // a multiple of the number of workers
  const workers = Math.max(1, Math.min(4, (globalThis.navigator?.hardwareConcurrency ?? 4) - 1));
  await unpacking(async (unpackAnywhere) => {
    const sent = made.map(() => 0);
    made.forEach((worker, i) => {
      worker.postMessage = (...args) => {
        ++sent[i];
        Object.getPrototypeOf(worker).postMessage.apply(worker, args);
      };
    });
    const all = Promise.all(Array(FILES).fill(TORUS).map((file) => unpackAnywhere(file)));
    await new Promise(setImmediate);
    assert.deepEqual(sent, Array(workers).fill(FILES / workers));
    await all;
    for (const worker of made) delete worker.postMessage;
  });
});

test('payloads of larger files are decoded on their own', async () => {
  const { json, chunks } = readGlb(TORUS);
  const large = writeGlb(json, [...chunks, { type: 0x4354584e, data: new Uint8Array(1 << 20) }]);
  await unpacking(async (unpackAnywhere) => {
    const count = answersOf().length;
    assert.deepEqual(await unpackAnywhere(large), await unpackTile(large));
    assert.equal(answersOf().length, count);
  });
});

test('what is damaged is refused for the same reason, and nothing else is', async () => {
  await unpacking(async (unpackAnywhere) => {
    const wrong = [damagedOf(TORUS), TORUS.subarray(0, TORUS.length - 4), b3dm(damagedOf(TORUS)), cmpt([TORUS, damagedOf(TORUS)])];
    const [good, ...errors] = await Promise.all([unpackAnywhere(TORUS), ...wrong.map((file) => failureOf(unpackAnywhere(file)))]);
    assert.deepEqual(good, await unpackTile(TORUS));
    for (const [i, error] of errors.entries()) {
      const { message, code } = await failureOf(unpackTile(wrong[i]));
      assert.ok(error instanceof MccError, error.stack);
      assert.deepEqual([error.message, error.code], [message, code]);
    }
  });
});

test('limits hold, and must be what can be sent to a worker', async () => {
  await unpacking(async (unpackAnywhere) => {
    assert.equal((await failureOf(unpackAnywhere(TORUS, { maxDecodedBytes: 1000 }))).code, 'Limit');
    assert.equal((await failureOf(unpackAnywhere(TORUS, { maxTriangles() {} }))).code, 'BadArgument');
    assert.deepEqual(await unpackAnywhere(TORUS, { maxDecodedBytes: 1e6 }), await unpackTile(TORUS));
  });
});

test('what is not ours stays as it is and is not sent; names may be spelt as JSON allows', async () => {
  await unpacking(async (unpackAnywhere) => {
    const sent = [];
    for (const worker of made) worker.postMessage = (message) => sent.push(message);
    const plain = await unpackGlb(TORUS);
    const named = writeGlb(readGlb(plain).json, [{ type: 0x004e4942, data: textBytes('KHR_mesh_collapse_compression') }]); // not in the JSON
    for (const file of [plain, named, b3dm(plain), textBytes('KHR_mesh_collapse_compression'), new Uint8Array(0), textBytes('glTF'), textBytes('b3dm\x01')]) {
      assert.equal(await unpackAnywhere(file), file);
    }
    assert.deepEqual(sent, []);
    for (const worker of made) delete worker.postMessage;
    const { json, chunks } = readGlb(TORUS);
    const text = JSON.stringify(json).replaceAll('KHR_mesh', 'KHR\\u005fmesh');
    const escaped = writeGlb({}, [{ type: 0x4e4f534a, data: textBytes(text.padEnd(Math.ceil(text.length / 4) * 4)) }, ...chunks]);
    const first = 12 + 8 + 4; // without the empty object
    const file = new Uint8Array([...escaped.subarray(0, 12), ...escaped.subarray(first)]);
    new DataView(file.buffer).setUint32(8, file.length, true);
    assert.deepEqual(await unpackAnywhere(file), await unpackTile(file));
    assert.notEqual((await unpackAnywhere(file)).length, file.length);
  });
});

test('without a worker that starts, files are decoded all the same', async () => {
  await unpacking(async (unpackAnywhere) => {
    let asked = 0;
    for (const worker of made) {
      worker.postMessage = () => {
        ++asked;
        setTimeout(() => worker.onerror({ message: 'it died' }));
      };
    }
    assert.deepEqual(await unpackAnywhere(TORUS), await unpackTile(TORUS));
    assert.equal(asked, 1);
    const count = made.length;
    assert.deepEqual(await unpackAnywhere(TORUS), await unpackTile(TORUS));
    assert.equal(made.length, count, 'and no other worker is tried');
  });
});
