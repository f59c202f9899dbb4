// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes payloads with a compiled WebAssembly module. It does not load anything, so that workers
// need no other module.
import { ARRAYS, asTrap, checkBytes, checkIndexType, limitsOf } from './arguments.mjs';
import { checkClaims } from './claims.mjs';
import { MccError } from './error.mjs';

/**
 * Kinds of errors, indexed by number - 1: the name in the specification (A.1.4), and what is wrong
 * with the payload.
 */
const ERRORS = Object.entries({
  Truncated: 'ends inside a field or a stream',
  BadMagic: 'is not a mesh collapse payload',
  UnsupportedVersion: 'is of a version of the format that this decoder does not know: compress its source again',
  BadChecksum: 'is damaged: its checksum does not match',
  BadHeader: 'has a malformed header',
  BadConnectivity: 'has malformed connectivity',
  BadStitch: 'has malformed stitching',
  BadAttribute: 'has a malformed attribute',
  TrailingBytes: 'has bytes left over after a stream',
  Limit: 'has more than the limits allow',
  OutOfMemory: 'needs more memory than is available',
});
const OUT_OF_MEMORY = ERRORS.length;
/** The error of the core alone, number 255, see format/decodes.h. */
const NOT_IN_CORE = ['NotInCore', 'needs the whole decoder'];

/** In the order of the component types in a payload's header. */
const COMPONENT_TYPES = Object.keys(ARRAYS).map(Number);

/**
 * An instance whose memory has grown beyond this is dropped after it has been idle for a while,
 * because its memory cannot shrink. It is not dropped at once: large payloads often come one after
 * another, and allocating fresh memory takes up to a third of the time.
 */
const KEPT_BYTES = 64 << 20;
const KEPT_MILLISECONDS = 1000;

export class Decoder {
  #instance = null;
  #instantiating = null;
  #pending = 0;
  #timer = null;

  constructor(module) {
    this.module = module;
  }

  /** Makes the instance before it is needed. */
  async prepare() {
    while (this.#instance === null) await this.#instantiate();
  }

  async decode(bytes, options) {
    ++this.#pending;
    try {
      await this.prepare();
      return this.decodeSync(bytes, options);
    } finally {
      --this.#pending;
      this.#giveBackLater();
    }
  }

  decodeSync(bytes, options) {
    try {
      this.#instance ??= new WebAssembly.Instance(this.module);
      return decodeWith(this.#instance.exports, bytes, options ?? {});
    } catch (error) {
      if (!(error instanceof MccError)) this.#instance = null; // after a trap, its memory may be in any state
      throw asTrap(error);
    } finally {
      this.#giveBackLater();
    }
  }

  /** Makes the instance. Calls that come before it is there wait for the same one. */
  #instantiate() {
    this.#instantiating ??= instanceOf(this.module)
      .then((instance) => { this.#instance ??= instance; })
      .finally(() => { this.#instantiating = null; });
    return this.#instantiating;
  }

  #giveBackLater() {
    clearTimeout(this.#timer);
    if (this.#pending === 0 && this.#instance?.exports.memory.buffer.byteLength > KEPT_BYTES) {
      this.#timer = setTimeout(() => { this.#instance = null; }, KEPT_MILLISECONDS);
      this.#timer.unref?.(); // Node: the timer must not keep the program alive
    }
  }
}

/** Makes an instance of a module. */
export async function instanceOf(module) {
  try {
    return await WebAssembly.instantiate(module);
  } catch (error) {
    throw asTrap(error);
  }
}

function decodeWith(exports, bytes, { limits, indexType = 'auto', claims }) {
  checkBytes(bytes);
  const numbers = limitsOf(limits);
  const address = exports.allocate(bytes.length);
  if (address === 0) check(OUT_OF_MEMORY);
  let closes = true;
  try {
    new Uint8Array(exports.memory.buffer, address, bytes.length).set(bytes);
    check(exports.open(address, bytes.length, ...numbers));
    const info = describe(exports);
    if (claims !== undefined) checkClaims(info, claims);
    checkIndexType(indexType, info.pieces);
    check(exports.decode(indexType === 'uint32' ? 0 : 1));
    return describe(exports, true);
  } catch (error) {
    closes = error instanceof MccError;
    throw error;
  } finally {
    if (closes) exports.close(address);
  }
}

/** Throws the reader's error, if `number` is one. */
export function check(number) {
  if (number === 0) return;
  const [code, what] = ERRORS[number - 1] ?? NOT_IN_CORE;
  throw new MccError(`the payload ${what}`, code);
}

/**
 * Reads the header: a DecodedPayload, without its arrays unless `isDecoded`. The words are described in
 * src/decoder.cpp.
 */
export function describe(exports, isDecoded) {
  const { buffer } = exports.memory;
  const words = new Uint32Array(buffer, exports.table());
  let at = 0;
  const list = (count, read) => Array.from({ length: count }, read);
  const copyOf = (ArrayType, address, length) => (isDecoded ? new ArrayType(buffer, address, length).slice() : undefined);
  const pieces = list(words[at++], () => {
    const [wedgeCount, vertexCount, attributeCount, partCount] = words.subarray(at, (at += 4));
    const attributes = list(attributeCount, () => {
      const [semantic, set, type, normalized, componentCount, morphTarget, address, bits, grid] = words.subarray(at, (at += 9));
      const componentType = COMPONENT_TYPES[type];
      const array = copyOf(ARRAYS[componentType], address, wedgeCount * componentCount);
      const lattice = grid ? [...new Float32Array(buffer, grid, 5)] : undefined;
      return { semantic, set, morphTarget, componentType, componentCount, normalized: normalized === 1, bits, lattice, array };
    });
    const parts = list(partCount, () => {
      const [triangleCount, indexBytes, address] = words.subarray(at, (at += 3));
      return { triangleCount, indices: copyOf(indexBytes === 2 ? Uint16Array : Uint32Array, address, 3 * triangleCount) };
    });
    return { wedgeCount, vertexCount, attributes, parts };
  });
  return { pieces };
}

/** Returns the buffers of a DecodedPayload, to be transferred by postMessage(). */
export function buffersOf({ pieces }) {
  return pieces.flatMap(({ attributes, parts }) => [
    ...attributes.map(({ array }) => array.buffer),
    ...parts.map(({ indices }) => indices.buffer),
  ]);
}
