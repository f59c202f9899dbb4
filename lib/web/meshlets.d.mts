// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { Owned } from './types.mjs';

export interface MeshletOptions {
  /** 3 to 256; default 64. */
  maxVertices?: number;
  /** 1 to 512; default 124. */
  maxTriangles?: number;
  /** 'round', the default: the triangles around its vertices. 'order': the next ones of the list, which takes half the time. */
  shape?: 'round' | 'order';
}

/** Meshlets as MeshoptClusterizer of meshoptimizer has them; its computeMeshletBounds() takes them. Owns its arrays. */
export interface Meshlets {
  /** Four for each: where its vertices and its triangles begin (in bytes, a multiple of 4), and how many of both there are. */
  meshlets: Owned<Uint32Array>;
  /** For each meshlet its vertices, as the indices have them. */
  vertices: Owned<Uint32Array>;
  /** For each triangle three bytes: the numbers of its corners among the vertices of its meshlet. */
  triangles: Owned<Uint8Array>;
  meshletCount: number;
}

/**
 * Divides the triangles of a DecodedPart into meshlets. A meshlet begins with the first triangle of the list that no earlier one has; each
 * triangle is in one of them, with its corners in the order of the list. Linear time. Throws MccError (BadArgument). The result is the same
 * as that of mcc::buildMeshlets() in C++.
 * @param vertexCount each index is below it: wedgeCount of the piece
 */
export function buildMeshlets(indices: Uint8Array | Uint16Array | Uint32Array, vertexCount: number, options?: MeshletOptions): Meshlets;
