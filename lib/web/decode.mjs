// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes payloads of KHR_mesh_collapse_compression on this thread.
import { Decoder } from './core.mjs';
import { MccError } from './error.mjs';
import { pageSource, usePageSource } from './source.mjs';

/**
 * Loads the decoder. If it is never called, the first decodePayload() loads the modules next to
 * this one.
 */
export async function init(options) {
  await usePageSource(options ?? {}).core();
}

/** A promise that begins its work when somebody waits for it. */
class Loading extends Promise {
  static get [Symbol.species]() {
    return Promise;
  }
  then(fulfilled, rejected) {
    return pageSource().whole().then(() => {}).then(fulfilled, rejected);
  }
}

/** Resolves when the whole decoder is loaded. Awaiting it starts the loading. */
export const ready = /* @__PURE__ */ new Loading(() => {});

/** Returns the decoder of a module, always the same one. */
const decoderOf = (loaded) => (loaded.decoder ??= new Decoder(loaded.module));

/** Loads the first decoder and makes its instance, for decodePayload(). */
export const prepareHere = async () => decoderOf(await pageSource().first()).prepare();

export async function decodePayload(bytes, options) {
  const from = pageSource();
  try {
    return await decoderOf(await from.first()).decode(bytes, options);
  } catch (error) {
    if (error.code !== 'NotInCore') throw error;
    return decoderOf(await from.whole()).decode(bytes, options);
  }
}

export function decodePayloadSync(bytes, options) {
  const { decoder } = pageSource();
  if (decoder === undefined) throw new MccError('the decoder is not loaded yet: await ready first', 'Load');
  return decoderOf(decoder).decodeSync(bytes, options);
}
