// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads a tileset from a folder: which contents its tiles show, and by which transforms. Not for untrusted files: it follows every
// URI inside of the folder.
import { readdirSync, readFileSync } from 'node:fs';
import path from 'node:path';

export const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** a * b of matrices by columns. */
export function product(a, b) {
  return IDENTITY.map((_, i) => {
    const [row, column] = [i % 4, 4 * (i >> 2)];
    return a[row] * b[column] + a[row + 4] * b[column + 1] + a[row + 8] * b[column + 2] + a[row + 12] * b[column + 3];
  });
}

/** The names of all files of a folder, relative to it, in one order everywhere. */
export function filesIn(folder) {
  return readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile())
    .map((entry) => path.relative(folder, path.join(entry.parentPath ?? entry.path, entry.name)).split(path.sep).join('/')).sort();
}

/**
 * @param {string} file tileset.json
 * @returns {Map<string, number[][]>} for each content, named relative to the folder of `file`, the transforms of its tiles
 */
export function contentsOf(file) {
  const folder = path.dirname(file);
  const names = filesIn(folder);
  const known = new Set(names);
  const contents = new Map();
  const waiting = [{ name: path.basename(file), transform: IDENTITY }];
  const seen = new Set();
  const show = (name, transform) => {
    if (!known.has(name)) return; // what is missing is missing in every result
    if (!name.endsWith('.json')) {
      contents.set(name, [...(contents.get(name) ?? []), transform]);
    } else if (!seen.has(`${name} ${transform}`)) {
      waiting.push({ name, transform });
      seen.add(`${name} ${transform}`);
    }
  };
  while (waiting.length !== 0) {
    const { name, transform } = waiting.pop();
    const tiles = [{ tile: JSON.parse(readFileSync(path.join(folder, name))).root, parent: transform }];
    while (tiles.length !== 0) {
      const { tile, parent } = tiles.pop();
      const own = product(parent, tile.transform ?? IDENTITY);
      for (const uri of urisOf(tile)) {
        const target = path.posix.join(path.posix.dirname(name), decodeURIComponent(uri.replace(/[?#].*$/, '')));
        if (tile.implicitTiling === undefined) show(target, own);
        else names.filter(patternOf(target)).forEach((found) => show(found, own));
      }
      for (const child of tile.children ?? []) tiles.push({ tile: child, parent: own });
    }
  }
  return contents;
}

const urisOf = ({ content, contents = [] }) => [content, ...contents].filter((one) => one !== undefined).map(({ uri, url }) => uri ?? url);

/** Whether a name is one of those that the template of an implicit tiling stands for. */
function patternOf(template) {
  const escaped = template.replace(/[.*+?^$()|[\]\\]/g, '\\$&').replace(/\{(level|x|y|z)\}/g, '\\d+');
  const pattern = new RegExp(`^${escaped}$`);
  return (name) => pattern.test(name);
}
