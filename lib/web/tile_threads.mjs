// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Makes files without the extension where that holds up the page least: small ones in workers, which decode, and write what engines read, so
// that the page's thread only sends and gets bytes. They are sent when they are there: engines keep that thread so busy that a worker that
// waited for its next file would do nothing half of the time. Payloads of larger files are decoded as those of other plugins are.
import { createPool } from './pool.mjs';
import { decodeAnywhere, isAboutPayload, preload as preloadDecoder } from './threads.mjs';
import { mayBeOurs, unpackIfOurs } from './unpack_tile.mjs';

const MOST_BYTES = 1 << 20;

/** The URL is written here, because bundlers look for it. */
const makeWorker = () => new Worker(new URL('./tile_worker.mjs', import.meta.url), { type: 'module' });

let pool;
let hasWorkers = typeof Worker !== 'undefined';

const tilePool = () => (pool ??= createPool({}, { makeWorker }));

/**
 * Loads what decoding needs, and starts a worker, while the first files are on their way. registerMeshCollapse() calls it; a page that knows
 * earlier that it will show tiles may call it before. Nothing is wrong yet if that fails: decoding tries again.
 */
export async function preload() {
  if (!hasWorkers || !await tilePool().prepare()) await preloadDecoder();
}

/**
 * unpackIfOurs() in a worker, if there are any.
 * @param {Uint8Array} bytes  stay as they are
 * @param {import('./types.mjs').FileLimits} [limits]
 */
export async function unpackAnywhere(bytes, limits) {
  if (!mayBeOurs(bytes)) return bytes;
  if (hasWorkers && bytes.length <= MOST_BYTES) {
    try {
      const { file } = await tilePool().run({ isAtOnce: true }, () => ({ job: { file: bytes, options: { limits } }, moved: [] }));
      return file ?? bytes;
    } catch (error) {
      if (isAboutPayload(error)) throw error;
      hasWorkers = false;
    }
  }
  return unpackIfOurs(bytes, { decode: decodeAnywhere, limits });
}
