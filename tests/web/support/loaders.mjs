// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The conformance suite for loaders: what its assets must look like in the memory of an engine.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { MccError } from '../../../lib/web/index.mjs';
import { manifest, readAsset } from './conformance.mjs';

/**
 * Compares all accessors of the primitives of an asset with the manifest.
 * @param asset
 * @param {object} json of the asset
 * @param {(accessor: number) => Promise<ArrayBufferView>} load the elements of an accessor, tight
 */
export async function compareWithManifest(asset, json, load) {
  const primitives = json.meshes.flatMap((mesh) => mesh.primitives);
  assert.equal(primitives.length, asset.primitives.length, asset.file);
  for (const [i, expected] of asset.primitives.entries()) {
    const { indices, attributes, targets = [] } = primitives[i];
    const where = `${asset.file}, primitive ${i}`;
    assert.equal(hashOf(Uint32Array.from(await load(indices))), expected.indices.hash, `${where}, indices`);
    const lists = [[attributes, expected.attributes], ...targets.map((target, k) => [target, expected.targets[k]])];
    for (const [accessors, hashes] of lists) {
      for (const [name, { hash }] of Object.entries(hashes)) {
        assert.equal(hashOf(await load(accessors[name])), hash, `${where}, ${name}`);
      }
    }
  }
}

/**
 * The files that must be refused are: `load` rejects with the library's reason.
 * @param {(bytes: Uint8Array) => Promise<unknown>} load
 */
export async function refusesNegatives(load) {
  for (const asset of manifest.negative) {
    await assert.rejects(load(readAsset(asset)), (error) => {
      const { code } = reasonOf(error);
      // What is wrong with a document an engine may notice first.
      const isExpected = asset.kind === 'document' ? !['Load', 'Trap'].includes(code) : code === asset.kind;
      return isExpected || assert.fail(`${asset.file}: ${code}, ${error.message}`);
    }, asset.file);
  }
}

// Engines put errors into errors of their own.
function reasonOf(error) {
  while (!(error instanceof MccError) && (error.innerError ?? error.cause)) error = error.innerError ?? error.cause;
  return error;
}

// The hash rule of tests/conformance/README.md.
const hashOf = ({ buffer, byteOffset, byteLength }) =>
  createHash('sha256').update(new Uint8Array(buffer, byteOffset, byteLength)).digest('hex').slice(0, 32);
