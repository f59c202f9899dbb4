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
 * @param {object} parts { blocksOf, decodeGlued } of blocks.mjs, which loaders import when they need them, and makeWorker() for workers that do more
 */
export function createPool(options, parts) {
  const { workers = Math.max(1, Math.min(4, (globalThis.navigator?.hardwareConcurrency ?? 4) - 1)), ...where } = options ?? {};
  requireArgument(Number.isInteger(workers) && workers > 0 && workers <= MOST_WORKERS, `workers must be a number from 1 to ${MOST_WORKERS}`);
  return new DecoderPool(workers, where, { makeWorker, ...parts });
}

class DecoderPool {
  #ownSource;
  #parts;
  #workers;
  #waiting = [];
  #disposed = false;

  constructor(size, where, parts) {
    this.size = size;
    this.#parts = parts;
    // All workers share one copy of the modules; without options, it is that of decodePayload().
    this.#ownSource = Object.keys(where).length === 0 ? undefined : new Source(where);
    this.#workers = Array.from({ length: size }, () => ({ batches: [], worker: null, started: null, isUp: false, keys: new Set() }));
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
      return this.#parts.decodeGlued(this.#runner, bytes, { onBlock, limits, indexType, claims });
    }
    // The buffer moves to the worker. It is the caller's own if that is wanted and it holds nothing
    // else; otherwise it is copied when a worker takes it, so that there are not many copies at a time.
    const { buffer } = bytes;
    const whole = transfer && buffer instanceof ArrayBuffer && bytes.byteLength === buffer.byteLength;
    const decodedBytes = expectedBytes(bytes);
    const { decoded, ms } = await this.run({ ms: pace.predict(decodedBytes) }, () => {
      const payload = whole ? bytes : new Uint8Array(bytes);
      return { job: { bytes: payload, options: { limits, indexType, claims } }, moved: [payload.buffer] };
    });
    pace.learn(bytesOf(decoded), ms);
    return decoded;
  };

  /** Bound to the pool. */
  decodeBlocks = (bytes, options) => this.#parts.blocksOf(this.#runner, bytes, options);

  #runner = {
    /** Blocks that are decoded or wait to be, so that no worker waits. */
    ahead: 0,
    module: async () => (await this.#source.whole()).module,
    decodePayload: (bytes, options) => this.decodePayload(bytes, options),
    run: async (key, makeTask) => (await this.run({ key }, (slot) => {
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
    const isUp = await this.#ensure(slot);
    if (slot.batches.length === 0) slot.worker?.unref?.();
    return isUp;
  }

  /**
   * Resolves with what a worker answers to the job that `make` makes for it.
   * @param {{ key?: number, ms?: number, isAtOnce?: boolean }} about  whose blocks, how long a payload is expected to take, whether busy workers
   *   get it too
   */
  run(about, make) {
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
      for (const job of slot.batches.splice(0).flat()) job.reject(error);
      slot.worker?.terminate();
      slot.worker = null; // what it has sent before is not heard
    }
  }

  #next() {
    if (this.#waiting.length === 0) return;
    const slot = this.#slotFor(this.#waiting[0]);
    if (slot === undefined) return;
    const batch = this.#takeBatch();
    slot.batches.push(batch);
    this.#ensure(slot).then(() => this.#post(slot, batch));
  }

  /** Returns a worker that has nothing to do, or for a job that is sent at once, one that has the least; or undefined, so that the job waits. */
  #slotFor({ key, isAtOnce }) {
    const free = this.#workers.filter(({ batches }) => isAtOnce || batches.length === 0);
    return free.find(({ keys }) => keys.has(key)) ?? free.sort((a, b) => a.batches.length - b.batches.length || b.isUp - a.isUp)[0];
  }

  /** Returns the job whose turn it is, and if it is a small payload, those after it, which would take longer to send than to decode. */
  #takeBatch() {
    const list = this.#waiting;
    let count = 1;
    for (let ms = list[0].ms; ms + list[count]?.ms <= BATCH_MS; ++count) ms += list[count].ms;
    return list.splice(0, count);
  }

  #post(slot, batch) {
    const { batches, worker } = slot;
    if (!batches.includes(batch)) return; // the pool was disposed of, or the worker is lost
    try {
      const made = batch.map(({ make }) => make(slot));
      worker.postMessage({ jobs: made.map(({ job }) => job) }, made.flatMap(({ moved }) => moved));
      worker.ref?.(); // Node: only running jobs keep the program alive
    } catch (error) {
      batches.splice(batches.indexOf(batch), 1);
      if (batch.length > 1) this.#waiting.unshift(...batch.map((job) => ({ ...job, ms: Infinity }))); // to find the one that is at fault
      else batch[0].reject(asMccError(error, 'the payload cannot be sent to a worker', 'BadArgument'));
      this.#goOn(slot);
    }
  }

  /** Of the list that a worker has had longest: it answers them in order. */
  #finish(slot, answers) {
    const batch = slot.batches.shift();
    this.#goOn(slot);
    batch.forEach(({ resolve, reject }, i) => {
      const { message, code } = answers[i];
      if (message === undefined) resolve(answers[i]);
      else reject(new MccError(message, code));
    });
  }

  #goOn(slot) {
    if (slot.batches.length === 0) slot.worker?.unref?.();
    this.#next();
  }

  /** Drops a worker that has failed, or that could not start. The next job gets another one. */
  #lose(slot, error) {
    slot.worker?.terminate();
    const jobs = slot.batches.flat();
    Object.assign(slot, { batches: [], worker: null, started: null, isUp: false });
    slot.keys.clear();
    const reason = asMccError(error, 'the worker failed', 'Load');
    for (const { reject } of jobs) reject(reason);
    this.#next();
  }

  /** Starts a worker unless there is one. Resolves with whether that was possible; if not, its jobs are rejected. */
  #ensure(slot) {
    if (slot.started === null) {
      const started = this.#start(slot).then(() => true, (error) => {
        if (slot.started === started) this.#lose(slot, error);
        return false;
      });
      slot.started = started;
    }
    return slot.started;
  }

  /** Starts a worker while its module is loaded. */
  async #start(slot) {
    const loading = this.#source.first();
    loading.catch(() => {}); // the worker may fail first
    const take = (data, error) => {
      if (slot.worker !== worker) return; // what comes from a worker that was dropped is not about the one in its place
      const { isUp, answers, needsWhole } = data ?? {};
      if (isUp) slot.isUp = true;
      else if (needsWhole) this.#sendWhole(worker);
      else if (answers) this.#finish(slot, answers);
      else this.#lose(slot, error ?? new MccError('the message to the worker cannot be read', 'BadArgument'));
    };
    const worker = await createWorker(this.#parts.makeWorker, take);
    slot.worker = worker;
    const { module } = await loading;
    if (this.#disposed) worker.terminate();
    else worker.postMessage({ module });
  }

  /** The worker waits for it. */
  async #sendWhole(worker) {
    const whole = await this.#source.whole().then(({ module }) => ({ module }), ({ message, code }) => ({ message, code }));
    worker.postMessage({ whole });
  }
}

/** The URL is written here, because bundlers look for it. */
const makeWorker = () => new Worker(new URL('./worker.mjs', import.meta.url), { type: 'module' });

/** Creates a worker of the browser, or one of Node with the same interface. */
async function createWorker(make, take) {
  if (typeof Worker !== 'function') return workerOfNode(take);
  const worker = make();
  worker.onmessage = ({ data }) => take(data);
  worker.onerror = worker.onmessageerror = (error) => take(undefined, error);
  return worker;
}
