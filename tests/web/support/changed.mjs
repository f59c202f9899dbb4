// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Models whose documents were changed after they were compressed.
import { readGlb, writeGlb } from '../../../lib/web/unpack.mjs';
import { convert, readSample } from './program.mjs';

/** Changes the document of a GLB. */
export function changed(glb, change) {
  const { json, chunks } = readGlb(glb);
  change(json);
  return writeGlb(json, chunks);
}

/** A skinned mesh without morph targets, which would keep its positions float. */
export const skinnedAlone = () => changed(convert(readSample('skinned')), (json) => {
  const [{ primitives: [primitive] }] = json.meshes;
  delete primitive.targets;
  delete primitive.extensions.KHR_mesh_collapse_compression.targets;
  delete json.meshes[0].weights;
  delete json.animations;
});
