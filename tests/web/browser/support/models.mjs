// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { NodeIO } from '@gltf-transform/core';
import { EXTMeshGPUInstancing } from '@gltf-transform/extensions';
import { payloadsOf } from '../../../../lib/web/document.mjs';
import { readGlb, writeGlb } from '../../../../lib/web/unpack.mjs';
import { convert, decode, readSample } from '../../support/program.mjs';

/** Models by name: where they come from, and how they are converted. */
const MODELS = {
  textured: { make: () => readSample('textured') },
  skinned: { make: () => readSample('skinned') },
  tentacle: { make: tentacle },
  morphed: { make: () => readSample('morphed') },
  materials: { make: () => readSample('two_materials') }, // several primitives
  shared: { make: () => readSample('shared_vertices') }, // several primitives on the same accessors
  integers: { make: () => readSample('quantized') }, // of KHR_mesh_quantization
  ordinary: { make: () => readSample('textured'), options: ['--indices-only'] }, // attributes that are not in the payload
  lossless: { make: () => readSample('textured'), options: ['--lossless'] },
  instances: { make: instances },
};

/**
 * @returns {Promise<Map<string, Uint8Array>>} for each model NAME the source NAME, the compressed NAME.mcc, and NAME.plain, which
 *   is NAME.mcc as the program decodes it; and a "damaged" one
 */
export async function makeModels() {
  const models = new Map();
  for (const [name, { make, options }] of Object.entries(MODELS)) {
    const source = await make();
    const compressed = convert(source, options);
    models.set(name, source).set(`${name}.mcc`, compressed).set(`${name}.plain`, decode(compressed));
  }
  return models.set('damaged', damaged(models.get('textured.mcc')));
}

/** What is skinned, without its morph target. */
function tentacle() {
  const { json, chunks } = readGlb(readSample('skinned'));
  const [mesh] = json.meshes;
  delete mesh.primitives[0].targets;
  delete mesh.weights;
  delete json.animations;
  return writeGlb(json, chunks);
}

/** A mesh that two nodes draw, one of them three times (EXT_mesh_gpu_instancing). */
async function instances() {
  const io = new NodeIO().registerExtensions([EXTMeshGPUInstancing]);
  const document = await io.readBinary(readSample('torus'));
  const [scene] = document.getRoot().listScenes();
  const [node] = scene.listChildren();
  const [buffer] = document.getRoot().listBuffers();
  const translations = document.createAccessor('translations', buffer).setType('VEC3')
    .setArray(new Float32Array([0, 0, -2, 0, 1, -3, 0, 2, -4]));
  const batch = document.createExtension(EXTMeshGPUInstancing).setRequired(true).createInstancedMesh()
    .setAttribute('TRANSLATION', translations);
  scene.addChild(document.createNode('batch').setMesh(node.getMesh()).setExtension('EXT_mesh_gpu_instancing', batch));
  return io.writeBinary(document);
}

/** A copy with another byte at the end of a payload. */
function damaged(glb) {
  const bytes = new Uint8Array(glb);
  const { json, chunks: [{ data }] } = readGlb(bytes); // parts of `bytes`
  const { byteOffset = 0, byteLength } = json.bufferViews[payloadsOf(json)[0].bufferView];
  data[byteOffset + byteLength - 1] ^= 1;
  return bytes;
}
