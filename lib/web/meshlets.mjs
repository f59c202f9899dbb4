// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Meshlets of decoded triangles, the same as those of lib/src/reader/meshlets.cpp. Apart from the decoder, whose size does not grow by it.
import { requireArgument } from './error.mjs';

const NONE = -1; // and not 2 ** 32 - 1, so that engines compute with integers
const MOST_TRIANGLES = 2 ** 28;

function checkArguments(indices, vertexCount, { maxVertices, maxTriangles, shape }) {
  const isIn = (number, least, most) => Number.isInteger(number) && number >= least && number <= most;
  requireArgument(indices instanceof Uint8Array || indices instanceof Uint16Array || indices instanceof Uint32Array,
    'indices must be a Uint8Array, Uint16Array or Uint32Array');
  requireArgument(indices.length % 3 === 0 && indices.length <= 3 * MOST_TRIANGLES, 'indices must have three numbers for each of up to 2^28 triangles');
  requireArgument(isIn(vertexCount, 0, 2 ** 32 - 1), 'vertexCount must be a whole number below 2^32');
  requireArgument(isIn(maxVertices, 3, 256), 'maxVertices must be a whole number from 3 to 256');
  requireArgument(isIn(maxTriangles, 1, 512), 'maxTriangles must be a whole number from 1 to 512');
  requireArgument(['round', 'order'].includes(shape), 'shape must be round or order');
  let largest = -1;
  for (let i = 0; i < indices.length; ++i) largest = Math.max(largest, indices[i]);
  requireArgument(largest < vertexCount, 'an index is not below vertexCount');
}

/** The corners of each vertex as lists: the first of a vertex, and after each corner the next one. */
function linkCorners(indices, vertexCount) {
  const first = new Int32Array(vertexCount).fill(NONE);
  const next = new Int32Array(indices.length);
  for (let corner = indices.length - 1; corner >= 0; --corner) {
    next[corner] = first[indices[corner]];
    first[indices[corner]] = corner;
  }
  return { first, next };
}

/** The meshlet that grows, and those before it. */
class Builder {
  constructor(indices, vertexCount, { maxVertices, maxTriangles }) {
    const triangleCount = indices.length / 3;
    // A meshlet is closed when it is half full, or when a triangle's vertices have no room: then it has at least maxVertices - 2.
    const least = Math.min(Math.ceil(maxTriangles / 2), Math.floor(maxVertices / 3));
    const most = Math.ceil(triangleCount / least);
    Object.assign(this, { indices, maxVertices, maxTriangles });
    this.meshlets = new Uint32Array(4 * most);
    this.vertices = new Uint32Array(indices.length);
    this.triangles = new Uint8Array(indices.length + 3 * most);
    this.place = new Uint32Array(vertexCount); // where a vertex was last put in `vertices`, plus 1
    this.meshletCount = 0;
    this.firstVertex = this.firstByte = this.vertexCount = this.triangleCount = 0;
  }

  fits(triangle) {
    const { indices, place, firstVertex } = this;
    const corner = 3 * triangle;
    const added = (place[indices[corner]] <= firstVertex) + (place[indices[corner + 1]] <= firstVertex) + (place[indices[corner + 2]] <= firstVertex);
    return this.triangleCount < this.maxTriangles && this.vertexCount + added <= this.maxVertices;
  }

  take(triangle) {
    const { indices, place, firstVertex } = this;
    let to = this.firstByte + 3 * this.triangleCount++;
    for (let corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
      const vertex = indices[corner];
      if (place[vertex] <= firstVertex) {
        const end = firstVertex + this.vertexCount++;
        this.vertices[end] = vertex;
        place[vertex] = end + 1;
      }
      this.triangles[to++] = place[vertex] - 1 - firstVertex;
    }
  }

  close() {
    if (this.triangleCount === 0) return;
    this.meshlets.set([this.firstVertex, this.firstByte, this.vertexCount, this.triangleCount], 4 * this.meshletCount++);
    this.firstVertex += this.vertexCount;
    this.firstByte += Math.ceil(3 * this.triangleCount / 4) * 4;
    this.vertexCount = this.triangleCount = 0;
  }
}

/**
 * Takes the triangles around the vertices of the meshlet, from one of them on. The number of those that are looked at in vain is limited,
 * because a vertex may be in any number of them.
 */
function grow(builder, { first, next }, isTaken, begin) {
  let missesLeft = builder.maxVertices;
  for (let i = begin; i < builder.vertexCount; ++i) {
    const vertex = builder.vertices[builder.firstVertex + i];
    let before = NONE; // the corner whose `next` leads here, or none: then it is `first`
    let corner = first[vertex];
    while (corner !== NONE) {
      const triangle = (corner / 3) | 0;
      if (isTaken[triangle] === 0) {
        if (!builder.fits(triangle)) {
          if (builder.triangleCount === builder.maxTriangles || --missesLeft === 0) return;
          before = corner;
          corner = next[corner];
          continue;
        }
        builder.take(triangle);
        isTaken[triangle] = 1;
      }
      corner = next[corner];
      if (before === NONE) first[vertex] = corner;
      else next[before] = corner;
    }
  }
}

function buildRound(builder, triangleCount, links) {
  const isTaken = new Uint8Array(triangleCount);
  for (let triangle = 0; triangle < triangleCount; ++triangle) {
    if (isTaken[triangle] !== 0) continue;
    // A meshlet that has nothing around it goes on elsewhere while it is small. One that is at least half full is better closed: its
    // sphere stays small.
    if (!builder.fits(triangle) || 2 * builder.triangleCount >= builder.maxTriangles) builder.close();
    const begin = builder.vertexCount;
    builder.take(triangle);
    isTaken[triangle] = 1;
    grow(builder, links, isTaken, begin);
  }
}

/** Divides a triangle list into meshlets, see meshlets.d.mts. */
export function buildMeshlets(indices, vertexCount, options = {}) {
  const all = { maxVertices: 64, maxTriangles: 124, shape: 'round', ...options };
  checkArguments(indices, vertexCount, all);
  const builder = new Builder(indices, vertexCount, all);
  const triangleCount = indices.length / 3;
  if (all.shape === 'round') {
    buildRound(builder, triangleCount, linkCorners(indices, vertexCount));
  } else {
    for (let triangle = 0; triangle < triangleCount; ++triangle) {
      if (!builder.fits(triangle)) builder.close();
      builder.take(triangle);
    }
  }
  builder.close();
  return {
    meshlets: builder.meshlets.slice(0, 4 * builder.meshletCount),
    vertices: builder.vertices.slice(0, builder.firstVertex),
    triangles: builder.triangles.slice(0, builder.firstByte),
    meshletCount: builder.meshletCount,
  };
}
