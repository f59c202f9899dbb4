// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Where the decoder's modules are, and which of them have been loaded.
import { compileModule } from './load.mjs';

/** A module whose only function uses a vector. An engine without SIMD cannot compile it. */
const VECTORS = [
  0, 97, 115, 109, 1, 0, 0, 0, // header
  1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, // a function without parameters that returns a vector
  10, 8, 1, 6, 0, 65, 0, 253, 15, 11, // i32.const 0, i8x16.splat, end
];

/**
 * Loads and keeps the modules of one place: { module }, to which decoder.mjs adds a decoder. The core is smaller and
 * faster, and decodes most payloads.
 */
export class Source {
  #loading = {};

  constructor(where) {
    this.where = where;
  }

  core() {
    const { module, bytes, coreUrl, simdCoreUrl, wasmUrl, simdWasmUrl } = this.where;
    const isWhole = (module ?? bytes ?? wasmUrl ?? simdWasmUrl) !== undefined;
    if ((coreUrl ?? simdCoreUrl) !== undefined) return this.#load('coreDecoder', urlOfCore);
    return isWhole ? this.whole() : this.#load('coreDecoder', urlOfCore, () => ({ bytes: hasSimd() ? inlineCore?.() : undefined }));
  }

  whole() {
    return this.#load('decoder', urlOfWhole);
  }

  /** The decoder to try first: the core, unless only the whole decoder is loaded. */
  first() {
    return this.decoder && !this.coreDecoder ? this.whole() : this.core();
  }

  /** Every payload asks for its decoder, so nothing is looked for after the first time: not even whether there are vectors. */
  #load(name, urlOf, given = () => this.where) {
    this.#loading[name] ??= compileModule(given(), urlOf(this.where)).then((module) => (this[name] = { module }), (error) => {
      delete this.#loading[name]; // the next call tries again
      throw error;
    });
    return this.#loading[name];
  }
}

/** Returns a promise of the bytes of the core with SIMD, if a script has them. */
let inlineCore;

/** Makes sources take the core from a function, where no other place is given. */
export function useInlineCore(unpack) {
  inlineCore = unpack;
}

/** The modules of this page, which decodePayload() and pools without options share. */
let source = new Source({});

export const pageSource = () => source;

export function usePageSource(where) {
  source = new Source(where);
  return source;
}

/** Returns the compiled whole decoder. */
export const wholeModule = async () => (await source.whole()).module;

const hasSimd = () => WebAssembly.validate(new Uint8Array(VECTORS));

function urlOfCore({ coreUrl, simdCoreUrl }) {
  return hasSimd() ? simdCoreUrl ?? coreUrl ?? new URL('./wasm/mcc_decoder_core_simd.wasm', import.meta.url)
    : coreUrl ?? new URL('./wasm/mcc_decoder_core.wasm', import.meta.url);
}

function urlOfWhole({ wasmUrl, simdWasmUrl }) {
  return hasSimd() ? simdWasmUrl ?? wasmUrl ?? new URL('./wasm/mcc_decoder_simd.wasm', import.meta.url)
    : wasmUrl ?? new URL('./wasm/mcc_decoder.wasm', import.meta.url);
}
