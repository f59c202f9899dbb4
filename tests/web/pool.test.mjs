// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A pool of workers settles every promise, by an MccError or a result, whatever it is given and whatever happens to its workers.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { createDecoderPool, decodePayload, MccError } from '../../lib/web/index.mjs';
import { pace } from '../../lib/web/pace.mjs';
import { blocksPayload } from './support/blocks.mjs';
import { manifest, payloadOf, readAsset } from './support/conformance.mjs';
import { withWorkers } from './support/node_workers.mjs';
import { convert, readSample } from './support/program.mjs';

const payload = () => payloadOf(readAsset(manifest.assets.find(({ file }) => file.endsWith('_tetrahedron.glb'))));
const expected = await decodePayload(payload());

const rejections = [];
process.on('unhandledRejection', (reason) => rejections.push(reason));

const pool = createDecoderPool({ workers: 1 });
after(() => pool.dispose());

/** A promise that settles within a time for which no machine is too slow. */
function settled(promise) {
  let timer;
  const late = new Promise((_, reject) => { timer = setTimeout(() => reject(new Error('it never settles')), 60_000); });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

async function assertRefused(promise, codes, name) {
  const error = await settled(promise).then(() => assert.fail(`${name} is accepted`), (reason) => reason);
  assert.ok(error instanceof MccError, `${name}: ${error?.stack}`);
  assert.ok(codes.includes(error.code), `${name}: ${error.code}, ${error.message}`);
  assert.doesNotMatch(error.message, /\n/);
}

test('what cannot be sent to a worker rejects its promise alone, and the worker goes on', async () => {
  const detached = payload();
  structuredClone(detached, { transfer: [detached.buffer] });
  const memory = new WebAssembly.Memory({ initial: 1 });
  const wrong = {
    'an ArrayBuffer': [payload().buffer],
    'an array': [[...payload()]],
    'a text': ['payload'],
    'nothing': [],
    'null': [null],
    'words': [new Uint16Array(8)],
    'a limit that is a function': [payload(), { limits: { maxVertices() {} } }],
    'a limit that is a text': [payload(), { limits: { maxVertices: '5' } }],
    'claims that are functions': [payload(), { claims: [() => {}] }],
    'claims that are none': [payload(), { claims: 5 }],
    'an index type that is a symbol': [payload(), { indexType: Symbol('uint16') }],
    'a listener that is none': [payload(), { onBlock: 5 }],
    'bytes that were moved away': [detached],
    'memory that cannot be moved': [new Uint8Array(memory.buffer), { transfer: true }],
  };
  for (const [name, args] of Object.entries(wrong)) {
    // Engines copy such memory, or refuse to move it.
    const codes = { 'claims that are none': ['Trap'], 'memory that cannot be moved': ['BadMagic', 'BadArgument'] }[name] ?? ['BadArgument'];
    await assertRefused(pool.decodePayload(...args), codes, name);
    assert.deepEqual(await settled(pool.decodePayload(payload())), expected, `after ${name}`);
  }
});

test('options may be null, and hold what does not concern the worker', async () => {
  assert.deepEqual(await settled(pool.decodePayload(payload(), null)), expected);
  assert.deepEqual(await settled(pool.decodePayload(payload(), { signal: () => {} })), expected);
});

test('the same bytes are moved once; who comes second hears of it', async () => {
  const bytes = payload();
  const [first, second] = await settled(Promise.allSettled([1, 2].map(() => pool.decodePayload(bytes, { transfer: true }))));
  assert.deepEqual(first.value, expected);
  assert.ok(second.reason instanceof MccError, second.reason?.stack);
  assert.equal(second.reason.code, 'BadArgument');
});

test('shared memory and Buffers are copied, and stay as they are', async () => {
  const bytes = payload();
  const shared = new Uint8Array(new SharedArrayBuffer(bytes.length));
  shared.set(bytes);
  const part = Buffer.from(new ArrayBuffer(bytes.length + 16), 8, bytes.length); // whose slice() is no copy
  part.set(bytes);
  for (const source of [shared, Buffer.from(bytes), part]) {
    for (const transfer of [false, true]) assert.deepEqual(await settled(pool.decodePayload(source, { transfer })), expected);
    assert.deepEqual(Uint8Array.from(source), bytes);
  }
  const blocks = blocksPayload('torus');
  const own = Buffer.from(new Uint8Array(blocks).buffer);
  const list = [];
  for await (const { index } of pool.decodeBlocks(own)) list.push(index);
  assert.ok(list.length > 3);
  assert.deepEqual(Uint8Array.from(own), blocks);
});

test('numbers of workers that make no sense are refused at once', () => {
  for (const workers of [0, -1, 1.5, NaN, Infinity, 1e9, '2', null, {}, Symbol('two'), 2n]) {
    assert.throws(() => createDecoderPool({ workers }), (error) => error instanceof MccError && error.code === 'BadArgument', String(workers));
  }
  for (const options of [undefined, null, {}, { workers: undefined }]) createDecoderPool(options).dispose();
});

test('modules that are none reject what is decoded with them', async () => {
  const wrong = [{ module: 5 }, { module: () => {} }, { bytes: new Uint8Array(8) }, { bytes: 'x' }, { wasmUrl: Symbol('url') },
    { wasmUrl: 'http://[' }, { coreUrl: 5 }];
  for (const where of wrong) {
    const other = createDecoderPool({ workers: 1, ...where });
    for (let i = 0; i < 2; ++i) {
      const error = await settled(other.decodePayload(payload())).catch((reason) => reason);
      assert.ok(error instanceof MccError && ['Load', 'Trap'].includes(error.code), `${Object.keys(where)}: ${error?.stack}`);
    }
    other.dispose();
  }
});

test('a whole decoder that cannot be loaded rejects what needs it, each time, and nothing else', async () => {
  const coreUrl = new URL('../../lib/web/wasm/mcc_decoder_core.wasm', import.meta.url);
  const whole = payloadOf(convert(readSample('torus'), ['--lossless']));
  const made = [];
  await withWorkers((worker) => made.push(worker), async () => {
    const other = createDecoderPool({ workers: 1, coreUrl, wasmUrl: new URL('nowhere.wasm', import.meta.url) });
    for (let i = 1; i <= 2; ++i) {
      await assertRefused(other.decodePayload(whole), ['Load'], 'what needs more than the core');
      assert.deepEqual(await settled(other.decodePayload(payload())), expected);
      assert.equal(made[0].messages.filter(({ needsWhole }) => needsWhole).length, i, 'it is asked for again');
    }
    assert.equal(made.length, 1);
    other.dispose();
  });
});

test('a worker of a browser that fails settles its promise and is replaced', async () => {
  const made = [];
  await withWorkers((worker) => made.push(worker), async () => {
    const other = createDecoderPool({ workers: 1 });
    assert.deepEqual(await settled(other.decodePayload(payload())), expected);
    for (const [event, error] of [['onerror', { message: 'it died' }], ['onmessageerror', {}]]) {
      const worker = made.at(-1);
      worker.postMessage = () => setTimeout(() => worker[event](error));
      const [lost, next] = await settled(Promise.allSettled([other.decodePayload(payload()), other.decodePayload(payload())]));
      assert.ok(lost.reason instanceof MccError && lost.reason.code === 'Load', lost.reason?.stack);
      assert.deepEqual(next.value, expected);
      worker[event](error); // comes too late to be about the one in its place
      assert.deepEqual(await settled(other.decodePayload(payload())), expected);
    }
    assert.equal(made.length, 3);
    other.dispose();
  });
});

test('a worker that was busy gets the small payloads that have come meanwhile in one message, and each has its own result', async () => {
  pace.learn(2 ** 40, 0); // so that all payloads are small, however slow this machine is
  const made = [];
  const counts = [];
  await withWorkers((worker) => made.push(worker), async () => {
    const other = createDecoderPool({ workers: 1 });
    assert.deepEqual(await settled(other.decodePayload(payload())), expected);
    const [worker] = made;
    const { postMessage } = worker;
    worker.postMessage = function post(message, moved) {
      if (message.jobs !== undefined) counts.push(message.jobs.length);
      postMessage.call(worker, message, moved);
    };
    const damaged = payload();
    damaged[damaged.length - 1] ^= 1;
    const whole = payloadOf(convert(readSample('torus'), ['--lossless']));
    const [first, second, third, fourth] = await settled(Promise.allSettled([payload(), damaged, whole, payload()].map((bytes) => other.decodePayload(bytes))));
    assert.deepEqual([first.value, fourth.value], [expected, expected]);
    assert.equal(second.reason.code, 'BadChecksum');
    assert.ok(third.value.pieces[0].wedgeCount > 0, 'by the whole decoder');
    assert.deepEqual(counts, [1, 3]);
    counts.length = 0;
    const [, wrong, right] = await settled(Promise.allSettled([{}, { claims: [() => {}] }, {}].map((options) => other.decodePayload(payload(), options))));
    assert.equal(wrong.reason.code, 'BadArgument');
    assert.deepEqual(right.value, expected);
    other.dispose();
  });
});

test('a page that forbids workers', async () => {
  const { Worker } = globalThis;
  globalThis.Worker = class { constructor() { throw new Error('forbidden'); } };
  const other = createDecoderPool({ workers: 2 });
  const results = await settled(Promise.allSettled([1, 2, 3].map(() => other.decodePayload(payload()))));
  globalThis.Worker = Worker;
  for (const { reason } of results) assert.ok(reason instanceof MccError && reason.code === 'Load' && /forbidden/.test(reason.message), reason?.stack);
  assert.deepEqual(await settled(other.decodePayload(payload())), expected, 'and later they are allowed');
  other.dispose();
});

test('a worker of Node that ends settles its promise and is replaced', async () => {
  const { syncBuiltinESMExports, createRequire } = await import('node:module');
  const threads = createRequire(import.meta.url)('node:worker_threads');
  const made = [];
  const { Worker } = threads;
  threads.Worker = class extends Worker {
    constructor(...args) {
      super(...args);
      made.push(this);
    }
  };
  syncBuiltinESMExports();
  const other = createDecoderPool({ workers: 1 });
  try {
    assert.deepEqual(await settled(other.decodePayload(payload())), expected);
    const [worker] = made;
    worker.postMessage = () => {}; // it never answers
    const lost = other.decodePayload(payload());
    const next = other.decodePayload(payload());
    setTimeout(() => worker.terminate(), 20);
    await assertRefused(lost, ['Load'], 'a worker that ends');
    assert.deepEqual(await settled(next), expected);
    assert.equal(made.length, 2);
  } finally {
    threads.Worker = Worker;
    syncBuiltinESMExports();
    other.dispose();
  }
});

test('no rejection was left to nobody', async () => {
  await new Promise((resolve) => { setTimeout(resolve, 50); });
  assert.deepEqual(rejections, []);
});
