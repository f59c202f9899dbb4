// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Where plugins decode: small payloads on the thread of the page, which has them sooner than a worker could be told of them, and all others
// in workers that the loaders of a page share.
import { claimsBlocks } from './arguments.mjs';
import { bytesOf } from './budget.mjs';
import { decodePayload, prepareHere } from './decode.mjs';
import { asMccError } from './error.mjs';
import { expectedBytes, pace } from './pace.mjs';
import { createPool } from './pool.mjs';
import { pageSource } from './source.mjs';
import { LONGEST_TASK_MS, ShortTasks } from './tasks.mjs';

let pool;
let hasWorkers = typeof Worker !== 'undefined';
const here = /* @__PURE__ */ new ShortTasks();

const pagePool = () => (pool ??= createPool({}, {
  decodeGlued: async (...args) => (await rarelyNeeded()).decodeGlued(...args),
  async* blocksOf(...args) {
    yield* (await rarelyNeeded()).blocksOf(...args);
  },
}));

/**
 * Loads what decoding needs, and starts a worker, while the file is on its way. Plugins call it when they are registered; a page that knows
 * earlier that it will show models may call it before. Nothing is wrong yet if that fails: decoding tries again.
 */
export async function preload() {
  await Promise.all([prepareHere().catch(() => {}), hasWorkers && pagePool().prepare()]);
}

/** Loads what decodeBlocksAnywhere() needs as well, which is too late when the first payload is there. */
export function preloadBlocks() {
  preload();
  rarelyNeeded().catch(() => {});
}

/** Loads the whole decoder, which payloads with blocks or tangents need. */
export const expectWhole = () => pageSource().whole().catch(() => {});

/**
 * Decodes a payload where that is done soonest without holding up the page. Where there are no workers (Node), or they cannot start (in a
 * page that forbids them, or if this module comes from another origin), that is this thread.
 * @type {typeof import('./decoder.mjs').decodePayload}
 */
export async function decodeAnywhere(payload, { onBlock, ...others } = {}) {
  const options = onBlock === undefined ? others : { ...others, onBlock: once(onBlock) };
  const isInBlocks = claimsBlocks(payload);
  if (isInBlocks) expectWhole();
  const ms = pace.predict(expectedBytes(payload, options.claims));
  if (hasWorkers && (isInBlocks || !isForThisThread(ms))) {
    try {
      return await pagePool().decodePayload(payload, options);
    } catch (error) {
      if (isAboutPayload(error)) throw error;
      hasWorkers = false;
    }
  }
  if (options.onBlock !== undefined && isInBlocks) {
    const { decodeGlued, OnThisThread } = await rarelyNeeded();
    return decodeGlued(new OnThisThread(), payload, options);
  }
  return here.add(ms, () => decodeHere(payload, others));
}

/**
 * Decodes the blocks of a payload in workers if there are any, else on this thread.
 * @type {typeof import('./blocks.mjs').decodeBlocks}
 */
export async function* decodeBlocksAnywhere(source, options) {
  const { blocksOf, OnThisThread } = await rarelyNeeded();
  if (hasWorkers) hasWorkers = await pagePool().prepare();
  yield* hasWorkers ? pagePool().decodeBlocks(source, options) : blocksOf(new OnThisThread(), source, options);
}

/** Loads that begin so soon after each other compete for the page's thread, which parses their files too. */
const SAME_BURST_MS = 100;
let lastAt = -Infinity;
let takenMs = 0;

/** One task of a burst of payloads is for decoding them; the others go to workers, which get many at once. */
function isForThisThread(ms) {
  const now = performance.now();
  if (now - lastAt > SAME_BURST_MS) takenMs = 0;
  lastAt = now;
  if (takenMs + ms > LONGEST_TASK_MS) return false;
  takenMs += ms;
  return true;
}

async function decodeHere(payload, options) {
  await prepareHere();
  const begin = performance.now();
  const decoded = await decodePayload(payload, options);
  pace.learn(bytesOf(decoded), performance.now() - begin);
  return decoded;
}

/** What most pages never need is a chunk of its own in bundles. */
export async function rarelyNeeded() {
  try {
    return await import('./gluing.mjs');
  } catch (error) {
    throw asMccError(error, 'cannot load gluing.mjs', 'Load');
  }
}

/** Blocks that workers have decoded before one failed are not told again. */
function once(onBlock) {
  let told = 0;
  return (block) => {
    if (block.index < told) return;
    told = block.index + 1;
    onBlock(block);
  };
}

/** Whether an error of a pool says that a payload or an option is wrong, and not that there are no workers. */
export const isAboutPayload = ({ code }) => typeof code === 'string' && code !== 'Load';
