// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// extract_payloads.mjs OUT_DIR FILE.glb...: the payloads of GLBs as files OUT_DIR/NAME.VIEW.mcc.
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { basename } from 'node:path';

const [outDir, ...files] = process.argv.slice(2);
mkdirSync(outDir, { recursive: true });
for (const file of files) {
  const bytes = readFileSync(file);
  const jsonLength = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.toString('utf8', 20, 20 + jsonLength));
  const bin = bytes.subarray(20 + jsonLength + 8);
  const views = new Set();
  for (const mesh of json.meshes ?? []) {
    for (const primitive of mesh.primitives) {
      const extension = primitive.extensions?.KHR_mesh_collapse_compression;
      if (extension) views.add(extension.bufferView);
    }
  }
  for (const index of views) {
    const view = json.bufferViews[index];
    const begin = view.byteOffset ?? 0;
    writeFileSync(`${outDir}/${basename(file, '.glb')}.${index}.mcc`, bin.subarray(begin, begin + view.byteLength));
  }
}
