// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// loaders.gl through the README's code.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { pathToFileURL } from 'node:url';
import { parse } from '@loaders.gl/core';
import { GLTFLoader, postProcessGLTF } from '@loaders.gl/gltf';
import './support/peers.mjs';
import { convert, decode, readSample } from './support/program.mjs';
import { snippetOf } from './support/readme.mjs';

/** The arrays of all primitives. */
const arraysOf = (gltf) => postProcessGLTF(gltf).meshes.flatMap(({ primitives }) => primitives.map(({ attributes, indices }) => (
  Object.fromEntries([['indices', indices], ...Object.entries(attributes)].map(([name, { value }]) => [name, [...value]])))));

// Without images, which need a browser.
for (const name of ['skinned', 'morphed', 'two_materials', 'shared_vertices']) {
  test(`loaders.gl reads ${name} as it reads the decoded file`, async (context) => {
    const folder = mkdtempSync(path.join(os.tmpdir(), 'gltf-mcc-'));
    context.after(() => rmSync(folder, { recursive: true }));
    const compressed = convert(readSample(name));
    context.mock.method(globalThis, 'fetch', async () => new Response(compressed));
    const snippet = path.join(folder, 'snippet.mjs');
    writeFileSync(snippet, `${await snippetOf('loaders.gl')}\nexport { gltf };\n`);
    const { gltf } = await import(pathToFileURL(snippet));
    const plain = decode(compressed);
    const expected = await parse(plain.buffer.slice(plain.byteOffset, plain.byteOffset + plain.length), GLTFLoader);
    assert.deepEqual(arraysOf(gltf), arraysOf(expected));
  });
}
