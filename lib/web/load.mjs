// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compiles WebAssembly modules, wherever they are stored.
import { MccError } from './error.mjs';

/**
 * Returns `module`, or compiles `bytes`, if they are given; otherwise compiles the module at `url`.
 */
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

/** Imports a module of Node. Bundlers must leave this import alone; browsers never call it. */
export function importOfNode(name) {
  return import(/* @vite-ignore */ /* webpackIgnore: true */ `node:${name}`);
}
