// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/**
 * Returns the meshes of a document with one accessor for all that have the same elements: GLTFLoader makes an attribute of each accessor, which
 * the graphics card gets once.
 * @param {object} json a document that payloadsOf() has checked
 * @param {object[]} accessors of PayloadViews
 */
export function withoutCopies({ meshes, bufferViews }, accessors) {
  const first = new Map();
  const firstOf = (index) => {
    const { bufferView } = accessors[index] ?? {};
    if (!(bufferView >= bufferViews.length)) return index;
    if (!first.has(bufferView)) first.set(bufferView, index);
    return first.get(bufferView);
  };
  const changed = (map) => map && Object.fromEntries(Object.entries(map).map(([name, index]) => [name, firstOf(index)]));
  return meshes.map((mesh) => ({
    ...mesh,
    primitives: mesh.primitives?.map((primitive) => ({
      ...primitive, indices: firstOf(primitive.indices), attributes: changed(primitive.attributes), targets: primitive.targets?.map(changed),
    })),
  }));
}
