// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The glTF inside of tile contents, by 3d-tiles-tools' own functions.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { ROOT } from '../paths.mjs';

const ours = createRequire(import.meta.url);
export const { GltfUtilities, TileFormats } = ours('3d-tiles-tools');
export const toolsVersions = () => Object.fromEntries(['3d-tiles-tools', 'gltf-pipeline', 'draco3d'].map((name) => [
  name, JSON.parse(readFileSync(path.join(ROOT, `tests/web/node_modules/${name}/package.json`))).version]));

const magicOf = (bytes) => bytes.toString('latin1', 0, 4);

/**
 * Replaces the models of a content.
 * @param {Buffer} bytes a GLB, b3dm, i3dm or cmpt; anything else is returned as it is
 * @param {(glb: Buffer, instanceScale: number) => Promise<Uint8Array>} change
 * @returns {Promise<Buffer>}
 */
export async function changeModels(bytes, change) {
  const magic = magicOf(bytes);
  if (magic === 'glTF') return Buffer.from(await change(bytes, 1));
  if (magic === 'cmpt') {
    const inner = [];
    const composite = TileFormats.readCompositeTileData(bytes);
    for (const tile of composite.innerTileBuffers) inner.push(await changeModels(tile, change));
    return TileFormats.createCompositeTileDataBuffer({ header: composite.header, innerTileBuffers: inner });
  }
  if (magic !== 'b3dm' && magic !== 'i3dm') return bytes;
  const tile = TileFormats.readTileData(bytes);
  if (tile.header.gltfFormat === 0) return bytes; // an i3dm whose model is another file
  const { featureTable, batchTable } = tile;
  const glb = Buffer.from(await change(Buffer.from(tile.payload), magic === 'i3dm' ? instanceScale(featureTable) : 1));
  const make = magic === 'b3dm' ? TileFormats.createB3dmTileDataFromGlb : TileFormats.createI3dmTileDataFromGlb;
  return TileFormats.createTileDataBuffer(make(glb, featureTable.json, featureTable.binary, batchTable.json, batchTable.binary));
}

/** The models in a content: [{ glb, scale }]. */
export async function modelsOf(bytes) {
  const models = [];
  await changeModels(bytes, async (glb, scale) => {
    models.push({ glb, scale });
    return glb;
  });
  return models;
}

/** The largest scale of the instances of an i3dm. */
function instanceScale({ json, binary }) {
  const numbers = (name, components) => (json[name] === undefined ? [] : Array.from(
    { length: components * json.INSTANCES_LENGTH },
    (_, i) => Math.abs(binary.readFloatLE(json[name].byteOffset + 4 * i)),
  ));
  const [uniform, each] = [numbers('SCALE', 1), numbers('SCALE_NON_UNIFORM', 3)];
  const largest = (list) => list.reduce((a, b) => Math.max(a, b), 0);
  return (uniform.length === 0 ? 1 : largest(uniform)) * (each.length === 0 ? 1 : largest(each));
}
