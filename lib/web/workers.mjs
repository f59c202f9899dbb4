// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { claimsBlocks } from './arguments.mjs';
import { asMccError } from './error.mjs';
import { createPool } from './pool.mjs';

let pool;
let hasWorkers = typeof Worker !== 'undefined';

/**
 * Calls decodePayload() in workers that all loaders of a page share; they start with the first
 * payload.
 * Where there are no workers (Node), or they cannot start (in a page that forbids them, or if this
 * module comes from another origin), it decodes on this thread.
 * @type {typeof import('./decoder.mjs').decodePayload}
 */
export async function decodeInWorkers(payload, { onBlock, ...others } = {}) {
  const options = onBlock === undefined ? others : { ...others, onBlock: once(onBlock) };
  if (hasWorkers) {
    try {
      pool ??= createPool({}, { decodeGlued: async (...args) => (await rarelyNeeded()).decodeGlued(...args) });
      return await pool.decodePayload(payload, options);
    } catch (error) {
      if (isAboutPayload(error)) throw error;
      hasWorkers = false;
    }
  }
  const { decodeGlued, decodePayload, OnThisThread } = await rarelyNeeded();
  if (options.onBlock !== undefined && claimsBlocks(payload)) return decodeGlued(new OnThisThread(), payload, options);
  return decodePayload(payload, others);
}

/** What most pages never need is a chunk of its own in bundles. */
export async function rarelyNeeded() {
  try {
    return await import('./page_thread.mjs');
  } catch (error) {
    throw asMccError(error, 'cannot load page_thread.mjs', 'Load');
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

const isAboutPayload = ({ code }) => typeof code === 'string' && code !== 'Load';
