// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Measures how far every decoded vertex is from the source vertices that became it.
//
// If a file does not keep the order of vertices, it does not say which vertex became which. That is
// not necessary: on a lattice, a source vertex goes to the nearest point. This point is therefore a
// decoded vertex, and no other decoded vertex is nearer.

/** Points in the cells of a hash table; equal points are entered once. */
class PointTable {
  constructor(points, cell) {
    this.points = points;
    this.cell = cell;
    const count = points.length / 3;
    this.mask = 2 ** Math.ceil(Math.log2(2 * count + 1)) - 1;
    this.first = new Int32Array(this.mask + 1).fill(-1);
    this.next = new Int32Array(count).fill(-1);
    /** For each point, the first one that is equal to it. */
    this.same = Int32Array.from({ length: count }, (_, i) => i);
    for (let i = 0; i < count; ++i) this.enter(i);
  }

  slot(x, y, z) {
    let h = Math.imul(x, 0x9e3779b1) ^ Math.imul(y, 0x85ebca77) ^ Math.imul(z, 0xc2b2ae3d);
    h = Math.imul(h ^ (h >>> 15), 0x2c1b3c6d);
    return (h ^ (h >>> 13)) & this.mask;
  }

  enter(i) {
    const { points: p, cell } = this;
    const [x, y, z] = [p[3 * i], p[3 * i + 1], p[3 * i + 2]];
    const slot = this.slot(Math.floor(x / cell), Math.floor(y / cell), Math.floor(z / cell));
    for (let j = this.first[slot]; j !== -1; j = this.next[j]) {
      if (p[3 * j] === x && p[3 * j + 1] === y && p[3 * j + 2] === z) {
        this.same[i] = j;
        return;
      }
    }
    this.next[i] = this.first[slot];
    this.first[slot] = i;
  }

  /** Returns the point nearest to x, y, z, or -1 if none is within `reach` along each axis. */
  nearest(x, y, z, reach) {
    const { points: p, cell } = this;
    const high = [Math.floor((x + reach) / cell), Math.floor((y + reach) / cell), Math.floor((z + reach) / cell)];
    let best = -1;
    let least = 3 * reach * reach; // the cells contain points farther away too
    for (let cx = Math.floor((x - reach) / cell); cx <= high[0]; ++cx) {
      for (let cy = Math.floor((y - reach) / cell); cy <= high[1]; ++cy) {
        for (let cz = Math.floor((z - reach) / cell); cz <= high[2]; ++cz) {
          for (let j = this.first[this.slot(cx, cy, cz)]; j !== -1; j = this.next[j]) {
            const distance = (p[3 * j] - x) ** 2 + (p[3 * j + 1] - y) ** 2 + (p[3 * j + 2] - z) ** 2;
            if (distance > least) continue;
            least = distance;
            best = j;
          }
        }
      }
    }
    return best;
  }
}

/** Returns the corners of the bounding box of points, and its longest side. */
export function boxOf(points) {
  const box = { min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity], side: 0 };
  for (let i = 0; i < points.length; ++i) {
    box.min[i % 3] = Math.min(box.min[i % 3], points[i]);
    box.max[i % 3] = Math.max(box.max[i % 3], points[i]);
  }
  if (points.length !== 0) box.side = Math.max(...box.max.map((value, s) => value - box.min[s]));
  return box;
}

/**
 * Measures the errors.
 * @param {ArrayLike<number>} source positions, 3 per vertex
 * @param {ArrayLike<number>} decoded as `source`, in any order
 * @param {number} promised no coordinate is off by more
 * @returns {{ errors: Float32Array, missed: number }} errors: for each decoded vertex, the largest
 * distance of the source vertices that became it; missed: number of source vertices without a
 * decoded one as near as promised
 */
export function measureErrors(source, decoded, promised) {
  const side = boxOf(source).side || 1;
  // Positions are floats, so rounding may exceed the bound slightly.
  const reach = promised * 1.001 + side * 2 ** -22;
  const table = new PointTable(decoded, Math.max(4 * reach, side * 1e-6));
  const errors = new Float32Array(decoded.length / 3);
  let missed = 0;
  for (let i = 0; i < source.length; i += 3) {
    const [x, y, z] = [source[i], source[i + 1], source[i + 2]];
    const j = table.nearest(x, y, z, reach);
    if (j === -1) {
      ++missed;
      continue;
    }
    errors[j] = Math.max(errors[j], Math.hypot(decoded[3 * j] - x, decoded[3 * j + 1] - y, decoded[3 * j + 2] - z));
  }
  return { errors: errors.map((error, i) => errors[table.same[i]]), missed };
}
