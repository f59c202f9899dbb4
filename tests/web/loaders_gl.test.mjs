// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// loaders.gl through the README's code, and with the extension in its list.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import test, { describe } from 'node:test';
import { pathToFileURL } from 'node:url';
import { parse } from '@loaders.gl/core';
import { GLTFLoader, postProcessGLTF } from '@loaders.gl/gltf';
import './support/peers.mjs';
import { decodePayload, unpackGlb } from '../../lib/web/index.mjs';
import * as extension from '../../lib/web/loaders_gl.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { refusesNegatives } from './support/loaders.mjs';
import { SAMPLES } from './support/paths.mjs';
import { convert, convertWithFallback, decode, readSample } from './support/program.mjs';
import { snippetOf } from './support/readme.mjs';

// The package does not export its list of extensions.
const { EXTENSIONS } = await import(new URL('lib/api/gltf-extensions.js',
  pathToFileURL(createRequire(import.meta.url).resolve('@loaders.gl/gltf'))));

/** Calls `work` while loaders.gl has an extension as if it were one of its own. */
async function withExtension(added, work) {
  EXTENSIONS.unshift(added);
  try {
    return await work();
  } finally {
    EXTENSIONS.splice(EXTENSIONS.indexOf(added), 1);
  }
}

// Without images, which need a browser.
const parseGlb = (bytes, gltf = {}) => parse(bytes.slice().buffer, GLTFLoader, { gltf: { loadImages: false, ...gltf } });
const parseCompressed = (bytes, gltf) => withExtension(extension, () => parseGlb(bytes, gltf));

/** The arrays of all primitives. */
const arraysOf = (gltf) => postProcessGLTF(gltf).meshes.flatMap(({ primitives }) => primitives.map(({ attributes, indices, targets = [] }) => (
  [{ indices, ...attributes }, ...targets].map((accessors) => (
    Object.fromEntries(Object.entries(accessors).map(([name, accessor]) => [name, [...(accessor.value ?? [])]])))))));

for (const name of ['skinned', 'morphed', 'two_materials', 'shared_vertices']) {
  test(`loaders.gl reads ${name} as it reads the decoded file`, async (context) => {
    const folder = mkdtempSync(path.join(os.tmpdir(), 'gltf-mcc-'));
    context.after(() => rmSync(folder, { recursive: true }));
    const compressed = convert(readSample(name));
    context.mock.method(globalThis, 'fetch', async () => new Response(compressed));
    const snippet = path.join(folder, 'snippet.mjs');
    writeFileSync(snippet, `${await snippetOf('loaders.gl')}\nexport { gltf };\n`);
    const { gltf } = await import(pathToFileURL(snippet));
    const expected = arraysOf(await parseGlb(decode(compressed)));
    assert.deepEqual(arraysOf(gltf), expected);
    assert.deepEqual(arraysOf(await parseCompressed(compressed)), expected);
  });
}

describe('with the extension, loaders.gl', () => {
  test('makes of the conformance assets what it makes of their unpacked form', async () => {
    for (const asset of manifest.assets) {
      const bytes = readAsset(asset);
      const { json, ...others } = await parseCompressed(bytes);
      assert.deepEqual(json.extensionsRequired, undefined, asset.file);
      assert.deepEqual(arraysOf({ json, ...others }), arraysOf(await parseGlb(await unpackGlb(bytes))), asset.file);
    }
  });

  test('refuses the negative assets', () => refusesNegatives(parseCompressed));

  test('has the ids of features when it reads them', async () => {
    const source = new Uint8Array(readFileSync(path.join(SAMPLES, 'city/town/market.glb')));
    const compressed = convert(source);
    const idsOf = ({ json }) => json.meshes.flatMap(({ primitives }) => primitives.flatMap(({ extensions }) => (
      extensions.EXT_mesh_features.featureIds.map(({ data }) => [...data]))));
    const ids = idsOf(await parseCompressed(compressed));
    assert.ok(new Set(ids.flat()).size > 1);
    assert.deepEqual(ids, idsOf(await parseGlb(decode(compressed))));
  });

  test('decodes a payload once, with the options of the extension', async () => {
    const { meshCollapse } = extension;
    const glb = convert(readSample('shared_vertices')); // three primitives with one payload
    let count = 0;
    const counting = meshCollapse({ decode: (...args) => { ++count; return decodePayload(...args); } });
    await withExtension(counting, () => parseGlb(glb));
    assert.equal(count, 1);
    const limited = meshCollapse({ limits: { maxVertices: 100 } });
    await assert.rejects(withExtension(limited, () => parseGlb(glb)), { code: 'Limit' });
  });

  test('leaves meshes and buffers alone when it is told to', async () => {
    const glb = convert(readSample('torus'));
    for (const options of [{ decompressMeshes: false }, { loadBuffers: false }]) {
      const { json } = await parseCompressed(glb, options);
      assert.deepEqual(json.extensionsRequired, ['KHR_mesh_collapse_compression']);
      assert.deepEqual(json.accessors, readGlb(glb).json.accessors);
    }
  });

  test('loads buffers from files, each once, and none of a fallback', async () => {
    const { glb, fallbackName } = convertWithFallback('torus');
    const { json, chunks: [{ data }] } = readGlb(glb);
    json.buffers[0].uri = 'model.bin';
    const requests = [];
    const fetch = async (url) => {
      requests.push(path.basename(url));
      return new Response(data);
    };
    const options = { core: { baseUrl: 'https://example.com/' }, fetch, gltf: { loadImages: false } };
    const gltf = await withExtension(extension, () => parse(JSON.stringify(json), GLTFLoader, options));
    assert.deepEqual(requests, ['model.bin']);
    assert.equal(json.buffers[1].uri, fallbackName);
    assert.deepEqual(arraysOf(gltf), arraysOf(await parseGlb(await unpackGlb(glb))));
  });
});
