// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Workers that decode.
import { checkBytes, checkIndexType, claimsBlocks } from './arguments.mjs';
import { bytesOf } from './budget.mjs';
import { asMccError, MccError, requireArgument } from './error.mjs';
import { workerOfNode } from './node.mjs';
import { expectedBytes, pace } from './pace.mjs';
import { pageSource, Source } from './source.mjs';
import { LONGEST_TASK_MS } from './tasks.mjs';

const MOST_WORKERS = 1024;
/** Payloads that a worker gets at once are expected to take so long together. */
const BATCH_MS = LONGEST_TASK_MS;

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
  #ownSource;
  #blocks;
  #workers;
  #waiting = [];
  #disposed = false;

  constructor(size, where, blocks) {
    this.size = size;
    this.#blocks = blocks;
    // All workers share one copy of the modules; without options, it is that of decodePayload().
    this.#ownSource = Object.keys(where).length === 0 ? undefined : new Source(where);
    this.#workers = Array.from({ length: size }, () => ({ jobs: null, worker: null, started: null, keys: new Set() }));
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
    const decodedBytes = expectedBytes(bytes);
    const { decoded, ms } = await this.#run({ ms: pace.predict(decodedBytes) }, () => {
      const payload = whole ? bytes : new Uint8Array(bytes);
      return { job: { bytes: payload, options: { limits, indexType, claims } }, moved: [payload.buffer] };
    });
    pace.learn(bytesOf(decoded), ms);
    return decoded;
  };

  /** Bound to the pool. */
  decodeBlocks = (bytes, options) => this.#blocks.blocksOf(this.#runner, bytes, options);

  #runner = {
    /** Blocks that are decoded or wait to be, so that no worker waits. */
    ahead: 0,
    module: async () => (await this.#source.whole()).module,
    decodePayload: (bytes, options) => this.decodePayload(bytes, options),
    run: async (key, makeTask) => (await this.#run({ key }, (slot) => {
      const { task, moved } = makeTask(!slot.keys.has(key));
      slot.keys.add(key);
      return { job: { task }, moved };
    })).block,
    close: (key) => this.#close(key),
  };

  get #source() {
    return this.#ownSource ?? pageSource();
  }

  /** Starts a worker before it is needed. Returns whether that was possible. */
  async prepare() {
    const [slot] = this.#workers;
    const started = (slot.started ??= this.#start(slot));
    try {
      await started;
      if (slot.jobs === null) slot.worker?.unref?.();
      return true;
    } catch (error) {
      if (slot.started === started) this.#lose(slot, error);
      return false;
    }
  }

  /**
   * Resolves with what a worker answers to the job that `make` makes for it.
   * @param {{ key?: number, ms?: number }} about  whose blocks, or how long a payload is expected to take
   */
  #run(about, make) {
    return new Promise((resolve, reject) => {
      if (this.#disposed) throw new MccError('the pool was disposed of', 'Disposed');
      this.#waiting.push({ ...about, make, resolve, reject });
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
      for (const job of slot.jobs ?? []) job.reject(error);
      slot.jobs = null;
      slot.worker?.terminate();
    }
  }

  #next() {
    if (this.#waiting.length === 0) return;
    const idle = this.#workers.filter(({ jobs }) => jobs === null);
    const slot = idle.find(({ keys }) => keys.has(this.#waiting[0].key)) ?? idle.find(({ isUp }) => isUp) ?? idle[0];
    if (slot === undefined) return;
    slot.jobs = this.#takeBatch();
    const started = (slot.started ??= this.#start(slot));
    const ifCurrent = (call) => (value) => { if (slot.started === started) call(value); };
    started.then(ifCurrent(() => this.#post(slot)), ifCurrent((error) => this.#lose(slot, error)));
  }

  /** Returns the job whose turn it is, and if it is a small payload, those after it, which would take longer to send than to decode. */
  #takeBatch() {
    const list = this.#waiting;
    let count = 1;
    for (let ms = list[0].ms; ms + list[count]?.ms <= BATCH_MS; ++count) ms += list[count].ms;
    return list.splice(0, count);
  }

  #post(slot) {
    const { jobs, worker } = slot;
    if (jobs === null) return; // the pool was disposed of
    try {
      const made = jobs.map(({ make }) => make(slot));
      worker.postMessage({ jobs: made.map(({ job }) => job) }, made.flatMap(({ moved }) => moved));
      worker.ref?.(); // Node: only running jobs keep the program alive
    } catch (error) {
      const alone = jobs.length > 1 ? jobs.map((job) => ({ ...job, ms: Infinity })) : []; // to find the one that is at fault
      this.#waiting.unshift(...alone);
      if (alone.length > 0) slot.jobs = [];
      this.#reject(slot, asMccError(error, 'the payload cannot be sent to a worker', 'BadArgument'));
    }
  }

  /** Makes a worker free, and calls `tell` with each of its jobs. */
  #finish(slot, tell) {
    const jobs = slot.jobs ?? [];
    slot.jobs = null;
    slot.worker?.unref?.();
    // Their payloads may have been closed while they waited for the whole decoder.
    for (const { key } of jobs) if (key !== undefined && !slot.keys.has(key)) slot.worker?.postMessage({ close: key });
    jobs.forEach(tell);
    this.#next();
  }

  #reject(slot, error) {
    this.#finish(slot, ({ reject }) => reject(error));
  }

  /** Drops a worker that has failed, or that could not start. The next payload gets another one. */
  #lose(slot, error) {
    slot.worker?.terminate();
    Object.assign(slot, { worker: null, started: null, isUp: false });
    slot.keys.clear();
    this.#reject(slot, asMccError(error, 'the worker failed', 'Load'));
  }

  /** Starts a worker while its module is loaded. */
  async #start(slot) {
    const loading = this.#source.first();
    loading.catch(() => {}); // the worker may fail first
    const answer = ({ isUp, answers, needsWhole }) => {
      if (isUp) slot.isUp = true;
      else if (needsWhole) this.#sendWhole(slot);
      else if (answers === undefined) this.#reject(slot, new MccError('the message to the worker cannot be read', 'BadArgument'));
      else this.#finish(slot, (job, i) => settle(job, answers[i]));
    };
    // What comes from a worker that was dropped is not about the one in its place.
    const ifCurrent = (call) => (value) => { if (slot.worker === worker) call(value); };
    const worker = await createWorker(ifCurrent(answer), ifCurrent((error) => this.#lose(slot, error)));
    slot.worker = worker;
    const { module } = await loading;
    if (this.#disposed) worker.terminate();
    else worker.postMessage({ module });
  }

  /** The worker keeps its jobs and waits. */
  async #sendWhole(slot) {
    const { worker } = slot;
    try {
      const { module } = await this.#source.whole();
      if (slot.worker === worker) worker.postMessage({ module });
    } catch (error) {
      if (slot.worker === worker) this.#reject(slot, asMccError(error, 'the decoder cannot be sent to a worker', 'Load'));
    }
  }
}

function settle({ resolve, reject }, answer) {
  if (answer.message === undefined) resolve(answer);
  else reject(new MccError(answer.message, answer.code));
}

/** Creates a worker of the browser, or one of Node with the same interface. */
async function createWorker(onMessage, onError) {
  if (typeof Worker === 'function') {
    const worker = new Worker(new URL('./worker.mjs', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data }) => onMessage(data);
    worker.onerror = worker.onmessageerror = onError;
    return worker;
  }
  return workerOfNode(onMessage, onError);
}
