// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { createDecoderPool, decodePayload } from './decoder.mjs';

let pool;

/**
 * decodePayload() in workers that all loaders of a page share; they start with the first payload. Where there are none, in Node
 * for example, on this thread.
 * @type {typeof decodePayload}
 */
export function decodeInWorkers(payload, options) {
  if (typeof Worker === 'undefined') return decodePayload(payload, options);
  pool ??= createDecoderPool();
  return pool.decodePayload(payload, options);
}
