// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { execFile } from 'node:child_process';
import { existsSync } from 'node:fs';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { promisify } from 'node:util';
import { NodeIO } from '@gltf-transform/core';
import { EXTMeshGPUInstancing } from '@gltf-transform/extensions';
import { CLI, SAMPLES } from './paths.mjs';

const run = promisify(execFile);

/** Models by name: where they come from, and how they are converted. */
const MODELS = {
  textured: { sample: 'textured', options: [] },
  skinned: { sample: 'skinned', options: [] },
  morphed: { sample: 'morphed', options: [] },
  materials: { sample: 'two_materials', options: [] }, // several primitives
  shared: { sample: 'shared_vertices', options: [] }, // several primitives on the same accessors
  integers: { sample: 'quantized', options: [] }, // of KHR_mesh_quantization
  ordinary: { sample: 'textured', options: ['--indices-only'] }, // attributes that are not in the payload
  lossless: { sample: 'textured', options: ['--lossless'] },
  instances: { make: instances, options: [] },
};

/**
 * @returns {Promise<Map<string, Uint8Array>>} for each model NAME the source NAME, the compressed NAME.mcc, and NAME.plain, which is
 *   NAME.mcc as the program decodes it
 */
export async function makeModels() {
  if (!existsSync(CLI)) throw new Error(`${CLI} is missing: tools/build release gltf-mcc, or name the program in MCC_CLI`);
  const folder = await mkdtemp(path.join(os.tmpdir(), 'gltf-mcc-web-'));
  try {
    const models = new Map();
    for (const [name, { sample, make, options }] of Object.entries(MODELS)) {
      const file = (suffix) => path.join(folder, `${name}${suffix}.glb`);
      await writeFile(file(''), make ? await make() : await readFile(path.join(SAMPLES, `${sample}.glb`)));
      await run(CLI, ['convert', '--quiet', '--compare', 'none', ...options, file(''), file('.mcc')]);
      await run(CLI, ['decode', '--quiet', file('.mcc'), file('.plain')]);
      for (const suffix of ['', '.mcc', '.plain']) models.set(name + suffix, await readFile(file(suffix)));
    }
    return models;
  } finally {
    await rm(folder, { recursive: true });
  }
}

/** A mesh that two nodes draw, one of them three times (EXT_mesh_gpu_instancing). */
async function instances() {
  const io = new NodeIO().registerExtensions([EXTMeshGPUInstancing]);
  const document = await io.read(path.join(SAMPLES, 'torus.glb'));
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

/** A copy whose last payload byte is another. Payloads are the views that extension objects name. */
export function damaged(glb) {
  const bytes = new Uint8Array(glb);
  const view = new DataView(bytes.buffer);
  const jsonBytes = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + jsonBytes)));
  const { KHR_mesh_collapse_compression: { bufferView } } = json.meshes[0].primitives[0].extensions;
  const { byteOffset = 0, byteLength } = json.bufferViews[bufferView];
  bytes[28 + jsonBytes + byteOffset + byteLength - 1] ^= 1;
  return bytes;
}
