// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes payloads of KHR_mesh_collapse_compression, on this thread or in workers.
import { blocksOf, decodeGlued } from './blocks.mjs';
import { createPool } from './pool.mjs';

export { decodePayload, decodePayloadSync, init, ready } from './decode.mjs';
export { MccError } from './error.mjs';

/** Creates a pool that decodes several payloads at a time, in workers. */
export const createDecoderPool = (options) => createPool(options, { blocksOf, decodeGlued });
