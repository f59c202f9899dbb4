// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Everything that decodes. The encoder is a module of its own, encoder.mjs.
export { decodeBlocks } from './blocks.mjs';
export { createDecoderPool, decodePayload, decodePayloadSync, init, MccError, ready } from './decoder.mjs';
export { decodeGlbBlocks } from './glb_blocks.mjs';
export { EXTENSION_NAME } from './document.mjs';
export { loadGlb } from './load_glb.mjs';
export { unpackGlb } from './unpack.mjs';
export { unpackTile } from './unpack_tile.mjs';
export { preload } from './threads.mjs';
