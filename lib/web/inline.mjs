// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The same as index.mjs, with the core of the decoder inside, so that it takes no request of its own.
import { useInlineCore } from './source.mjs';
import { unpackText } from './text.mjs';
import { CORE } from './wasm/core_text.mjs';

// What the page requests in the same task leaves first.
useInlineCore(async () => unpackText(await CORE));

export * from './index.mjs';
