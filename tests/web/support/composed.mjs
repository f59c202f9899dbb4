// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A model whose mesh is for our extension, whose animation and instances meshoptimizer compresses, and whose texture is KTX2.
import { NodeIO } from '@gltf-transform/core';
import { EXTMeshGPUInstancing, EXTMeshoptCompression, KHRTextureBasisu } from '@gltf-transform/extensions';
import { createDefaultContainer, KHR_DF_MODEL_UASTC, write } from 'ktx-parse';
import { MeshoptEncoder } from 'meshoptimizer';
import { convert, readSample } from './program.mjs';

const KEYS = 200;
const INSTANCES = 100;
const RED = [220, 60, 40, 255];

/** A KTX2 file of one block of 4 x 4 texels of a color, in UASTC. */
export function ktx2(color) {
  const container = createDefaultContainer();
  // Mode 8, a block of one color: five bits of mode, then eight of each component.
  const bits = [[0x17, 5], ...color.map((component) => [component, 8])];
  const block = new Uint8Array(16);
  let at = 0;
  for (const [value, count] of bits) {
    for (let i = 0; i < count; ++i, ++at) block[at >> 3] |= (value >> i & 1) << (at & 7);
  }
  Object.assign(container, { pixelWidth: 4, pixelHeight: 4, levelCount: 1, levels: [{ levelData: block, uncompressedByteLength: 16 }] });
  Object.assign(container.dataFormatDescriptor[0], {
    colorModel: KHR_DF_MODEL_UASTC, texelBlockDimension: [3, 3, 0, 0], bytesPlane: [16, 0, 0, 0, 0, 0, 0, 0],
    samples: [{ bitOffset: 0, bitLength: 127, channelType: 3, samplePosition: [0, 0, 0, 0], sampleLower: 0, sampleUpper: 0xffffffff }],
  });
  return new Uint8Array(write(container));
}

const scalars = (count, at) => Float32Array.from({ length: count }, (_, i) => at(i));

/** The source: a textured mesh that turns, and a hundred instances of it. */
async function sourceDocument(io) {
  const document = await io.readBinary(readSample('textured'));
  const root = document.getRoot();
  const [buffer] = root.listBuffers();
  const [node] = root.listScenes()[0].listChildren();
  const accessor = (type, array) => document.createAccessor('', buffer).setType(type).setArray(array);
  const sampler = document.createAnimationSampler().setInput(accessor('SCALAR', scalars(KEYS, (i) => i / 30)))
    .setOutput(accessor('VEC4', scalars(4 * KEYS, (i) => [0, Math.sin((i >> 2) / 60), 0, Math.cos((i >> 2) / 60)][i % 4])));
  document.createAnimation('turn').addSampler(sampler)
    .addChannel(document.createAnimationChannel().setTargetNode(node).setTargetPath('rotation').setSampler(sampler));
  const batch = document.createExtension(EXTMeshGPUInstancing).setRequired(true).createInstancedMesh()
    .setAttribute('TRANSLATION', accessor('VEC3', scalars(3 * INSTANCES, (i) => [(i / 3 | 0) % 10, 0, -(i / 30 | 0)][i % 3])));
  root.listScenes()[0].addChild(document.createNode('batch').setMesh(node.getMesh()).setExtension('EXT_mesh_gpu_instancing', batch));
  document.createExtension(KHRTextureBasisu).setRequired(true);
  const texture = document.createTexture('red').setImage(ktx2(RED)).setMimeType('image/ktx2');
  for (const material of root.listMaterials()) material.setBaseColorTexture(texture);
  return document;
}

/**
 * @returns {Promise<{ plain: Uint8Array, composed: Uint8Array }>} GLBs of the same numbers; in `composed`, the mesh is in our
 *   extension, animation and instances are in EXT_meshopt_compression
 */
export async function composedModel() {
  await MeshoptEncoder.ready;
  const io = new NodeIO().registerExtensions([EXTMeshGPUInstancing, EXTMeshoptCompression, KHRTextureBasisu])
    .registerDependencies({ 'meshopt.encoder': MeshoptEncoder });
  const document = await sourceDocument(io);
  const plain = await io.writeBinary(document);
  document.createExtension(EXTMeshoptCompression).setRequired(true);
  return { plain, composed: convert(await io.writeBinary(document), ['--lossless']) };
}
