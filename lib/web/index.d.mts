// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
export * from './decoder.mjs';
export { decodeBlocks } from './blocks.mjs';
export { preload } from './threads.mjs';
export { decodeGlbBlocks } from './glb_blocks.mjs';
export { EXTENSION_NAME } from './document.mjs';
export { loadGlb, type LoadGlbOptions } from './load_glb.mjs';
export { unpackGlb, type UnpackOptions } from './unpack.mjs';
export { unpackTile } from './unpack_tile.mjs';
