// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import './support/peers.mjs';
import * as decoder from '../../lib/web/index.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { compareWithManifest, refusesNegatives } from './support/loaders.mjs';

const { KHRMeshCollapseCompression } = await import('../../lib/web/gltf-transform.mjs');

await decoder.ready;
const io = new NodeIO().registerExtensions([...ALL_EXTENSIONS, KHRMeshCollapseCompression]).registerDependencies({ 'mcc.decoder': decoder });

test('glTF-Transform reads the elements of the conformance assets', async () => {
  for (const asset of manifest.assets) {
    const bytes = readAsset(asset);
    const { json } = await io.binaryToJSON(bytes);
    const document = await io.readBinary(bytes);
    const accessors = document.getRoot().listAccessors();
    await compareWithManifest(asset, json, (accessor) => accessors[accessor].getArray());
  }
});

test('glTF-Transform refuses the negative assets', () => refusesNegatives((bytes) => io.readBinary(bytes)));
