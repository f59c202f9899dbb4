// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { BlockOptions, ByteSource, DecodedBlock } from './types.mjs';

/**
 * Yields the blocks of a payload as soon as they are there and decoded. It decodes on this thread, which
 * can do other things between two blocks; that of a pool decodes in workers. A payload without blocks
 * yields its pieces. Ending the iteration early cancels a stream. When next() rejects, blocks that were
 * yielded before must no longer be shown. Safe for untrusted bytes.
 */
export function decodeBlocks(source: ByteSource, options?: BlockOptions): AsyncGenerator<DecodedBlock, void, void>;
