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

/** The modules of a place and the decoders made of them. The core is smaller and has what most payloads need. */
class Source {
  #modules = {};

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

  /** The compiled module; the decoder is there then. */
  #load(name, urlOf) {
    this.#modules[name] ??= compileModule(this.where, urlOf(this.where)).then((module) => {
      this[name] = new Decoder(module);
      return module;
    }, (error) => {
      delete this.#modules[name]; // the next call tries again
      throw error;
    });
    return this.#modules[name];
  }
}

let source = new Source({});

/** Loads the decoder. Without a call the first decodePayload() does, from beside this module. */
export function init(options = {}) {
  source = new Source(options);
  return source.core();
}

/** Resolves when the decoder is loaded as a whole, which awaiting it begins. */
export const ready = {
  then: (fulfilled, rejected) => source.whole().then(() => {}).then(fulfilled, rejected),
};

export async function decodePayload(bytes, options) {
  const from = source;
  if (from.decoder === undefined) await from.core();
  try {
    return await (from.decoder ?? from.coreDecoder).decode(bytes, options);
  } catch (error) {
    if (error.code !== 'NotInCore') throw error;
    await from.whole();
    return from.decoder.decode(bytes, options);
  }
}

export function decodePayloadSync(bytes, options) {
  if (source.decoder === undefined) throw new MccError('the decoder is not loaded yet: await ready first', 'Load');
  return source.decoder.decodeSync(bytes, options);
}

/** Decodes in workers, several payloads at a time. */
export function createDecoderPool(options = {}) {
  const { workers = Math.max(1, Math.min(4, (globalThis.navigator?.hardwareConcurrency ?? 4) - 1)), ...where } = options;
  return new DecoderPool(workers, where);
}

class DecoderPool {
  #source;
  #workers;
  #waiting = [];
  #disposed = false;

  constructor(size, where) {
    this.size = size;
    // One copy of the modules for all; without options those of decodePayload().
    this.#source = Object.keys(where).length === 0 ? source : new Source(where);
    const module = this.#source.core();
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
        if (decoded !== undefined) {
          this.#finish(slot, 'resolve', decoded);
        } else if (code === 'NotInCore') { // the worker keeps the payload and waits
          this.#source.whole().then((whole) => slot.worker.postMessage({ module: whole }),
            (error) => this.#finish(slot, 'reject', error));
        } else {
          this.#finish(slot, 'reject', new MccError(message, code));
        }
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

const hasSimd = () => WebAssembly.validate(new Uint8Array(VECTORS));

function urlOfCore({ coreUrl, simdCoreUrl }) {
  return hasSimd() ? simdCoreUrl ?? coreUrl ?? new URL('./wasm/mcc_decoder_core_simd.wasm', import.meta.url)
    : coreUrl ?? new URL('./wasm/mcc_decoder_core.wasm', import.meta.url);
}

function urlOfWhole({ wasmUrl, simdWasmUrl }) {
  return hasSimd() ? simdWasmUrl ?? wasmUrl ?? new URL('./wasm/mcc_decoder_simd.wasm', import.meta.url)
    : wasmUrl ?? new URL('./wasm/mcc_decoder.wasm', import.meta.url);
}
