// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Loads a GLB and shows what is in it before all of it is there.
import { MccError, requireArgument } from './error.mjs';
import { blocksIn } from './glb_blocks.mjs';
import { decodeBlocksAnywhere, expectWhole, preloadBlocks } from './threads.mjs';

/**
 * Loads a GLB, see load_glb.d.mts.
 *
 * @param {string | URL | Uint8Array | ArrayBuffer | ReadableStream<Uint8Array> | AsyncIterable<Uint8Array>} source a place, or the file
 * @param {object} [options]
 * @returns {Promise<Uint8Array>} the file as it came
 */
export async function loadGlb(source, options) {
  const { onDocument, onPreview, onBlock, signal, decodeBlocks = decodeBlocksAnywhere, ...others } = options ?? {};
  for (const [name, call] of Object.entries({ onDocument, onPreview, onBlock })) {
    requireArgument(call === undefined || typeof call === 'function', `${name} must be a function`);
  }
  signal?.throwIfAborted();
  const isAnywhere = (onPreview ?? onBlock) !== undefined && decodeBlocks === decodeBlocksAnywhere;
  if (isAnywhere) preloadBlocks();
  const isPlace = typeof source === 'string' || source instanceof URL;
  const kept = new KeptSource(isPlace ? await bodyOf(source, signal) : source, signal);
  try {
    const wanted = { onDocument, wantsPreviews: onPreview !== undefined, wantsBlocks: onBlock !== undefined };
    if ([onDocument, onPreview, onBlock].some((call) => call !== undefined)) {
      for await (const block of blocksIn(kept, { ...others, signal, decodeBlocks }, wanted)) {
        (block.isPreview ? onPreview : onBlock)(block);
        if (block.isPreview && isAnywhere) expectWhole(); // what has a preview is large
      }
    }
    return await kept.all();
  } finally {
    kept.cancel();
  }
}

async function bodyOf(place, signal) {
  const response = await fetch(place, { signal });
  if (!response.ok) throw new MccError(`cannot load ${place}: status ${response.status}`, 'Load');
  return response.body;
}

/** A source that keeps what is read of it. Whoever reads it may stop; the rest is read by all(). */
class KeptSource {
  #chunks = [];
  #iterator;
  #isAtEnd = false;
  #aborted;
  #stopListening = () => {};

  constructor(source, signal) {
    this.#iterator = iteratorOf(source);
    if (signal === undefined) return;
    this.#aborted = new Promise((_, reject) => {
      const listener = () => reject(signal.reason);
      signal.addEventListener('abort', listener);
      this.#stopListening = () => signal.removeEventListener('abort', listener);
    });
    this.#aborted.catch(() => {});
  }

  [Symbol.asyncIterator]() {
    return { next: () => this.#next() };
  }

  async #next() {
    const next = this.#iterator.next();
    const { done, value } = await (this.#aborted === undefined ? next : Promise.race([this.#aborted, next]));
    this.#isAtEnd = done === true;
    if (done) return { done, value };
    const chunk = value instanceof ArrayBuffer ? new Uint8Array(value) : value;
    requireArgument(chunk instanceof Uint8Array, 'a chunk of the source is not a Uint8Array');
    this.#chunks.push(chunk);
    return { done: false, value: chunk };
  }

  /** Returns all bytes. */
  async all() {
    while (!this.#isAtEnd) await this.#next();
    const bytes = new Uint8Array(this.#chunks.reduce((sum, { length }) => sum + length, 0));
    let at = 0;
    for (const chunk of this.#chunks) {
      bytes.set(chunk, at);
      at += chunk.length;
    }
    return bytes;
  }

  /** Tells the source that no more is wanted, unless it has ended. */
  cancel() {
    this.#stopListening();
    this.#chunks = [];
    // The source may fail while it ends, which is of no interest here.
    if (!this.#isAtEnd) Promise.resolve().then(() => this.#iterator.return?.()).catch(() => {});
  }
}

function iteratorOf(source) {
  if (source instanceof Uint8Array || source instanceof ArrayBuffer) return [source][Symbol.iterator]();
  if (typeof source?.getReader === 'function') {
    const reader = source.getReader();
    return { next: () => reader.read(), return: () => reader.cancel() };
  }
  requireArgument(typeof source?.[Symbol.asyncIterator] === 'function',
    'the source must be a URL, bytes, a ReadableStream or an async iterable of Uint8Arrays');
  return source[Symbol.asyncIterator]();
}
