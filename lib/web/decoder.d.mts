// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { DecodedPayload, DecodeOptions, DecoderPool, InitOptions, PoolOptions } from './types.mjs';

export type * from './types.mjs';
export { MccError } from './error.mjs';

/** Loads the decoder. Without a call the first decodePayload() does, from beside this module. */
export function init(options?: InitOptions): Promise<void>;

/** Resolves when the decoder is loaded as a whole, which awaiting it begins: for decodePayloadSync(). */
export const ready: PromiseLike<void>;

/** Decodes a payload: the bytes of the extension's buffer view, all of them. Safe for untrusted bytes. */
export function decodePayload(bytes: Uint8Array, options?: DecodeOptions): Promise<DecodedPayload>;

/** The same, once the decoder is `ready`. */
export function decodePayloadSync(bytes: Uint8Array, options?: DecodeOptions): DecodedPayload;

/** Decodes in module workers (worker_threads in Node), several payloads at a time. */
export function createDecoderPool(options?: PoolOptions): DecoderPool;
