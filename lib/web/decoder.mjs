// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes payloads of KHR_mesh_collapse_compression: here, or in workers.
import { Decoder } from './core.mjs';
import { MccError } from './error.mjs';
import { compileModule, importOfNode } from './load.mjs';

export { MccError };

/** A module whose only function uses a vector; what cannot compile it has no SIMD. */
const VECTORS = [
  0, 97, 115, 109, 1, 0, 0, 0, // header
  1, 4, 1, 96, 0, 0, 3, 2, 1, 0, // a function without parameters or results
  10, 23, 1, 21, 0, 253, 12, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 26, 11, // v128.const, drop, end
];

let source = {};
let loading = null;
let decoder = null;

/** Loads the decoder. Without a call the first decodePayload() does, from beside this module. */
export function init(options = {}) {
  source = options;
  loading = null;
  return load();
}

/** Resolves when the decoder is loaded, which awaiting it begins. */
export const ready = {
  then: (fulfilled, rejected) => load().then(() => {}).then(fulfilled, rejected),
};

export async function decodePayload(bytes, options) {
  await load();
  return decoder.decode(bytes, options);
}

export function decodePayloadSync(bytes, options) {
  if (decoder === null) throw new MccError('the decoder is not loaded yet: await ready first', 'Load');
  return decoder.decodeSync(bytes, options);
}

/** Decodes in workers, several payloads at a time. */
export function createDecoderPool(options = {}) {
  const { workers = Math.max(1, Math.min(4, (globalThis.navigator?.hardwareConcurrency ?? 4) - 1)), ...where } = options;
  return new DecoderPool(workers, where);
}

class DecoderPool {
  #workers;
  #waiting = [];
  #disposed = false;

  constructor(size, where) {
    this.size = size;
    // One copy of the module for all; without options that of decodePayload().
    const module = Object.keys(where).length === 0 ? load() : compile(where);
    module.catch(() => {}); // whoever waits for a worker gets to know
    this.#workers = Array.from({ length: size }, () => ({ job: null, worker: null, started: null }));
    this.start = (slot) => (slot.started ??= module.then((compiled) => this.#start(slot, compiled)));
  }

  /** Bound, so that it can be handed on: unpackGlb(bytes, { decode: pool.decodePayload }). */
  decodePayload = (bytes, { transfer = false, ...options } = {}) => new Promise((resolve, reject) => {
    if (this.#disposed) throw new MccError('the pool was disposed of', 'Disposed');
    // The buffer moves to the worker: the caller's own if that is wanted and nothing else is in it.
    const whole = transfer && bytes.byteLength === bytes.buffer.byteLength;
    this.#waiting.push({ bytes: whole ? bytes : bytes.slice(), options, resolve, reject });
    this.#next();
  });

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
    const slot = this.#workers.find(({ job }) => job === null);
    if (slot === undefined || this.#waiting.length === 0) return;
    slot.job = this.#waiting.shift();
    this.start(slot).then(
      () => {
        if (slot.job === null) return; // disposed of
        const { bytes, options } = slot.job;
        slot.worker.ref?.(); // Node: only a job keeps the program alive
        slot.worker.postMessage({ bytes, options }, [bytes.buffer]);
      },
      (error) => this.#finish(slot, 'reject', error),
    );
  }

  #finish(slot, how, value) {
    const { job } = slot;
    slot.job = null;
    slot.worker?.unref?.();
    job?.[how](value);
    this.#next();
  }

  async #start(slot, module) {
    slot.worker = await createWorker(
      ({ decoded, message, code }) => {
        if (decoded !== undefined) this.#finish(slot, 'resolve', decoded);
        else this.#finish(slot, 'reject', new MccError(message, code));
      },
      (error) => {
        slot.worker?.terminate();
        slot.worker = slot.started = null;
        this.#finish(slot, 'reject', new MccError(`the worker failed (${error.message ?? 'it could not start'})`, 'Load'));
      },
    );
    if (this.#disposed) slot.worker.terminate();
    else slot.worker.postMessage({ module });
  }
}

/** A worker of browsers, or of Node behind the same calls. */
async function createWorker(onMessage, onError) {
  if (typeof Worker === 'function') {
    const worker = new Worker(new URL('./worker.mjs', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data }) => onMessage(data);
    worker.onerror = onError;
    return worker;
  }
  const threads = await importOfNode('worker_threads');
  const worker = new threads.Worker(new URL('./worker.mjs', import.meta.url));
  worker.on('message', onMessage);
  worker.on('error', onError);
  return worker;
}

/** The compiled module; `decoder` is there then. */
function load() {
  const from = source;
  loading ??= compile(from).then((module) => {
    if (from === source) decoder = new Decoder(module);
    return module;
  }, (error) => {
    loading = null; // the next call tries again
    throw error;
  });
  return loading;
}

function compile(where) {
  const hasSimd = WebAssembly.validate(new Uint8Array(VECTORS));
  const url = hasSimd ? where.simdWasmUrl ?? where.wasmUrl ?? new URL('./wasm/mcc_decoder_simd.wasm', import.meta.url)
    : where.wasmUrl ?? new URL('./wasm/mcc_decoder.wasm', import.meta.url);
  return compileModule(where, url);
}
