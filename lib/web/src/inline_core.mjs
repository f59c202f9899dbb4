// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node inline_core.mjs: writes the core with SIMD as a script, wasm/core_text.mjs, for inline.mjs. tools/build-web runs it.
import { readFileSync, writeFileSync } from 'node:fs';
import { packText } from '../text.mjs';

const folder = new URL('../wasm/', import.meta.url);
const core = readFileSync(new URL('mcc_decoder_core_simd.wasm', folder));
writeFileSync(new URL('core_text.mjs', folder), `// The bytes of mcc_decoder_core_simd.wasm, see text.mjs.\nexport const CORE = '${packText(core)}';\n`);
