// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { ByteSource, GlbBlock, GlbBlockOptions } from './types.mjs';

/** Yields the blocks of all payloads of a GLB, in the order in which they are in the file, like decodeBlocks(). */
export function decodeGlbBlocks(source: ByteSource, options?: GlbBlockOptions): AsyncGenerator<GlbBlock, void, void>;
