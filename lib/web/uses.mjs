// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/** Plugins ask for each block. */
const known = new WeakMap();

/**
 * Lists what the primitives of a document draw of a payload.
 * @param {object[]} claims from payloadsOf()
 * @returns {{ mesh: number, primitive: number, piece: number, part: number, attributes: Record<string, number> }[]} attributes: the
 *   number in the piece by name, without those of morph targets
 */
export function usesOf(claims) {
  if (!known.has(claims)) known.set(claims, listUses(claims));
  return known.get(claims);
}

function listUses(claims) {
  return claims.map(({ path, piece, part, attributes }) => {
    const [, mesh, primitive] = /^\/meshes\/(\d+)\/primitives\/(\d+)\//.exec(path).map(Number);
    const own = attributes.filter(({ morphTarget }) => morphTarget === 0);
    const nameOf = (attribute) => attribute.path.slice(`${path}/attributes/`.length);
    return { mesh, primitive, piece, part, attributes: Object.fromEntries(own.map((entry) => [nameOf(entry), entry.attribute])) };
  });
}
