// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which positions may be integers of a lattice, where that becomes part of a mesh's own place. Engines make one mesh of a mesh with one
// primitive, which also is its node, else a node with a mesh for each.

/** Of what payloadsOf() has not checked. A copy of that of document.mjs, which bundles would take apart for it. */
export const listOf = (value) => (Array.isArray(value) ? value : []);

/**
 * Lists the positions that must stay as they are: accessors of meshes whose place is not theirs alone, or means something else. These have
 * morph targets, instances or a volume, or are a node that is animated or has children. Joints place a skinned mesh, whatever its node
 * does, unless another node shows it without them.
 * @param {object} json a document that payloadsOf() has checked
 * @param {boolean} isSkinFixed whether nothing can come before the joints
 * @returns {Set<number>}
 */
export function fixedPositions({ meshes = [], nodes = [], materials = [], animations = [] }, isSkinFixed) {
  const targets = animations.flatMap(({ channels }) => listOf(channels)).map((channel) => channel?.target);
  const moved = new Set(targets.filter((target) => target?.path !== 'weights').map((target) => target?.node));
  const skinned = new Set(nodes.filter(({ skin }) => skin !== undefined).map(({ mesh }) => mesh));
  const isFixedNode = ({ mesh, skin, children, camera, extensions }, index) => extensions?.EXT_mesh_gpu_instancing !== undefined
    || (skin !== undefined && isSkinFixed)
    || (skin === undefined && (skinned.has(mesh)
      || (listOf(meshes[mesh]?.primitives).length === 1 && (children?.length > 0 || camera !== undefined || extensions !== undefined
        || moved.has(index) || moved.has(undefined))))); // undefined: a pointer to anything
  const fixed = new Set(nodes.filter(isFixedNode).map(({ mesh }) => mesh));
  const hasVolume = ({ material }) => materials?.[material]?.extensions?.KHR_materials_volume !== undefined;
  const isFixed = ({ primitives }, index) => fixed.has(index)
    || listOf(primitives).some((primitive) => primitive.targets !== undefined || hasVolume(primitive));
  return new Set(meshes.filter(isFixed).flatMap(({ primitives }) => listOf(primitives).map(({ attributes }) => attributes?.POSITION)));
}
