// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { createDecoderPool, decodePayload } from './decoder.mjs';

let pool;
let hasWorkers = typeof Worker !== 'undefined';

/**
 * Calls decodePayload() in workers that all loaders of a page share; they start with the first
 * payload.
 * Where there are no workers (Node), or they cannot start (in a page that forbids them, or if this
 * module comes from another origin), it decodes on this thread.
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
