// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { withoutCopies } from './three_copies.mjs';
import { IntegerMeshes } from './three_integers.mjs';

/**
 * Makes GLTFLoader use one accessor for all that have the same elements, and integers.
 * @param {import('three/addons/loaders/GLTFLoader.js').GLTFParser} parser whose lists are those of PayloadViews
 * @param {object} json the document as it was, which payloadsOf() has checked
 * @param {object} [plugin] gets the functions that make integers, if they are wanted
 */
export function adaptMeshes(parser, json, plugin) {
  if (parser.json.bufferViews.length === json.bufferViews?.length) return; // there are no payloads
  parser.json.meshes = withoutCopies(json, parser.json.accessors);
  if (!plugin) return;
  const meshes = new IntegerMeshes(parser);
  // The loader calls these of every plugin that has them.
  for (const name of ['loadMesh', 'loadNode', 'makeIntegers']) plugin[name] = (...given) => meshes[name](...given);
}
