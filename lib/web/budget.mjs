// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Limits what all payloads of a file may decode to, before memory is allocated, and how many are under way at a time.
import { componentBytes, limitOf, limitsOf } from './arguments.mjs';
import { fail, inView, MccError, placed, requireArgument } from './error.mjs';

/** More than there are workers, so that each has something to do. */
export const MOST_AT_A_TIME = 16;

/**
 * Returns the number of bytes that the document names of a payload: each attribute and each part
 * once, with 32-bit indices.
 */
export function namedBytes({ claims }) {
  const sizes = new Map();
  for (const { piece, part, indices, attributes } of claims) {
    sizes.set(`${piece} part ${part}`, 4 * indices.count);
    for (const { attribute, accessor, componentType, componentCount } of attributes) {
      // Of a type that no payload has, the header tells later.
      sizes.set(`${piece} ${attribute}`, accessor.count * componentCount * (componentBytes(componentType) ?? 8));
    }
  }
  return sum([...sizes.values()]);
}

export const sum = (numbers) => numbers.reduce((total, number) => total + number, 0);

/** The number of bytes that a payload has decoded to, with 32-bit indices. */
export const bytesOf = ({ pieces }) => sum(pieces.flatMap(({ attributes, parts }) => [
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
  constructor(fileBytes, limits) {
    limitsOf(limits); // checks them
    this.#max = limitOf(limits, 'maxDecodedBytes');
    const { maxDecodedBytes, ...others } = limits ?? {};
    this.#limits = others;
    this.fileBytes = fileBytes;
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

  /** Decodes a payload whose namedBytes() have been added. */
  async decode(payload, bytes, decode, options) {
    try {
      return this.settle(payload, typeof decode === 'function' && await decode(bytes, { ...this.optionsFor(payload), ...options }));
    } catch (error) {
      throw inView(error, payload.bufferView);
    }
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
    requireArgument(Array.isArray(decoded?.pieces), 'decode must do what decodePayload() does');
    this.add(Math.max(0, bytesOf(decoded) - namedBytes(payload)));
    return decoded;
  }
}

/** Calls an asynchronous function for each entry of a list, a few at a time, and for none any more after one has failed. */
export async function forAll(list, work) {
  const results = [];
  let next = 0;
  const workOn = async () => {
    while (next < list.length) {
      const i = next++;
      results[i] = await work(list[i]);
    }
  };
  try {
    await Promise.all(Array.from({ length: MOST_AT_A_TIME }, workOn));
  } finally {
    next = list.length;
  }
  return results;
}

/** Fetches a payload whose namedBytes() have not been added, and decodes it. Errors have the name of its file, if it has one. */
export async function fetchAndDecode(budget, json, payload, fetchView, decode, options) {
  const { bufferView } = payload;
  const { buffer, byteLength } = json.bufferViews[bufferView];
  const bytes = await fetchView(bufferView);
  try {
    if (bytes?.length !== byteLength) fail(`/bufferViews/${bufferView}`, 'reaches beyond its buffer');
    budget.fileBytes += bytes.length;
    budget.add(namedBytes(payload));
    return await budget.decode(payload, bytes, decode, options);
  } catch (error) {
    const { uri = 'data:' } = json.buffers?.[buffer] ?? {};
    throw uri.startsWith('data:') ? error : placed(error, uri);
  }
}
