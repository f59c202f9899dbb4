// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What loaders import only for surfaces in blocks (gluing blocks, and decoding them on the page's thread where no worker can start), for integers,
// and for accessors with the same elements.
export { BabylonIntegers } from './babylon_integers.mjs';
export { blocksOf, decodeGlued, OnThisThread } from './blocks.mjs';
export { showBlock } from './three_blocks.mjs';
export { adaptMeshes } from './three_meshes.mjs';
