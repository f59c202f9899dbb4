// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Makes files without the extension in a worker, which does everything with a tile: it decodes, and writes what engines read. The page's
// thread only sends and gets bytes. Files are sent when they are there: engines keep that thread so busy that a worker that waited for its
// next file would do nothing half of the time.
import { asMccError, MccError } from './error.mjs';
import { pageSource } from './source.mjs';
import { decodeAnywhere, preload as preloadDecoder } from './threads.mjs';
import { mayBeOurs, unpackIfOurs } from './unpack_tile.mjs';

/** Of larger files the payloads are decoded on several threads, and surfaces in blocks too. */
const MOST_BYTES = 1 << 20;

let worker;
let hasWorker = typeof Worker !== 'undefined';

/**
 * Loads what decoding needs, and starts a worker, while the first files are on their way. registerMeshCollapse() calls it; a page that knows
 * earlier that it will show tiles may call it before. Nothing is wrong yet if that fails: decoding tries again.
 */
export async function preload() {
  try {
    if (hasWorker) worker ??= new TileWorker();
  } catch {
    hasWorker = false;
  }
  if (!hasWorker) await preloadDecoder();
}

/**
 * unpackIfOurs() where that holds up the page least. Where no worker can start, that is this thread.
 * @param {Uint8Array} bytes  stay as they are
 * @param {import('./types.mjs').FileLimits} [limits]
 */
export async function unpackAnywhere(bytes, limits) {
  if (!mayBeOurs(bytes)) return bytes;
  if (hasWorker && bytes.length <= MOST_BYTES) {
    try {
      worker ??= new TileWorker();
      return await worker.unpack(bytes, limits) ?? bytes;
    } catch (error) {
      if (error instanceof MccError && error.code !== 'Load') throw error;
      hasWorker = false;
    }
  }
  return unpackIfOurs(bytes, { decode: decodeAnywhere, limits });
}

class TileWorker {
  #jobs = new Map();
  #nextId = 0;
  #worker = new Worker(new URL('./tile_worker.mjs', import.meta.url), { type: 'module' });

  constructor() {
    this.#worker.onmessage = ({ data: { id, file, message, code } }) => {
      const { resolve, reject } = this.#jobs.get(id);
      this.#jobs.delete(id);
      if (message === undefined) resolve(file);
      else reject(new MccError(message, code));
    };
    this.#worker.onerror = this.#worker.onmessageerror = (error) => this.#lose(error);
    this.#worker.postMessage({ where: sendable(pageSource().where) });
  }

  /** Resolves with the new file, or with nothing if it stays as it is. */
  unpack(bytes, limits) {
    return new Promise((resolve, reject) => {
      const id = this.#nextId++;
      try {
        this.#worker.postMessage({ id, bytes, limits });
        this.#jobs.set(id, { resolve, reject });
      } catch (error) {
        reject(asMccError(error, 'the file cannot be sent to a worker', 'BadArgument'));
      }
    });
  }

  #lose(error) {
    this.#worker.terminate();
    for (const { reject } of this.#jobs.values()) reject(asMccError(error, 'the worker failed', 'Load'));
    this.#jobs.clear();
    hasWorker = false;
  }
}

/** Options of init() with URLs as the page means them. */
const sendable = (where) => Object.fromEntries(Object.entries(where).map(
  ([name, value]) => [name, name.endsWith('Url') && value !== undefined ? new URL(value, globalThis.document?.baseURI).href : value]));
