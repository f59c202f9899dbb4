// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// For loaders with a hook for buffer views. Each accessor that a payload fills gets a buffer view of its own, which is not in the
// file, one for those that get the same elements; all that a loader does with an accessor, morph targets and normalized integers included, works on it as on any other.
import { Budget, namedBytes } from './budget.mjs';
import { fail } from './claims.mjs';
import { elementsOf, originOf, payloadsOf } from './document.mjs';
import { decodeInWorkers } from './workers.mjs';

export class PayloadViews {
  #sources = new Map(); // by the number of an added buffer view

  /**
   * @param {object} json a glTF document; it is not changed
   * @param {(bufferView: number) => Promise<Uint8Array>} fetchPayload the bytes of a buffer view of the file
   * @param {import('./unpack.mjs').UnpackOptions} [options] decode: by default in workers that all loaders of a page share
   */
  constructor(json, fetchPayload, { decode = decodeInWorkers, limits } = {}) {
    /** Those of the document, to be used in their place. Numbers stay; what is new is behind the others. */
    this.accessors = [...(json.accessors ?? [])];
    this.bufferViews = [...(json.bufferViews ?? [])];
    const budget = new Budget(0, limits); // the size of the file is not known, but that of its payloads
    const fetchAndDecode = async (payload) => {
      const { bufferView } = payload;
      const bytes = await fetchPayload(bufferView);
      if (bytes.length !== json.bufferViews[bufferView].byteLength) fail(`/bufferViews/${bufferView}`, 'reaches beyond its buffer');
      budget.fileBytes += bytes.length;
      budget.add(namedBytes(payload));
      return budget.settle(payload, await decode(bytes, budget.optionsFor(payload)));
    };
    for (const payload of payloadsOf(json)) {
      let decoded;
      // A payload is decoded when the first of its accessors is asked for, and once.
      const decodeOnce = () => (decoded ??= fetchAndDecode(payload));
      const numbers = new Map(); // of added buffer views, by what they hold
      for (const target of payload.targets) this.#addView(target, decodeOnce, numbers);
    }
  }

  #addView(target, decodeOnce, numbers) {
    const { byteOffset, sparse, ...accessor } = this.accessors[target.accessor];
    const origin = originOf(target, accessor);
    if (!numbers.has(origin)) {
      const number = this.bufferViews.length;
      numbers.set(origin, number);
      this.bufferViews.push({ buffer: 0, byteLength: 0 });
      this.#sources.set(number, async () => elementsOf(await decodeOnce(), target, accessor));
    }
    this.accessors[target.accessor] = { ...accessor, bufferView: numbers.get(origin) };
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
