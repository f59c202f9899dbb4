// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { Owned } from './types.mjs';
import type { UnpackOptions } from './unpack.mjs';

/**
 * Returns a tile of 3D Tiles (b3dm, i3dm, cmpt, also nested, or GLB) whose models are without the
 * extension. Returns `bytes` themselves if no model has it, or if they are no such tile. Tables stay
 * byte for byte, lengths and paddings become right. `limits` hold for each payload, and for all
 * models together. Rejects with an MccError if a header does not fit the bytes that are there. Safe
 * for untrusted bytes.
 */
export function unpackTile<Bytes extends Uint8Array>(bytes: Bytes, options?: UnpackOptions): Promise<Bytes | Owned<Uint8Array>>;
