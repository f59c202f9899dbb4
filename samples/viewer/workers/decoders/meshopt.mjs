// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { MeshoptDecoder } from '../../vendor/meshopt/meshopt_decoder.mjs';

/** Decodes to the arrays that a graphics card takes: lattice indices, packed normals. */
export async function loadDecoder() {
  await MeshoptDecoder.ready;
  return (payloads) => payloads.reduce((sum, { bytes, streams }) => sum + decode(bytes, streams), 0);
}

function decode(bytes, streams) {
  let triangles = 0;
  for (const { offset, length, count, stride, mode, filter } of streams) {
    const target = new Uint8Array(count * stride);
    MeshoptDecoder.decodeGltfBuffer(target, count, stride, bytes.subarray(offset, offset + length), mode, filter);
    if (mode === 'TRIANGLES') triangles += count / 3;
  }
  return triangles;
}
