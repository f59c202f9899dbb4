// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compresses bytes as a server does that has its files ready. This worker gets { parts }, which it
// joins, and posts { name: 'done', byteLength } or { name: 'error', message }.
import init, { compress } from '../vendor/brotli/brotli_wasm.mjs';
import { joinBytes } from '../meshopt.mjs';

const QUALITY = 11;

let loading;

onmessage = async ({ data: { parts } }) => {
  try {
    loading ??= init(new URL('../vendor/brotli/brotli_wasm_bg.wasm', import.meta.url));
    await loading;
    const bytes = joinBytes(parts);
    postMessage({ name: 'done', byteLength: bytes.length === 0 ? 0 : compress(bytes, { quality: QUALITY }).length });
  } catch (error) {
    loading = undefined;
    postMessage({ name: 'error', message: error.message ?? String(error) });
  }
};
