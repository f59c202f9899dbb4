// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compiles the WebAssembly modules from wherever they are.
import { MccError } from './error.mjs';

/** `module` or `bytes` if they are given, else what is at `url`. */
export async function compileModule({ module, bytes }, url) {
  if (module !== undefined) return module;
  if (bytes !== undefined) return WebAssembly.compile(bytes);
  try {
    return await compileFrom(new URL(url, globalThis.document?.baseURI ?? import.meta.url));
  } catch (error) {
    throw new MccError(`cannot load ${url}: ${error.message}`, 'Load');
  }
}

async function compileFrom(url) {
  if (url.protocol === 'file:') {
    const { readFile } = await importOfNode('fs/promises');
    return WebAssembly.compile(await readFile(url));
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`status ${response.status}`);
  const isWasm = response.headers.get('Content-Type')?.startsWith('application/wasm');
  return isWasm ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}

/** Bundlers leave this alone; it is never called in browsers. */
export function importOfNode(name) {
  return import(/* @vite-ignore */ /* webpackIgnore: true */ `node:${name}`);
}
