// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes payloads block by block, while they are loaded, and glues blocks to the piece that they are.
import { asTrap, checkIndexType, claimsBlocks, FLAGS_END } from './arguments.mjs';
import { BlockDecoder, runTask } from './block_decoder.mjs';
import { Chunks } from './chunks.mjs';
import { checkClaims } from './claims.mjs';
import { decodePayload } from './decode.mjs';
import { MccError, requireArgument } from './error.mjs';
import { wholeModule } from './source.mjs';
import { nextTask } from './tasks.mjs';

export { claimsBlocks };

const FIRST_PREFIX_BYTES = 1024;
/** What the page's thread works at most before it lets others work. */
const WORK_MILLISECONDS = 3;
const SLICE = 1 << 14;
const POSITION = 0;

/** Decodes the blocks of a payload on this thread, which may do other things between two of them. */
export function decodeBlocks(source, options) {
  return blocksOf(new OnThisThread(), source, options);
}

/** Runs tasks on this thread. A pool does the same in workers. */
export class OnThisThread {
  #decoders = new Map();
  ahead = 1;

  module() {
    return wholeModule();
  }

  decodePayload(bytes, options) {
    return decodePayload(bytes, options);
  }

  /**
   * Decodes a block.
   * @param {object} key of the payload
   * @param {(isFirst: boolean) => { task: object, moved: ArrayBuffer[] }} makeTask `isFirst`: whoever runs it does not know the payload yet
   */
  async run(key, makeTask) {
    await nextTask();
    const { task } = makeTask(!this.#decoders.has(key));
    return runTask(this.#decoders, await wholeModule(), task);
  }

  /** Forgets a payload. */
  close(key) {
    this.#decoders.delete(key);
  }
}

let payloadCount = 0;

/**
 * Yields the blocks of a payload, see decodeBlocks() in types.mjs.
 * @param {OnThisThread} runner
 * @param source
 * @param {object} [options] besides those of decodeBlocks(): `findsRim` adds `rim` to blocks, `onOpen` is called with a
 *   BlockDecoder that can number blocks and with what the header says
 */
export async function* blocksOf(runner, source, options) {
  const { order = 'index', signal, limits, indexType = 'auto', claims, findsRim = false, onOpen, payloadBytes: given } = options ?? {};
  requireArgument(['index', 'any'].includes(order), 'order must be index or any');
  requireArgument(signal === undefined || typeof signal?.throwIfAborted === 'function', 'signal must be an AbortSignal');
  checkIndexType(indexType);
  const payloadBytes = sizeOf(source, given);
  signal?.throwIfAborted();
  const chunks = source instanceof Chunks ? source : new Chunks(source);
  const abort = new Abort(signal);
  const key = payloadCount++;
  try {
    const beginning = await abort.race(chunks.peek(Math.min(FLAGS_END, payloadBytes)));
    if (!claimsBlocks(beginning)) {
      const bytes = await abort.race(chunks.read(payloadBytes));
      yield* piecesOf(await abort.race(runner.decodePayload(bytes, { limits, indexType, claims })));
      return;
    }
    const table = await BlockDecoder.make(await abort.race(runner.module()));
    const info = await openTable(table, chunks, payloadBytes, limits, abort);
    checkAgainst(info, claims);
    checkIndexType(indexType, info.blocks);
    onOpen?.(table, info);
    const header = await chunks.read(info.headerBytes);
    yield* inOrder(order, info.blocks.length, runner.ahead, abort, starter(runner, key, {
      header, info, chunks, opening: { payloadBytes, limits }, options: { indexType, findsRim },
    }));
  } finally {
    abort.end();
    // Who shares the chunks reads on, unless something went wrong.
    if (source !== chunks) chunks.cancel();
    runner.close(key);
  }
}

function checkAgainst(info, claims) {
  try {
    if (claims !== undefined) checkClaims(info, claims);
  } catch (error) {
    throw asTrap(error);
  }
}

function sizeOf(source, given) {
  const known = source instanceof Uint8Array || source instanceof ArrayBuffer ? source.byteLength : given;
  requireArgument(Number.isSafeInteger(known) && known >= 0 && (given ?? known) === known, 'payloadBytes must be the size of the payload');
  return known;
}

/** Opens the header as soon as it is there; the tries take no more time than reading it once. */
async function openTable(table, chunks, payloadBytes, limits, abort) {
  for (let wanted = FIRST_PREFIX_BYTES;; wanted *= 2) {
    const prefix = await abort.race(chunks.peek(Math.min(wanted, payloadBytes)));
    const info = table.open(prefix, payloadBytes, limits);
    if (info !== null) return info;
    if (prefix.length < wanted) throw new MccError('the source ends before the payload does', 'Truncated');
  }
}

/** Returns a function that begins with a block: it reads one after the other, and decodes several at a time. */
function starter(runner, key, { header, info, chunks, opening, options }) {
  let reading = Promise.resolve();
  let prefix;
  return async (index) => {
    const { offset, bytes: count, repeatedCount, triangleCount, box } = info.blocks[index];
    const bytes = await (reading = reading.then(() => chunks.read(count)));
    prefix ??= joined(header, bytes); // of block 0, which is read first
    const makeTask = (isFirst) => {
      const own = isFirst ? { opening: { ...opening, prefix: prefix.slice() } } : {};
      if (index !== 0) Object.assign(own, { offset, bytes: new Uint8Array(bytes) });
      const task = { key, index, ...own, ...options };
      return { task, moved: [own.opening?.prefix.buffer, own.bytes?.buffer].filter(Boolean) };
    };
    const block = await runner.run(key, makeTask);
    return { index, blockCount: info.blocks.length, piece: 0, box, repeatedCount, triangleCount, ...block };
  };
}

function joined(a, b) {
  const bytes = new Uint8Array(a.length + b.length);
  bytes.set(a);
  bytes.set(b, a.length);
  return bytes;
}

/** Yields the results of start(0), start(1), …, of which `ahead` are under way at a time. */
async function* inOrder(order, count, ahead, abort, start) {
  const pending = [];
  let started = 0;
  for (let yielded = 0; yielded < count; ++yielded) {
    while (started < count && pending.length < ahead) {
      const promise = start(started++);
      promise.catch(() => {}); // it may never be waited for
      pending.push(promise);
    }
    let at = 0;
    if (order === 'any') at = await abort.race(Promise.race(pending.map((promise, i) => promise.then(() => i))));
    const [next] = pending.splice(at, 1);
    yield await abort.race(next);
  }
}

/** Yields the pieces of a payload without blocks as if they were blocks. */
function* piecesOf({ pieces }) {
  for (const [index, { wedgeCount, attributes, parts }] of pieces.entries()) {
    const triangleCount = parts.reduce((sum, part) => sum + part.triangleCount, 0);
    const box = boxOf(attributes[0]);
    yield { index, blockCount: pieces.length, piece: index, box, repeatedCount: 0, triangleCount, wedgeCount, attributes, parts };
  }
}

/** Returns the box of positions; undefined if there are none. */
function boxOf(attribute) {
  if (attribute?.semantic !== POSITION || attribute.componentCount !== 3 || attribute.array.length === 0) return undefined;
  const { array } = attribute;
  const min = [...array.subarray(0, 3)];
  const max = [...min];
  for (let i = 0; i < array.length; ++i) {
    const axis = i % 3;
    if (array[i] < min[axis]) min[axis] = array[i];
    else if (array[i] > max[axis]) max[axis] = array[i];
  }
  return { min, max };
}

/** Lets whoever waits for a promise hear of a signal instead. */
class Abort {
  #signal;
  #listener;
  #aborted;

  constructor(signal) {
    this.#signal = signal;
    if (signal === undefined) return;
    this.#aborted = new Promise((_, reject) => { this.#listener = () => reject(signal.reason); });
    this.#aborted.catch(() => {});
    signal.addEventListener('abort', this.#listener);
  }

  race(promise) {
    return this.#aborted === undefined ? promise : Promise.race([this.#aborted, promise]);
  }

  end() {
    this.#signal?.removeEventListener('abort', this.#listener);
  }
}

/**
 * Like decodePayload(), for a payload with blocks, without long tasks on this thread.
 * @param {OnThisThread} runner
 * @param {Uint8Array} bytes
 * @param {object} options of decodePayload(), and `onBlock`, which is called with each block before it is glued
 */
export async function decodeGlued(runner, bytes, { onBlock, indexType = 'auto', ...options }) {
  let glue;
  const onOpen = (table, info) => { glue = new Glue(table, info, indexType); };
  for await (const { rim, ...block } of blocksOf(runner, bytes, { ...options, findsRim: true, onOpen })) {
    onBlock?.(block);
    await glue.add(block, rim);
  }
  return { pieces: glue.pieces };
}

/** Makes the piece of its blocks, which come in their order. [A.11.4] */
class Glue {
  #table;
  #wedges = 0; // that are there so far
  #until = 0;

  constructor(table, { pieces }, indexType) {
    this.#table = table;
    this.pieces = pieces;
    const [{ wedgeCount }] = pieces;
    checkIndexType(indexType, pieces);
    this.IndexArray = indexType === 'uint32' || wedgeCount > 0xffff ? Uint32Array : Uint16Array;
    this.filled = pieces[0].parts.map(() => 0);
  }

  async add(block, rim) {
    const { attributes, parts, wedgeCount } = this.pieces[0];
    const numbers = this.#table.number(block.wedgeCount, rim);
    this.#until = performance.now() + WORK_MILLISECONDS;
    for (const [a, { array, componentCount }] of block.attributes.entries()) {
      attributes[a].array ??= new array.constructor(wedgeCount * componentCount);
      await this.#addElements(attributes[a].array, array, componentCount, numbers);
    }
    for (const [p, { indices }] of block.parts.entries()) {
      parts[p].indices ??= new this.IndexArray(3 * parts[p].triangleCount);
      await this.#addIndices(parts[p].indices, this.filled[p], indices, numbers);
      this.filled[p] += indices.length;
    }
    this.#wedges += block.wedgeCount - block.repeatedCount;
  }

  /** Copies the elements of wedges that blocks before this one do not have. Their numbers follow each other. */
  async #addElements(to, from, componentCount, numbers) {
    const first = this.#wedges;
    let at = first;
    for (let begin = 0; begin < numbers.length;) {
      while (begin < numbers.length && numbers[begin] < first) ++begin;
      let end = begin;
      while (end < numbers.length && end - begin < SLICE && numbers[end] >= first) ++end;
      to.set(from.subarray(begin * componentCount, end * componentCount), at * componentCount);
      at += end - begin;
      begin = end;
      if (performance.now() > this.#until) await this.#pause();
    }
  }

  async #addIndices(to, at, indices, numbers) {
    for (let begin = 0; begin < indices.length; begin += SLICE) {
      const end = Math.min(begin + SLICE, indices.length);
      for (let i = begin; i < end; ++i) to[at + i] = numbers[indices[i]];
      if (performance.now() > this.#until) await this.#pause();
    }
  }

  async #pause() {
    await nextTask();
    this.#until = performance.now() + WORK_MILLISECONDS;
  }
}
