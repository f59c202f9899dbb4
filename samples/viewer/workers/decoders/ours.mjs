// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { decodePayload, init } from '../../vendor/gltf-mcc/decoder.mjs';

/** Loads the core of the decoder; the rest is loaded when a payload needs it. */
export async function loadDecoder() {
  await init();
  return async (payloads) => {
    let triangles = 0;
    for (const { bytes } of payloads) {
      const { pieces } = await decodePayload(bytes);
      for (const { parts } of pieces) for (const { triangleCount } of parts) triangles += triangleCount;
    }
    return triangles;
  };
}
