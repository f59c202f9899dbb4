// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Bundles pages as users do, with Vite and what it does by default.
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { brotliCompressSync, constants } from 'node:zlib';
import { build } from 'vite';
import { ENGINES, LIBRARY } from './paths.mjs';

/** Where a project would have the packages. */
const aliases = (library) => [
  { find: /^gltf-mcc\/(.*)$/, replacement: path.join(library, '$1.mjs') },
  { find: /^gltf-mcc$/, replacement: path.join(library, 'index.mjs') },
  { find: /^three\/addons\//, replacement: path.join(ENGINES, 'three/examples/jsm/') },
  { find: /^three$/, replacement: path.join(ENGINES, 'three/build/three.module.js') },
  { find: /^@babylonjs\//, replacement: path.join(ENGINES, '@babylonjs/') },
];

/**
 * @param {string} folder where the sources are written
 * @param {Record<string, string>} files index.html and what belongs to it, by name
 * @param {object} [options] of Vite, and `library`: another folder than lib/web
 * @returns {Promise<object[]>} the chunks and assets; they are also in `folder`/dist
 */
export async function bundle(folder, files, options = {}) {
  for (const [name, text] of Object.entries(files)) {
    mkdirSync(path.dirname(path.join(folder, name)), { recursive: true });
    writeFileSync(path.join(folder, name), text);
  }
  const { build: how, library = LIBRARY, ...others } = options;
  const { output } = await build({ root: folder, logLevel: 'error', configFile: false, resolve: { alias: aliases(library) }, build: how, ...others });
  return output;
}

export const brotliBytes = (data) => brotliCompressSync(data, {
  params: { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_LGWIN]: 24 },
}).length;

/**
 * Bundles a page whose only script is `main`, and adds up its scripts after brotli.
 * @returns {Promise<{ page: number, worker: number, later: number }>} page: what the browser loads with the page; later: chunks of this
 *   package that only rare files need
 */
export async function scriptBytesOf(main) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'gltf-mcc-bundle-'));
  try {
    const output = await bundle(folder, { 'index.html': '<!doctype html><script type="module" src="./main.js"></script>', 'main.js': main });
    const chunks = new Map(output.filter(({ type }) => type === 'chunk').map((chunk) => [chunk.fileName, chunk]));
    const page = withImports(chunks, [...chunks.values()].filter(({ isEntry }) => isEntry));
    const later = [...chunks.values()].filter((chunk) => !page.has(chunk) && chunk.moduleIds.some((id) => id.startsWith(LIBRARY)));
    const workers = output.filter(({ fileName }) => /\/worker-[^/]*\.js$/.test(fileName));
    const sum = (files) => [...files].reduce((all, { code, source }) => all + brotliBytes(Buffer.from(code ?? source)), 0);
    return { page: sum(page), worker: sum(workers), later: sum(later) };
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** Returns chunks and all that they import at once. */
function withImports(chunks, entries) {
  const all = new Set(entries);
  for (const { imports } of all) for (const name of imports) if (chunks.has(name)) all.add(chunks.get(name));
  return all;
}
