// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes and numbers the blocks of a payload with the whole decoder. It does not load anything, so
// that workers need no other module.
import { asTrap, limitsOf } from './arguments.mjs';
import { check, describe, instanceOf } from './core.mjs';

const TRUNCATED = 1;
const NOT_IN_CORE = 255;
const OUT_OF_MEMORY = 11;
/** Words of the table of blocks, see src/decoder.cpp. */
const BLOCK_WORDS = 11;

/** An instance of the decoder for one payload with blocks. */
export class BlockDecoder {
  #exports;
  #address = 0;

  /** @param {WebAssembly.Module} module the core is refused */
  static async make(module) {
    const decoder = new BlockDecoder();
    decoder.#exports = (await instanceOf(module)).exports;
    if (decoder.#exports.open_prefix === undefined) check(NOT_IN_CORE);
    return decoder;
  }

  /**
   * Opens the beginning of a payload.
   * @param {Uint8Array} prefix
   * @param {number} payloadBytes the size of the whole payload
   * @param {object} [limits]
   * @param {boolean} [decodes] makes room for the whole payload, for put()
   * @returns what the header says: a DecodedPayload without arrays, with `headerBytes` and `blocks`; null if the header is
   *   longer than the prefix
   */
  open(prefix, payloadBytes, limits, decodes = false) {
    return this.#guard((exports) => {
      exports.release(this.#address);
      const room = decodes ? payloadBytes : prefix.length;
      this.#address = room < 2 ** 31 ? exports.allocate(room) : 0;
      if (this.#address === 0) check(OUT_OF_MEMORY);
      this.put(0, prefix);
      const error = exports.open_prefix(this.#address, room, payloadBytes, ...limitsOf(limits));
      if (error === TRUNCATED && prefix.length < payloadBytes) return null;
      check(error);
      return { ...describe(exports), ...readBlocks(exports) };
    });
  }

  /** Puts bytes of the payload where they belong. */
  put(offset, bytes) {
    new Uint8Array(this.#exports.memory.buffer, this.#address + offset, bytes.length).set(bytes);
  }

  /**
   * Decodes a block with numbers of its own. The bytes of block 0 and of the block must have been put.
   * @returns {{ wedgeCount: number, attributes: object[], parts: object[], rim?: { wedges: Uint32Array, tuples: Int32Array } }}
   */
  decode(index, { indexType, findsRim }) {
    return this.#guard((exports) => {
      check(exports.decode_block(index, indexType === 'uint32' ? 0 : 1, findsRim ? 1 : 0));
      const [{ wedgeCount, attributes, parts }] = describe(exports, true).pieces;
      if (!findsRim) return { wedgeCount, attributes, parts };
      const { buffer } = exports.memory;
      const wedges = new Uint32Array(buffer, exports.rim_wedges(), exports.rim_count()).slice();
      const tuples = new Int32Array(buffer, exports.rim_tuples(), exports.rim_words()).slice();
      return { wedgeCount, attributes, parts, rim: { wedges, tuples } };
    });
  }

  /**
   * Numbers the wedges of the next block, beginning with block 0.
   * @returns {Uint32Array} by wedge of the block, its number in the piece
   */
  number(wedgeCount, { wedges, tuples }) {
    return this.#guard((exports) => {
      const address = exports.allocate(4 * (wedges.length + tuples.length));
      if (address === 0) check(OUT_OF_MEMORY);
      new Uint32Array(exports.memory.buffer, address, wedges.length).set(wedges);
      const second = address + 4 * wedges.length;
      new Int32Array(exports.memory.buffer, second, tuples.length).set(tuples);
      const error = exports.number_block(address, wedges.length, second, tuples.length);
      exports.release(address);
      check(error);
      return new Uint32Array(exports.memory.buffer, exports.numbers(), wedgeCount).slice();
    });
  }

  #guard(work) {
    try {
      return work(this.#exports);
    } catch (error) {
      throw asTrap(error);
    }
  }
}

function readBlocks(exports) {
  const { buffer } = exports.memory;
  const [headerBytes, count] = new Uint32Array(buffer, exports.blocks(), 2);
  const blocks = Array.from({ length: count }, (_, index) => {
    const at = exports.blocks() + 4 * (2 + BLOCK_WORDS * index);
    const [wedgeCount, repeatedCount, triangleCount, offset, bytes] = new Uint32Array(buffer, at, 5);
    const numbers = [...new Float32Array(buffer, at + 20, 6)];
    return { wedgeCount, repeatedCount, triangleCount, offset, bytes, box: { min: numbers.slice(0, 3), max: numbers.slice(3) } };
  });
  return { headerBytes, blocks };
}

/**
 * Does a task: decodes a block of one of several payloads. The payload's decoder is kept in
 * `decoders`, by its key. A task is { key, index, offset, bytes, indexType, findsRim }, and the first of a payload
 * has also `opening`: { prefix, payloadBytes, limits }, where the prefix is the header with block 0.
 */
export async function runTask(decoders, module, { key, opening, index, offset, bytes, ...options }) {
  let decoder = decoders.get(key);
  if (opening !== undefined) {
    decoder = await BlockDecoder.make(module);
    decoder.open(opening.prefix, opening.payloadBytes, opening.limits, true);
    decoders.set(key, decoder);
  }
  if (bytes !== undefined) decoder.put(offset, bytes);
  return decoder.decode(index, options);
}

/** Returns the buffers of what runTask() has returned, to be transferred by postMessage(). */
export function buffersOfBlock({ attributes, parts, rim }) {
  const arrays = [...attributes.map(({ array }) => array), ...parts.map(({ indices }) => indices)];
  if (rim !== undefined) arrays.push(rim.wedges, rim.tuples);
  return arrays.map(({ buffer }) => buffer);
}
