// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What only Node has. By package.json, bundlers for browsers take no_node.mjs instead: a dynamic import, although it is never called,
// would make them add code that loads other modules.

/** Imports a module of Node. Browsers never call it. */
export function importOfNode(name) {
  return import(/* @vite-ignore */ /* webpackIgnore: true */ `node:${name}`);
}

/** Returns the bytes of a file; undefined for other URLs. */
export async function fileOf(url) {
  if (url.protocol !== 'file:') return undefined;
  const { readFile } = await importOfNode('fs/promises');
  return readFile(url);
}
