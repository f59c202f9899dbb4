// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { asMccError, MccError } from './error.mjs';

/** Reads bytes, or a stream of them, from its beginning to its end. */
export class Chunks {
  #chunks = [];
  #length = 0;
  #next;
  #cancel;
  /** The number of bytes that have been read. */
  position = 0;

  /** @param {Uint8Array | ArrayBuffer | ReadableStream<Uint8Array> | AsyncIterable<Uint8Array>} source */
  constructor(source) {
    if (source instanceof Uint8Array || source instanceof ArrayBuffer) {
      this.#add(source);
      this.#next = async () => ({ done: true });
    } else if (typeof source?.getReader === 'function') {
      const reader = readerOf(source);
      this.#next = () => reader.read();
      this.#cancel = () => reader.cancel();
    } else if (typeof source?.[Symbol.asyncIterator] === 'function') {
      const iterator = source[Symbol.asyncIterator]();
      this.#next = () => iterator.next();
      this.#cancel = () => iterator.return?.();
    } else {
      if (source === null) throw new MccError('the source is null: the response has no body', 'BadArgument');
      throw new MccError('the source must be bytes, a ReadableStream or an async iterable of Uint8Arrays', 'BadArgument');
    }
  }

  /** Returns the next `count` bytes without reading them, or fewer at the end of the source. */
  async peek(count) {
    await this.#fill(count);
    return this.#join(Math.min(count, this.#length));
  }

  /** Reads `count` bytes. They may be a part of the source. */
  async read(count) {
    await this.#fill(count);
    if (this.#length < count) throw new MccError(`the source ends ${count - this.#length} bytes too early`, 'Truncated');
    const bytes = this.#join(count);
    this.#drop(count);
    return bytes;
  }

  /** Passes over `count` bytes. */
  async skip(count) {
    while (count > 0) {
      await this.#fill(1);
      if (this.#length === 0) throw new MccError(`the source ends ${count} bytes too early`, 'Truncated');
      const passed = Math.min(count, this.#length);
      this.#drop(passed);
      count -= passed;
    }
  }

  /** Tells the source that no more is wanted. */
  cancel() {
    const cancel = this.#cancel;
    this.#cancel = undefined;
    // The source may fail while it ends, which is of no interest here.
    Promise.resolve().then(cancel).catch(() => {});
  }

  async #fill(count) {
    while (this.#length < count) {
      const { done, value } = (await this.#next()) ?? {};
      if (done) {
        this.#cancel = undefined;
        return;
      }
      this.#add(value);
    }
  }

  #add(value) {
    const bytes = value instanceof ArrayBuffer ? new Uint8Array(value) : value;
    if (!(bytes instanceof Uint8Array)) throw new MccError('a chunk of the source is not a Uint8Array', 'BadArgument');
    this.#chunks.push(bytes);
    this.#length += bytes.length;
  }

  #join(count) {
    if (count === 0) return new Uint8Array(0);
    if (this.#chunks[0].length >= count) return this.#chunks[0].subarray(0, count);
    const bytes = new Uint8Array(count);
    let at = 0;
    for (const chunk of this.#chunks) {
      const taken = chunk.subarray(0, count - at);
      bytes.set(taken, at);
      at += taken.length;
      if (at === count) break;
    }
    return bytes;
  }

  #drop(count) {
    this.position += count;
    this.#length -= count;
    let whole = 0;
    while (whole < this.#chunks.length && this.#chunks[whole].length <= count) count -= this.#chunks[whole++].length;
    this.#chunks.splice(0, whole);
    if (count > 0) this.#chunks[0] = this.#chunks[0].subarray(count);
  }
}

function readerOf(source) {
  try {
    return source.getReader();
  } catch (error) {
    throw asMccError(error, 'the source cannot be read', 'BadArgument');
  }
}
