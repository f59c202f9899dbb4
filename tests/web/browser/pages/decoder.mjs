// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The library alone, on a page that allows nothing but its own files and WebAssembly.
import { createDecoderPool, ready, unpackGlb } from '/lib/index.mjs';

const fetchModel = async (name) => new Uint8Array(await (await fetch(`/models/${name}/model.glb`)).arrayBuffer());

async function hashOf(bytes) {
  return new Uint8Array(await crypto.subtle.digest('SHA-256', bytes)).toString();
}

/** The hashes of models unpacked on this thread and in workers, all at the same time, and messages of those that cannot be. */
globalThis.unpack = async (names, workers) => {
  await ready;
  const pool = createDecoderPool({ workers });
  const hash = async (name, options) => {
    const bytes = await fetchModel(name);
    return unpackGlb(bytes, options).then(hashOf, (error) => `${error.name}: ${error.message}`);
  };
  try {
    const all = (options) => Promise.all(names.map((name) => hash(name, options)));
    const here = await all({});
    return { size: pool.size, here, inWorkers: await all({ decode: pool.decodePayload }) };
  } finally {
    pool.dispose();
  }
};
