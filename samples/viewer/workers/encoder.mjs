// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compresses a file for the comparison alone. This worker gets { bytes, options } of encodeGlb. It posts { name: 'done', payloads } or
// { name: 'error', message }.
import { readGlb } from '../glb.mjs';
import { payloadsOf } from '../payloads.mjs';
import { encodeGlb } from '../vendor/gltf-mcc/encoder.mjs';

onmessage = async ({ data: { bytes, options } }) => {
  try {
    const { glb } = await encodeGlb(bytes, options);
    postMessage({ name: 'done', payloads: [...payloadsOf(readGlb(glb)).values()].map((payload) => ({ bytes: payload })) });
  } catch (error) {
    postMessage({ name: 'error', message: error.message });
  }
};
