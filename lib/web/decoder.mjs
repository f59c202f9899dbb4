// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes payloads of KHR_mesh_collapse_compression, on this thread or in workers.
import { blocksOf, claimsBlocks, decodeGlued } from './blocks.mjs';
import { checkBytes, checkIndexType, Decoder } from './core.mjs';
import { asMccError, MccError, requireArgument } from './error.mjs';
import { compileModule } from './load.mjs';
import { importOfNode } from './node.mjs';

export { MccError };

/** A module whose only function uses a vector. An engine without SIMD cannot compile it. */
const VECTORS = [
  0, 97, 115, 109, 1, 0, 0, 0, // header
  1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, // a function without parameters that returns a vector
  10, 8, 1, 6, 0, 65, 0, 253, 15, 11, // i32.const 0, i8x16.splat, end
];

/**
 * Loads and keeps the decoders of one place. The core is smaller and faster, and decodes most
 * payloads.
 */
class Source {
  #loading = {};

  constructor(where) {
    this.where = where;
  }

  core() {
    const { module, bytes, coreUrl, simdCoreUrl, wasmUrl, simdWasmUrl } = this.where;
    const isWhole = (module ?? bytes ?? wasmUrl ?? simdWasmUrl) !== undefined;
    return (coreUrl ?? simdCoreUrl) === undefined && isWhole ? this.whole() : this.#load('coreDecoder', urlOfCore);
  }

  whole() {
    return this.#load('decoder', urlOfWhole);
  }

  /** The decoder to try first: the core, unless only the whole decoder is loaded. */
  first() {
    return this.decoder && !this.coreDecoder ? this.whole() : this.core();
  }

  #load(name, urlOf) {
    this.#loading[name] ??= compileModule(this.where, urlOf(this.where)).then((module) => (this[name] = new Decoder(module)), (error) => {
      delete this.#loading[name]; // the next call tries again
      throw error;
    });
    return this.#loading[name];
  }
}

const MOST_WORKERS = 1024;

let source = new Source({});

/**
 * Loads the decoder. If it is never called, the first decodePayload() loads the modules next to
 * this one.
 */
export async function init(options) {
  source = new Source(options ?? {});
  await source.core();
}

/** Resolves when the whole decoder is loaded. Awaiting it starts the loading. */
export const ready = {
  then: (fulfilled, rejected) => source.whole().then(() => {}).then(fulfilled, rejected),
};

/** Returns the compiled whole decoder. */
export const wholeModule = async () => (await source.whole()).module;

export async function decodePayload(bytes, options) {
  const from = source;
  try {
    return await (await from.first()).decode(bytes, options);
  } catch (error) {
    if (error.code !== 'NotInCore') throw error;
    return (await from.whole()).decode(bytes, options);
  }
}

export function decodePayloadSync(bytes, options) {
  if (source.decoder === undefined) throw new MccError('the decoder is not loaded yet: await ready first', 'Load');
  return source.decoder.decodeSync(bytes, options);
}

/** Creates a pool that decodes several payloads at a time, in workers. */
export function createDecoderPool(options) {
  const { workers = Math.max(1, Math.min(4, (globalThis.navigator?.hardwareConcurrency ?? 4) - 1)), ...where } = options ?? {};
  requireArgument(Number.isInteger(workers) && workers > 0 && workers <= MOST_WORKERS, `workers must be a number from 1 to ${MOST_WORKERS}`);
  return new DecoderPool(workers, where);
}

class DecoderPool {
  #source;
  #workers;
  #waiting = [];
  #disposed = false;

  constructor(size, where) {
    this.size = size;
    // All workers share one copy of the modules; without options, it is that of decodePayload().
    this.#source = Object.keys(where).length === 0 ? source : new Source(where);
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
      return decodeGlued(this.#runner, bytes, { onBlock, limits, indexType, claims });
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
  decodeBlocks = (bytes, options) => blocksOf(this.#runner, bytes, options);

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

const hasSimd = () => WebAssembly.validate(new Uint8Array(VECTORS));

function urlOfCore({ coreUrl, simdCoreUrl }) {
  return hasSimd() ? simdCoreUrl ?? coreUrl ?? new URL('./wasm/mcc_decoder_core_simd.wasm', import.meta.url)
    : coreUrl ?? new URL('./wasm/mcc_decoder_core.wasm', import.meta.url);
}

function urlOfWhole({ wasmUrl, simdWasmUrl }) {
  return hasSimd() ? simdWasmUrl ?? wasmUrl ?? new URL('./wasm/mcc_decoder_simd.wasm', import.meta.url)
    : wasmUrl ?? new URL('./wasm/mcc_decoder.wasm', import.meta.url);
}
