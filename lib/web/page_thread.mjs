// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What loaders import only for surfaces in blocks, and where no worker can start: gluing and decoding on the page's thread.
export { decodeGlued } from './block_stream.mjs';
export { OnThisThread } from './blocks.mjs';
export { decodePayload } from './decoder.mjs';
export { showBlock } from './three_blocks.mjs';
