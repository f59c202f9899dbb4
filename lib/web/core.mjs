// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes payloads with a compiled WebAssembly module. It does not load anything, so that workers
// need no other module.
import { checkClaims } from './claims.mjs';
import { MccError } from './error.mjs';

/**
 * Kinds of errors, indexed by number - 1: the name in the specification (A.1.4), and what is wrong
 * with the payload.
 */
const ERRORS = [
  ['Truncated', 'ends inside a field or a stream'],
  ['BadMagic', 'is not a mesh collapse payload'],
  ['UnsupportedVersion', 'is of a version of the format that this decoder does not know: compress its source again'],
  ['BadChecksum', 'is damaged: its checksum does not match'],
  ['BadHeader', 'has a malformed header'],
  ['BadConnectivity', 'has malformed connectivity'],
  ['BadStitch', 'has malformed stitching'],
  ['BadAttribute', 'has a malformed attribute'],
  ['TrailingBytes', 'has bytes left over after a stream'],
  ['Limit', 'has more than the limits allow'],
  ['OutOfMemory', 'needs more memory than is available'],
];
const OUT_OF_MEMORY = ERRORS.length;
/** The error of the core alone, number 255, see format/decodes.h. */
const NOT_IN_CORE = ['NotInCore', 'needs the whole decoder'];
const LIMITS = ['maxVertices', 'maxTriangles', 'maxAttributes', 'maxPieces', 'maxElements', 'maxOutputBytes'];

/** Component types of glTF and array types, by the component type in the payload's header. */
const COMPONENT_TYPES = [
  [5120, Int8Array], [5121, Uint8Array], [5122, Int16Array], [5123, Uint16Array], [5125, Uint32Array],
  [5126, Float32Array],
];

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

  async decode(bytes, options) {
    ++this.#pending;
    try {
      while (this.#instance === null) await this.#instantiate();
      return this.decodeSync(bytes, options);
    } finally {
      --this.#pending;
      this.#giveBackLater();
    }
  }

  decodeSync(bytes, options = {}) {
    this.#instance ??= new WebAssembly.Instance(this.module);
    const exports = this.#instance.exports;
    try {
      return decodeWith(exports, bytes, options);
    } catch (error) {
      if (error instanceof MccError) throw error;
      this.#instance = null; // after a trap, its memory may be in any state
      throw new MccError(`the decoder failed (${error.message}); there may be too little memory`, 'Trap');
    } finally {
      this.#giveBackLater();
    }
  }

  /** Makes the instance. Calls that come before it is there wait for the same one. */
  #instantiate() {
    this.#instantiating ??= WebAssembly.instantiate(this.module)
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

function decodeWith(exports, bytes, { limits = {}, indexType = 'auto', claims }) {
  if (!(bytes instanceof Uint8Array)) throw new MccError('the payload must be a Uint8Array', 'BadArgument');
  if (!['auto', 'uint16', 'uint32'].includes(indexType)) {
    throw new MccError(`indexType is '${indexType}', but must be auto, uint16 or uint32`, 'BadArgument');
  }
  const address = exports.allocate(bytes.length);
  if (address === 0) check(OUT_OF_MEMORY);
  let closes = true;
  try {
    new Uint8Array(exports.memory.buffer, address, bytes.length).set(bytes);
    check(exports.open(address, bytes.length, ...limitsOf(limits)));
    const info = describe(exports);
    if (claims !== undefined) checkClaims(info, claims);
    if (indexType === 'uint16' && info.pieces.some((piece) => piece.wedgeCount > 0xffff)) {
      throw new MccError('a piece has too many vertices for 16-bit indices', 'BadArgument');
    }
    check(exports.decode(indexType === 'uint32' ? 0 : 1));
    takeOutputs(exports, info);
    return info;
  } catch (error) {
    closes = error instanceof MccError;
    throw error;
  } finally {
    if (closes) exports.close(address);
  }
}

/** The limits as arguments of the exports. */
export const limitsOf = (limits = {}) => LIMITS.map((name) => limits[name] ?? Infinity);

/** Throws the reader's error, if `number` is one. */
export function check(number) {
  if (number === 0) return;
  const [code, what] = ERRORS[number - 1] ?? NOT_IN_CORE;
  throw new MccError(`the payload ${what}`, code);
}

/**
 * Reads the header: a DecodedPayload without its arrays. The words are described in
 * src/decoder.cpp.
 */
export function describe(exports) {
  const words = new Uint32Array(exports.memory.buffer, exports.table());
  let at = 0;
  const list = (count, read) => Array.from({ length: count }, read);
  const pieces = list(words[at++], () => {
    const [wedgeCount, vertexCount, attributeCount, partCount] = words.subarray(at, (at += 4));
    const attributes = list(attributeCount, () => {
      const [semantic, set, type, normalized, componentCount, morphTarget] = words.subarray(at, (at += 7));
      const componentType = COMPONENT_TYPES[type][0];
      return { semantic, set, morphTarget, componentType, componentCount, normalized: normalized === 1 };
    });
    const parts = list(partCount, () => {
      const triangleCount = words[at];
      at += 3;
      return { triangleCount };
    });
    return { wedgeCount, vertexCount, attributes, parts };
  });
  return { pieces };
}

/** Copies the outputs from the addresses that decode() has put into the table. */
export function takeOutputs(exports, info) {
  const buffer = exports.memory.buffer;
  const words = new Uint32Array(buffer, exports.table());
  let at = 1;
  for (const piece of info.pieces) {
    at += 4;
    for (const attribute of piece.attributes) {
      const ArrayType = COMPONENT_TYPES[words[at + 2]][1];
      attribute.array = new ArrayType(buffer, words[at + 6], piece.wedgeCount * attribute.componentCount).slice();
      at += 7;
    }
    for (const part of piece.parts) {
      const ArrayType = words[at + 1] === 2 ? Uint16Array : Uint32Array;
      part.indices = new ArrayType(buffer, words[at + 2], 3 * part.triangleCount).slice();
      at += 3;
    }
  }
}

/** Returns the buffers of a DecodedPayload, to be transferred by postMessage(). */
export function buffersOf({ pieces }) {
  return pieces.flatMap(({ attributes, parts }) => [
    ...attributes.map(({ array }) => array.buffer),
    ...parts.map(({ indices }) => indices.buffer),
  ]);
}
