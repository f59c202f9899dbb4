// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { packText, unpackText } from '../../lib/web/text.mjs';
import { CORE } from '../../lib/web/wasm/core_text.mjs';

test('bytes become a text that scripts can hold as it is, and back', () => {
  const bytes = Uint8Array.from({ length: 1024 }, (_, i) => (i * 7) >> (i % 3));
  const text = packText(bytes);
  assert.deepEqual(unpackText(text), bytes);
  assert.match(text, /^[(-[\]-_a-~]*$/);
  assert.deepEqual(unpackText(packText(new Uint8Array(0))), new Uint8Array(0));
});

test('inline.mjs has the core that is beside it', () => {
  const core = readFileSync(new URL('../../lib/web/wasm/mcc_decoder_core_simd.wasm', import.meta.url));
  assert.equal(Buffer.compare(core, unpackText(CORE)), 0);
});
