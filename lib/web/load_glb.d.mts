// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { ByteSource, GlbBlock, GlbBlockOptions } from './types.mjs';

export interface LoadGlbOptions extends GlbBlockOptions {
  /** Is called first, with the JSON of the file, which says where primitives are drawn and of what material. It must not be changed. */
  onDocument?: (json: any) => void;
  /**
   * Is called with each preview in the file, a coarse version of a large primitive, as soon as it is decoded. Its `uses` say which
   * primitives it stands for. A preview that has blocks comes block by block.
   */
  onPreview?: (preview: GlbBlock) => void;
  /** Is called with each block of the primitives themselves, as decodeGlbBlocks() yields them. They replace the preview one by one. */
  onBlock?: (block: GlbBlock) => void;
}

/**
 * Loads a GLB from a place or a stream, and returns its bytes, for instance for the loader of an engine. Meanwhile, shows what is there
 * already: the JSON comes first in the file, and `gltf-mcc convert --preview` puts previews next. Decodes only what a function is given for,
 * by default in workers that all loaders of a page share, or on this thread where there is no `Worker`, as in Node: there,
 * `decodeBlocks` of a pool keeps tasks short. Rejects if what is decoded is damaged, if a function throws, or with the reason
 * of `signal`; the application then removes what it shows.
 */
export function loadGlb(source: string | URL | ByteSource, options?: LoadGlbOptions): Promise<Uint8Array>;
