// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// For loaders with a hook for buffer views. Each accessor that a payload fills gets a buffer view of its own, which is not in the
// file; all that a loader does with an accessor, morph targets and normalized integers included, works on it as on any other.
import { elementsOf, payloadsOf } from './document.mjs';
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
    for (const { bufferView, targets, claims } of payloadsOf(json)) {
      let decoded;
      // A payload is decoded when the first of its accessors is asked for, and once.
      const decodeOnce = () => (decoded ??= fetchPayload(bufferView).then((bytes) => decode(bytes, { claims, limits })));
      for (const target of targets) this.#addView(target, decodeOnce);
    }
  }

  #addView(target, decodeOnce) {
    const number = this.bufferViews.length;
    const { byteOffset, sparse, ...accessor } = this.accessors[target.accessor];
    this.accessors[target.accessor] = { ...accessor, bufferView: number };
    this.bufferViews.push({ buffer: 0, byteLength: 0 });
    this.#sources.set(number, async () => elementsOf(await decodeOnce(), target, accessor));
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
