// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compiles WebAssembly modules, wherever they are stored.
import { MccError } from './error.mjs';
import { fileOf } from './node.mjs';

/**
 * Returns `module`, or compiles `bytes`, or those of a promise, if they are given; otherwise compiles the module at `url`.
 */
export async function compileModule({ module, bytes }, url) {
  if (module !== undefined) return module;
  try {
    return await (bytes ? WebAssembly.compile(await bytes) : compileFrom(new URL(url, globalThis.document?.baseURI ?? import.meta.url)));
  } catch (error) {
    throw new MccError(`cannot load ${bytes ? 'the module' : url}: ${error.message}`, 'Load');
  }
}

async function compileFrom(url) {
  const file = fileOf(url);
  if (file !== undefined) return WebAssembly.compile(await file);
  const response = await fetch(url);
  if (!response.ok) throw new Error(`status ${response.status}`);
  const isWasm = response.headers.get('Content-Type')?.startsWith('application/wasm');
  return isWasm ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}
