// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// For loaders with a hook for buffer views. Every accessor that a payload fills gets a new buffer
// view, which is not in the file; accessors with the same elements share one. Everything a loader
// does with an accessor, including morph targets and normalized integers, then works as usual.
import { asTrap } from './arguments.mjs';
import { Budget, fetchAndDecode, MOST_AT_A_TIME } from './budget.mjs';
import { elementsOf, listOf, originOf, payloadsOf } from './document.mjs';
import { decodeAnywhere, expectWhole, preload } from './threads.mjs';

/** The semantic, A.2.4. */
const TANGENT = 2;
const hasTangents = ({ attributes }) => attributes.some(({ semantic }) => semantic === TANGENT);

export class PayloadViews {
  #sources = new Map(); // by the number of an added buffer view
  #early = []; // functions that decode payloads
  /** Whether accessors have the same elements. */
  hasCopies = false;

  /**
   * @param {object} json a glTF document; it is not changed
   * @param {(bufferView: number) => Promise<Uint8Array>} fetchPayload the bytes of a buffer view of the file
   * @param {import('./unpack.mjs').UnpackOptions} [options] decode: by default where that is done soonest, see threads.mjs
   * @param {(block: object, payload: object) => void} [onBlock] is called with each block of a payload of payloadsOf()
   * @param {(decoded: object, payload: object) => Promise<void>} [onDecoded] may change what has been decoded, and the lists below, before the
   *   loader gets it
   */
  constructor(json, fetchPayload, options, onBlock, onDecoded) {
    const { decode = decodeAnywhere, limits } = options ?? {};
    const payloads = payloadsOf(json);
    const claims = payloads.flatMap((payload) => payload.claims);
    if (decode === decodeAnywhere && claims.length > 0) { // before the payloads are there
      preload(); // if nobody did it earlier
      if (claims.some(hasTangents)) expectWhole();
    }
    /**
     * The lists to use in place of the document's. Existing numbers stay; added buffer views come
     * last.
     */
    this.accessors = [...listOf(json.accessors)];
    this.bufferViews = [...listOf(json.bufferViews)];
    // Only the size of its payloads is known, not that of the file.
    const budget = new Budget(0, limits);
    const turns = new Turns();
    const start = (payload) => turns.call(async () => {
      const decoded = await fetchAndDecode(budget, json, payload, fetchPayload, decode, onBlock && { onBlock: (block) => onBlock(block, payload) });
      await onDecoded?.(decoded, payload);
      return decoded;
    });
    for (const payload of payloads) {
      let decoded;
      // A payload is decoded once, when the first of its accessors is requested.
      const decodeOnce = () => (decoded ??= start(payload));
      this.#early.push(decodeOnce);
      const numbers = new Map(); // numbers of added buffer views, by what they hold
      for (const target of payload.targets) this.#addView(target, decodeOnce, numbers);
    }
  }

  #addView(target, decodeOnce, numbers) {
    const { byteOffset, sparse, ...accessor } = this.accessors[target.accessor];
    const origin = originOf(target, accessor);
    if (numbers.has(origin)) {
      this.hasCopies = true;
    } else {
      const number = this.bufferViews.length;
      numbers.set(origin, number);
      this.bufferViews.push({ buffer: 0, byteLength: 0 });
      this.#sources.set(number, async () => {
        const decoded = await decodeOnce();
        try {
          return elementsOf(decoded, target, accessor);
        } catch (error) {
          throw asTrap(error);
        }
      });
    }
    this.accessors[target.accessor] = { ...accessor, bufferView: numbers.get(origin) };
  }

  /**
   * Decodes the payloads of a document with few before the loader asks for them, which it does when it has made much else; but not where it
   * will ask for coarse levels first.
   */
  begin({ extensionsUsed }) {
    if (this.#early.length > MOST_AT_A_TIME || extensionsUsed?.includes('MSFT_lod')) return;
    for (const decode of this.#early) decode().catch(() => {}); // who asks for it will be told
  }

  /**
   * @param {number} bufferView
   * @returns {Promise<ArrayBufferView> | undefined} the elements of an accessor, tight and in memory of their own; undefined for
   *   the buffer views of the file
   */
  load(bufferView) {
    return this.#sources.get(bufferView)?.();
  }
}

/** Calls functions a few at a time, in their order: loaders ask for all buffer views at once. */
class Turns {
  #running = 0;
  #waiting = [];
  #next = 0;

  async call(work) {
    // Who ends passes its turn on.
    if (this.#running === MOST_AT_A_TIME) await new Promise((resolve) => { this.#waiting.push(resolve); });
    else ++this.#running;
    try {
      return await work();
    } finally {
      if (this.#next < this.#waiting.length) this.#waiting[this.#next++]();
      else --this.#running;
    }
  }
}
