// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Predicts how long payloads take to decode, from what documents say of them and from what decoding took on this machine.
import { namedBytes } from './budget.mjs';

/** Of each payload, however small. */
const LEAST_MS = 0.2;
/** Of code that the engine has just compiled. */
const FIRST_MS_PER_BYTE = 12e-6;
/** So many decoded bytes say as much as all that came before them. */
const REMEMBERED_BYTES = 1 << 20;
/** Decoded bytes for each byte of a payload of which nothing is known. */
const TYPICAL_RATIO = 30;

export class Pace {
  #bytes = REMEMBERED_BYTES;
  #ms = REMEMBERED_BYTES * FIRST_MS_PER_BYTE;

  /** Milliseconds to decode a payload to so many bytes. */
  predict(decodedBytes) {
    return LEAST_MS + (decodedBytes * this.#ms) / this.#bytes;
  }

  /** Takes into account how long it took. */
  learn(decodedBytes, ms) {
    const kept = REMEMBERED_BYTES / (REMEMBERED_BYTES + decodedBytes);
    this.#bytes = kept * this.#bytes + decodedBytes;
    this.#ms = kept * this.#ms + Math.max(0, ms - LEAST_MS);
  }
}

/** What all decoders of a page share. */
export const pace = /* @__PURE__ */ new Pace();

/** The bytes that a payload decodes to, as far as they are known before it is opened. */
export const expectedBytes = (payload, claims) => (Array.isArray(claims) ? namedBytes({ claims }) : TYPICAL_RATIO * payload.length);
