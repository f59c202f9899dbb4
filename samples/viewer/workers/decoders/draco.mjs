// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import DracoDecoderModule from '../../vendor/draco/draco_decoder.mjs';

export async function loadDecoder() {
  const response = await fetch(new URL('../../vendor/draco/draco_decoder.wasm', import.meta.url));
  const module = await DracoDecoderModule({ wasmBinary: await response.arrayBuffer() });
  return (payloads) => payloads.reduce((sum, { bytes }) => sum + decode(module, bytes), 0);
}

/** Takes all triangles and attributes out, as a loader does. */
function decode(module, bytes) {
  const decoder = new module.Decoder();
  const mesh = new module.Mesh();
  const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
  if (!status.ok()) throw new Error(`Draco: ${status.error_msg()}`);
  const triangles = mesh.num_faces();
  const indexBytes = triangles * 12;
  copied(module, indexBytes, (pointer) => decoder.GetTrianglesUInt32Array(mesh, indexBytes, pointer));
  for (let i = 0; i < mesh.num_attributes(); ++i) copyAttribute(module, decoder, mesh, decoder.GetAttribute(mesh, i));
  for (const made of [mesh, decoder]) module.destroy(made);
  return triangles;
}

function copyAttribute(module, decoder, mesh, attribute) {
  const type = attribute.data_type();
  const ofFour = [module.DT_FLOAT32, module.DT_UINT32, module.DT_INT32];
  const size = ofFour.includes(type) ? 4 : [module.DT_UINT16, module.DT_INT16].includes(type) ? 2 : 1;
  const byteLength = mesh.num_points() * attribute.num_components() * size;
  copied(module, byteLength, (pointer) => decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, type, byteLength, pointer));
}

function copied(module, byteLength, fill) {
  const pointer = module._malloc(byteLength);
  fill(pointer);
  const copy = module.HEAPU8.slice(pointer, pointer + byteLength);
  module._free(pointer);
  return copy;
}
