// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Whole files as the usual tools compress them, at the bits that gltf-mcc has by default.
import { readFileSync } from 'node:fs';
import { Logger, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { draco, meshopt } from '@gltf-transform/functions';
import draco3d from 'draco3d';
import { pack } from 'gltfpack';
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';

const BITS = { quantizePosition: 14, quantizeNormal: 10, quantizeTexcoord: 12, quantizeColor: 8, quantizeWeight: 12, quantizeGeneric: 12 };
const PACK = '-vp 14 -vn 10 -vt 12 -vc 8 -kv -kn -km -ke'.split(' ');

const packed = (...options) => async (source) => {
  const files = { 'in.glb': source };
  const iface = { read: (name) => files[name], write: (name, bytes) => { files[name] = bytes; } };
  await pack(['-i', 'in.glb', '-o', 'out.glb', ...options, ...PACK], iface);
  return files['out.glb'];
};

const transformed = (step) => async (source, io) => {
  const document = await io.readBinary(source);
  await document.transform(step());
  return io.writeBinary(document);
};

const dracoOf = (speed) => transformed(() => draco({ method: 'edgebreaker', encodeSpeed: speed, decodeSpeed: speed, ...BITS }));

/** What makes a file, by its heading. */
const TOOLS = {
  'gltfpack -cc': packed('-cc'),
  'gltfpack -cz': packed('-cz'),
  'transform draco 0': dracoOf(0),
  'transform draco 5': dracoOf(5),
  'transform meshopt': transformed(() => meshopt({ encoder: MeshoptEncoder, level: 'high', ...BITS })),
};
export const TOOL_NAMES = Object.keys(TOOLS);

/**
 * @param {string[]} [names] of tools
 * @returns {Promise<Map<string, Uint8Array>>} the file of each tool
 */
export async function wholeFiles(path, names = TOOL_NAMES) {
  await Promise.all([MeshoptDecoder.ready, MeshoptEncoder.ready]);
  const io = new NodeIO().setLogger(new Logger(Logger.Verbosity.ERROR)).registerExtensions(ALL_EXTENSIONS).registerDependencies({
    'draco3d.decoder': await draco3d.createDecoderModule(),
    'draco3d.encoder': await draco3d.createEncoderModule(),
    'meshopt.decoder': MeshoptDecoder,
    'meshopt.encoder': MeshoptEncoder,
  });
  const source = new Uint8Array(readFileSync(path));
  const files = new Map();
  for (const name of names) files.set(name, await TOOLS[name](source, io));
  return files;
}

/** Versions of the packages, by their names. */
export function versions() {
  const read = (name) => JSON.parse(readFileSync(new URL(`../../node_modules/${name}/package.json`, import.meta.url))).version;
  return Object.fromEntries(['draco3d', 'meshoptimizer', 'gltfpack', '@gltf-transform/functions'].map((name) => [name, read(name)]));
}
