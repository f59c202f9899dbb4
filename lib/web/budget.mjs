// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What all payloads of a file may decode to, checked before memory is taken.
import { MccError } from './error.mjs';

const BYTES = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };

/** As decodedLimit() of the C++ library. */
const defaultLimit = (fileBytes) => Math.min(2 ** 32, Math.max(2 ** 28, 1024 * fileBytes));

/** Bytes of what the document names of a payload, each attribute and each part once; indices of 32 bits. */
export function namedBytes({ claims }) {
  const sizes = new Map();
  for (const { piece, part, indices, attributes } of claims) {
    sizes.set(`${piece} part ${part}`, 4 * indices.count);
    for (const { attribute, accessor, componentType, componentCount } of attributes) {
      sizes.set(`${piece} ${attribute}`, accessor.count * componentCount * BYTES[componentType]);
    }
  }
  return [...sizes.values()].reduce((sum, size) => sum + size, 0);
}

const bytesOf = ({ pieces }) => pieces.reduce((sum, { attributes, parts }) => (
  sum + attributes.reduce((bytes, { array }) => bytes + array.byteLength, 0)
    + parts.reduce((bytes, { triangleCount }) => bytes + 12 * triangleCount, 0)), 0);

export class Budget {
  #limits;
  #max;
  #fileBytes;
  #total = 0;

  /**
   * @param {number} fileBytes
   * @param {import('./types.mjs').FileLimits} [limits]
   */
  constructor(fileBytes, { maxDecodedBytes, ...limits } = {}) {
    this.#fileBytes = fileBytes;
    this.#max = maxDecodedBytes;
    this.#limits = limits;
  }

  /** More of the file became known. */
  addFile(bytes) {
    this.#fileBytes += bytes;
  }

  /** Counts what is going to be decoded, or copied. Throws an MccError if that is too much. */
  add(bytes) {
    if (!(bytes <= this.#room)) this.#refuse(this.#total + bytes);
    this.#total += bytes;
  }

  /** `decode`s a payload, whose namedBytes() were added. What the document does not name of it counts, too. */
  async decode(decode, payload, bytes) {
    try {
      return this.#check(payload, await decode(bytes, this.#optionsOf(payload)));
    } catch (error) {
      return this.#explain(error);
    }
  }

  decodeSync(decode, payload, bytes) {
    try {
      return this.#check(payload, decode(bytes, this.#optionsOf(payload)));
    } catch (error) {
      return this.#explain(error);
    }
  }

  #optionsOf(payload) {
    const maxOutputBytes = Math.min(this.#limits.maxOutputBytes ?? Infinity, namedBytes(payload) + this.#room);
    return { claims: payload.claims, limits: { ...this.#limits, maxOutputBytes } };
  }

  #check(payload, decoded) {
    this.add(Math.max(0, bytesOf(decoded) - namedBytes(payload)));
    return decoded;
  }

  #explain(error) {
    const isOfCaller = Object.values(this.#limits).some((limit) => limit !== undefined);
    if (error.code === 'Limit' && !isOfCaller && !error.message.includes('maxDecodedBytes')) this.#refuse(`more than ${this.#total}`);
    throw error;
  }

  get #limit() {
    return this.#max ?? defaultLimit(this.#fileBytes);
  }

  get #room() {
    return this.#limit - this.#total;
  }

  #refuse(total) {
    throw new MccError(`its ${this.#fileBytes} bytes ask for ${total} bytes of decoded geometry; the limit is ${this.#limit}, `
      + 'which limits.maxDecodedBytes raises', 'Limit');
  }
}
