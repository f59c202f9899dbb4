// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Workers that decode.
import { checkBytes, checkIndexType, claimsBlocks } from './arguments.mjs';
import { asMccError, MccError, requireArgument } from './error.mjs';
import { importOfNode } from './node.mjs';
import { pageSource, Source } from './source.mjs';

const MOST_WORKERS = 1024;

/**
 * Creates a pool that decodes several payloads at a time, in workers.
 * @param {import('./types.mjs').PoolOptions | undefined} options
 * @param {object} blocks { blocksOf, decodeGlued } of blocks.mjs; loaders import these when they need them
 */
export function createPool(options, blocks) {
  const { workers = Math.max(1, Math.min(4, (globalThis.navigator?.hardwareConcurrency ?? 4) - 1)), ...where } = options ?? {};
  requireArgument(Number.isInteger(workers) && workers > 0 && workers <= MOST_WORKERS, `workers must be a number from 1 to ${MOST_WORKERS}`);
  return new DecoderPool(workers, where, blocks);
}

class DecoderPool {
  #source;
  #blocks;
  #workers;
  #waiting = [];
  #disposed = false;

  constructor(size, where, blocks) {
    this.size = size;
    this.#blocks = blocks;
    // All workers share one copy of the modules; without options, it is that of decodePayload().
    this.#source = Object.keys(where).length === 0 ? pageSource() : new Source(where);
    this.#workers = Array.from({ length: size }, () => ({ job: null, worker: null, started: null, keys: new Set() }));
    this.#runner.ahead = size + 1;
  }

  /** Bound to the pool, so that it can be passed on as the option `decode` of unpackGlb(). */
  decodePayload = async (bytes, options) => {
    const { transfer = false, onBlock, limits, indexType = 'auto', claims } = options ?? {};
    checkBytes(bytes);
    checkIndexType(indexType);
    requireArgument(onBlock === undefined || typeof onBlock === 'function', 'onBlock must be a function');
    // Workers share the blocks of a large surface.
    if ((this.size > 1 || onBlock !== undefined) && claimsBlocks(bytes)) {
      return this.#blocks.decodeGlued(this.#runner, bytes, { onBlock, limits, indexType, claims });
    }
    // The buffer moves to the worker. It is the caller's own if that is wanted and it holds nothing
    // else; otherwise it is copied when a worker is free, so that no more copies are there than workers.
    const { buffer } = bytes;
    const whole = transfer && buffer instanceof ArrayBuffer && bytes.byteLength === buffer.byteLength;
    return this.#run(undefined, () => {
      const payload = whole ? bytes : new Uint8Array(bytes);
      return { message: { bytes: payload, options: { limits, indexType, claims } }, moved: [payload.buffer] };
    });
  };

  /** Bound to the pool. */
  decodeBlocks = (bytes, options) => this.#blocks.blocksOf(this.#runner, bytes, options);

  #runner = {
    /** Blocks that are decoded or wait to be, so that no worker waits. */
    ahead: 0,
    module: async () => (await this.#source.whole()).module,
    decodePayload: (bytes, options) => this.decodePayload(bytes, options),
    run: (key, makeTask) => this.#run(key, (slot) => {
      const { task, moved } = makeTask(!slot.keys.has(key));
      slot.keys.add(key);
      return { message: { task }, moved };
    }),
    close: (key) => this.#close(key),
  };

  /** Resolves when a worker has answered what `make` makes for it. */
  #run(key, make) {
    return new Promise((resolve, reject) => {
      if (this.#disposed) throw new MccError('the pool was disposed of', 'Disposed');
      this.#waiting.push({ key, make, resolve, reject });
      this.#next();
    });
  }

  /** Makes workers forget the blocks of a payload. */
  #close(key) {
    this.#waiting = this.#waiting.filter((job) => job.key !== key);
    for (const slot of this.#workers) if (slot.keys.delete(key)) slot.worker?.postMessage({ close: key });
  }

  dispose() {
    this.#disposed = true;
    const error = new MccError('the pool was disposed of', 'Disposed');
    for (const job of this.#waiting.splice(0)) job.reject(error);
    for (const slot of this.#workers) {
      slot.job?.reject(error);
      slot.job = null;
      slot.worker?.terminate();
    }
  }

  #next() {
    if (this.#waiting.length === 0) return;
    const idle = this.#workers.filter(({ job }) => job === null);
    const slot = idle.find(({ keys }) => keys.has(this.#waiting[0].key)) ?? idle[0];
    if (slot === undefined) return;
    slot.job = this.#waiting.shift();
    slot.started ??= this.#start(slot);
    slot.started.then(() => this.#post(slot), (error) => this.#lose(slot, error));
  }

  #post(slot) {
    if (slot.job === null) return; // the pool was disposed of
    try {
      const { message, moved } = slot.job.make(slot);
      slot.worker.postMessage(message, moved);
      slot.worker.ref?.(); // Node: only a running job keeps the program alive
    } catch (error) {
      this.#finish(slot, 'reject', asMccError(error, 'the payload cannot be sent to a worker', 'BadArgument'));
    }
  }

  #finish(slot, how, value) {
    const { job } = slot;
    slot.job = null;
    slot.worker?.unref?.();
    // Its payload may have been closed while it waited for the whole decoder.
    if (job?.key !== undefined && !slot.keys.has(job.key)) slot.worker?.postMessage({ close: job.key });
    job?.[how](value);
    this.#next();
  }

  /** Drops a worker that has failed, or that could not start. The next payload gets another one. */
  #lose(slot, error) {
    slot.worker?.terminate();
    slot.worker = slot.started = null;
    slot.keys.clear();
    this.#finish(slot, 'reject', asMccError(error, 'the worker failed', 'Load'));
  }

  async #start(slot) {
    const { module } = await this.#source.first();
    const answer = ({ decoded, needsWhole, message, code }) => {
      if (decoded !== undefined) this.#finish(slot, 'resolve', decoded);
      else if (needsWhole) this.#sendWhole(slot);
      else this.#finish(slot, 'reject', new MccError(message, code));
    };
    // What comes from a worker that was dropped is not about the one in its place.
    const ifCurrent = (call) => (value) => { if (slot.worker === worker) call(value); };
    const worker = await createWorker(ifCurrent(answer), ifCurrent((error) => this.#lose(slot, error)));
    slot.worker = worker;
    if (this.#disposed) worker.terminate();
    else worker.postMessage({ module });
  }

  /** The worker keeps the payload and waits. */
  async #sendWhole(slot) {
    const { worker } = slot;
    try {
      const { module } = await this.#source.whole();
      if (slot.worker === worker) worker.postMessage({ module });
    } catch (error) {
      if (slot.worker === worker) this.#finish(slot, 'reject', asMccError(error, 'the decoder cannot be sent to a worker', 'Load'));
    }
  }
}

/** Creates a worker of the browser, or one of Node with the same interface. */
async function createWorker(onMessage, onError) {
  if (typeof Worker === 'function') {
    const worker = new Worker(new URL('./worker.mjs', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data }) => onMessage(data);
    worker.onerror = worker.onmessageerror = onError;
    return worker;
  }
  const threads = await importOfNode('worker_threads');
  const worker = new threads.Worker(new URL('./worker.mjs', import.meta.url));
  worker.on('message', onMessage);
  for (const event of ['error', 'messageerror']) worker.on(event, onError);
  worker.on('exit', () => onError({ message: 'it has ended' }));
  return worker;
}
