// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { DecodedPayload, DecodeOptions, FileLimits, Owned } from './types.mjs';

export interface UnpackOptions {
  /** Default: decodePayload(). The one of a pool decodes in workers. */
  decode?: (bytes: Uint8Array, options: DecodeOptions) => Promise<DecodedPayload>;
  limits?: FileLimits;
  /**
   * The version of the result: 2, or 3 as in the draft of glTF 2.1. Without it, only what does not fit in 4 GiB gets version 3. `bytes`
   * without the extension keep theirs.
   */
  glbVersion?: 2 | 3;
}

/**
 * Returns a GLB without the extension, or `bytes` themselves if no primitive has it. Safe for
 * untrusted bytes: rejects with an MccError, whose message begins with a JSON path or the number of a
 * byte. `decode` is called with parts of `bytes`, for at most 16 payloads at a time.
 */
export function unpackGlb<Bytes extends Uint8Array>(bytes: Bytes, options?: UnpackOptions): Promise<Bytes | Owned<Uint8Array>>;
