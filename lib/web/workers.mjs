// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { createDecoderPool, decodePayload } from './decoder.mjs';

let pool;
let hasWorkers = typeof Worker !== 'undefined';

/**
 * decodePayload() in workers that all loaders of a page share; they start with the first payload. On this thread where there are
 * none (Node), or where they cannot start: in a page that forbids them, or when this module is from another origin.
 * @type {typeof decodePayload}
 */
export async function decodeInWorkers(payload, options) {
  if (hasWorkers) {
    try {
      pool ??= createDecoderPool();
      return await pool.decodePayload(payload, options);
    } catch (error) {
      if (isAboutPayload(error)) throw error;
      hasWorkers = false;
    }
  }
  return decodePayload(payload, options);
}

const isAboutPayload = ({ code }) => typeof code === 'string' && code !== 'Load';
