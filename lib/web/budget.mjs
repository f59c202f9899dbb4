// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Limits what all payloads of a file may decode to. It is checked before memory is allocated.
import { MccError } from './error.mjs';

/**
 * Returns the number of bytes that the document names of a payload: each attribute and each part
 * once, with 32-bit indices.
 */
export function namedBytes({ claims }) {
  const sizes = new Map();
  for (const { piece, part, indices, attributes } of claims) {
    sizes.set(`${piece} part ${part}`, 4 * indices.count);
    for (const { attribute, accessor, componentType, componentCount } of attributes) {
      const componentBytes = componentType < 5122 ? 1 : componentType < 5124 ? 2 : 4;
      sizes.set(`${piece} ${attribute}`, accessor.count * componentCount * componentBytes);
    }
  }
  return sum([...sizes.values()]);
}

export const sum = (numbers) => numbers.reduce((total, number) => total + number, 0);

const bytesOf = ({ pieces }) => sum(pieces.flatMap(({ attributes, parts }) => [
  ...attributes.map(({ array }) => array.byteLength), ...parts.map(({ triangleCount }) => 12 * triangleCount)]));

/** What may still be decoded. `fileBytes` may grow while more of the file becomes known. */
export class Budget {
  #limits;
  #max;
  #total = 0;

  /**
   * @param {number} fileBytes
   * @param {import('./types.mjs').FileLimits} [limits]
   */
  constructor(fileBytes, { maxDecodedBytes, ...limits } = {}) {
    this.fileBytes = fileBytes;
    this.#limits = limits;
    this.#max = maxDecodedBytes;
  }

  /** The same as decodedLimit() of the C++ library. */
  get #limit() {
    return this.#max ?? Math.min(2 ** 32, Math.max(2 ** 28, 1024 * this.fileBytes));
  }

  /**
   * Counts bytes that are about to be decoded or copied. Throws an MccError if they are too many.
   */
  add(bytes) {
    const total = this.#total + bytes;
    if (!(total <= this.#limit)) {
      throw new MccError(`its ${this.fileBytes} bytes decode to ${total}, more than limits.maxDecodedBytes: ${this.#limit}`, 'Limit');
    }
    this.#total = total;
  }

  /**
   * Returns the options of decodePayload() for a payload whose namedBytes() have been added.
   * Outputs that the document does not name must fit in what is left.
   */
  optionsFor(payload) {
    const maxOutputBytes = Math.min(this.#limits.maxOutputBytes ?? Infinity, namedBytes(payload) + this.#limit - this.#total);
    return { claims: payload.claims, limits: { ...this.#limits, maxOutputBytes } };
  }

  /** Counts the outputs that the document does not name, and returns `decoded`. */
  settle(payload, decoded) {
    this.add(Math.max(0, bytesOf(decoded) - namedBytes(payload)));
    return decoded;
  }
}
