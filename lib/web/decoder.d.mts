// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { DecodedPayload, DecodeOptions, DecoderPool, InitOptions, PoolOptions } from './types.mjs';

export type * from './types.mjs';
export { MccError } from './error.mjs';

/**
 * Loads the decoder. If it is never called, the first decodePayload() loads the modules next to
 * this one.
 */
export function init(options?: InitOptions): Promise<void>;

/**
 * Resolves when the whole decoder is loaded, which decodePayloadSync() needs. Awaiting it starts
 * the loading.
 */
export const ready: Promise<void>;

/** Decodes a payload: all bytes of the extension's buffer view. Safe for untrusted bytes. */
export function decodePayload(bytes: Uint8Array, options?: DecodeOptions): Promise<DecodedPayload>;

/** Like decodePayload(), but only after the decoder is `ready`. */
export function decodePayloadSync(bytes: Uint8Array, options?: DecodeOptions): DecodedPayload;

/** Decodes in module workers (worker_threads in Node), several payloads at a time. */
export function createDecoderPool(options?: PoolOptions): DecoderPool;
