// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The conformance suite for tests of the npm package, and the modules that tools/build-web makes.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';
import { payloadsOf } from '../../../lib/web/document.mjs';
import { readGlb } from '../../../lib/web/unpack.mjs';

const root = new URL('../../conformance/', import.meta.url);
const run = createRequire(import.meta.url)(fileURLToPath(new URL('run', root)));

export const manifest = JSON.parse(readFileSync(new URL('manifest.json', root), 'utf8'));
export const readAsset = ({ file }) => new Uint8Array(readFileSync(new URL(file, root)));

/** What is wrong with a decoded GLB, or ''. */
export const whatDiffers = (glb, { primitives }) => run.comparePrimitives(run.readGlb(Buffer.from(glb)), primitives);

/** The first payload of a GLB. */
export function payloadOf(glb) {
  const { json, chunks } = readGlb(glb);
  const { byteOffset = 0, byteLength } = json.bufferViews[payloadsOf(json)[0].bufferView];
  return chunks[0].data.slice(byteOffset, byteOffset + byteLength);
}

const wasmUrl = (name) => new URL(`../../../lib/web/wasm/${name}.wasm`, import.meta.url);
export const wasm = (name) => readFileSync(wasmUrl(name));

/** Ways to load the decoder, by what is tested: options of init(). */
export const DECODERS = {
  mcc_decoder: { wasmUrl: wasmUrl('mcc_decoder'), simdWasmUrl: wasmUrl('mcc_decoder') },
  mcc_decoder_simd: { wasmUrl: wasmUrl('mcc_decoder_simd') },
  mcc_decoder_core: {
    coreUrl: wasmUrl('mcc_decoder_core'), simdCoreUrl: wasmUrl('mcc_decoder_core'), wasmUrl: wasmUrl('mcc_decoder'),
  },
  mcc_decoder_core_simd: { coreUrl: wasmUrl('mcc_decoder_core_simd'), wasmUrl: wasmUrl('mcc_decoder_simd') },
};
