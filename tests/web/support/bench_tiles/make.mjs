// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Makes all the tilesets that tools/bench-tiles compares, and measures their bytes and errors. A row is a codec with a choice of bits.
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { promisify } from 'node:util';
import { brotliCompress, constants, gzip } from 'node:zlib';
import { readGlb } from '../../../../lib/web/unpack.mjs';
import { CODECS, CODEC_NAMES, Unsupported, withIntegerIds } from './codecs.mjs';
import { changeModels, modelsOf } from './contents.mjs';
import { errorOf, numbered, placedPrimitives } from './errors.mjs';
import { contentsOf, filesIn } from './tileset.mjs';

const MOST_BITS = 30;
const DEFAULT_BITS = 14;
export const RECORD = '.gltf-mcc-tiles.jsonl';
/** Rows of codecs: the same bits for all tiles, and those that each tile needs, with ids as integers. */
export const rowName = (codec, isEach) => `${codec}, ${isEach ? 'best bits of each tile' : 'one number of bits'}`;
export const OURS = 'gltf-mcc';
/** The same tileset, loaded through the service worker instead of gltf-mcc/cesium. */
export const BY_WORKER = 'gltf-mcc, service worker';
export const SOURCE = 'uncompressed';

/** Runs the program; returns its report. */
export function runOurs(program, tileset, folder, report, options = []) {
  execFileSync(program, ['tiles', '--quiet', tileset, folder, '--report', report, ...options], { stdio: ['ignore', 'ignore', 'inherit'] });
  return JSON.parse(readFileSync(report));
}

/** The tiles of a tileset that have models, with what is promised of them: [{ name, level, promise, transforms, bytes }]. */
function tilesOf(tileset, report) {
  const folder = path.dirname(tileset);
  const files = new Map(report.files.map((file) => [file.file, file]));
  return [...contentsOf(tileset)].map(([name, transforms]) => {
    // A tile that ours leaves as it is has no level, and no promise that the others could keep.
    const { level = 0, outcome, promised_error: promised, largest_error: largest, position_bits: bits } = files.get(name);
    return {
      name, level, promise: promised ?? largest, bits: bits?.[1], isCopied: outcome === 'copied', transforms, bytes: readFileSync(path.join(folder, name)),
    };
  }).sort((a, b) => a.level - b.level || (a.name < b.name ? -1 : 1));
}

/** Measures models of a tile that a codec encodes with some bits. */
class Meter {
  #models = [];
  #errors = new Map();

  static async of(tile) {
    const meter = new Meter();
    meter.tile = tile;
    for (const { glb, scale } of await modelsOf(tile.bytes)) {
      const source = await numbered(glb);
      const transforms = tile.transforms.map((matrix) => matrix.map((value) => value * scale));
      meter.#models.push({ source, placed: await placedPrimitives(source), transforms });
    }
    return meter;
  }

  get isModel() {
    return this.#models.length !== 0;
  }

  async error(codec, bits) {
    const key = `${codec} ${bits}`;
    if (!this.#errors.has(key)) this.#errors.set(key, await this.#measure((glb) => CODECS[codec].make(glb, bits)));
    return this.#errors.get(key);
  }

  async #measure(make) {
    let largest = 0;
    for (const { source, placed, transforms } of this.#models) {
      const { error, hasSameIds } = errorOf(placed, await placedPrimitives(await make(source)), transforms);
      if (!hasSameIds) throw new Error(`${this.tile.name}: a codec changed ids`);
      largest = Math.max(largest, error);
    }
    return largest;
  }

  /** The error of models that are compressed already. */
  async errorOfFile(bytes) {
    const compressed = (await modelsOf(bytes)).map(({ glb }) => glb);
    return this.#measure(async () => compressed.shift());
  }

  /** Whether a codec can encode the tile. */
  async canEncode(codec) {
    try {
      await this.error(codec, DEFAULT_BITS);
      return true;
    } catch (error) {
      if (!(error instanceof Unsupported)) throw error;
      return false;
    }
  }

  /** The least number of bits with which no vertex is farther from its source than was promised. */
  async leastBits(codec) {
    const { promise } = this.tile;
    if (!(promise > 0)) return DEFAULT_BITS;
    const { leastBits } = CODECS[codec];
    const first = await this.error(codec, DEFAULT_BITS);
    let bits = Math.min(MOST_BITS, Math.max(leastBits, DEFAULT_BITS + Math.ceil(Math.log2(Math.max(first, 1e-12) / promise))));
    while (bits < MOST_BITS && await this.error(codec, bits) > promise) ++bits;
    while (bits > leastBits && await this.error(codec, bits - 1) <= promise) --bits;
    return bits;
  }
}

/** Writes a copy of the tileset whose vertices have numbers, so that ours is measured in the same way as the others. */
async function writeNumbered(tileset, tiles, folder) {
  copyOthers(path.dirname(tileset), folder, new Set());
  for (const { name, bytes } of tiles) writeFileSync(path.join(folder, name), await changeModels(bytes, numbered));
}

/** Copies all files but some of a folder. */
function copyOthers(from, to, without) {
  for (const name of filesIn(from)) {
    if (without.has(name)) continue;
    mkdirSync(path.dirname(path.join(to, name)), { recursive: true });
    copyFileSync(path.join(from, name), path.join(to, name));
  }
}

const imageBytes = ({ images = [], bufferViews = [] }) => images.reduce((sum, { bufferView }) => sum + (bufferViews[bufferView]?.byteLength ?? 0), 0);

const BROTLI = { params: { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_LGWIN]: 24 } };

/** Bytes of the contents of a folder, as they are and as servers send them. What brotli makes of them is kept below FOLDER.br. */
async function sizesOf(folder, names) {
  const sizes = { bytes: 0, gzip: 0, brotli: 0, images: 0 };
  const add = async (name) => {
    const bytes = readFileSync(path.join(folder, name));
    const [zipped, packed] = await Promise.all([promisify(gzip)(bytes, { level: 9 }), promisify(brotliCompress)(bytes, BROTLI)]);
    const place = path.join(`${folder}.br`, name);
    mkdirSync(path.dirname(place), { recursive: true });
    writeFileSync(place, packed);
    sizes.bytes += bytes.length;
    sizes.gzip += zipped.length;
    sizes.brotli += packed.length;
    for (const { glb } of await modelsOf(bytes)) sizes.images += imageBytes(readGlb(new Uint8Array(glb)).json);
  };
  for (let i = 0; i < names.length; i += 2) await Promise.all(names.slice(i, i + 2).map(add));
  return sizes;
}

/** Adds the error of a tile to the largest ones of a row by level, in metres and as a part of what was promised for the tile. */
function note({ errors, shares }, { level, promise }, error) {
  errors[level] = Math.max(errors[level] ?? 0, error);
  if (promise > 0) shares[level] = Math.max(shares[level] ?? 0, error / promise);
}

/**
 * Makes all tilesets of one below `work`, in folders named like the rows.
 * @returns figures: { tiles, levels: [{ promise, tiles }], rows: { [row]: { bytes, gzip, brotli, images, bits, errors, shares, unchanged } }, seconds }
 */
export async function makeAll(program, tileset, work, say) {
  rmSync(work, { recursive: true, force: true });
  mkdirSync(work, { recursive: true });
  say('gltf-mcc');
  const report = runOurs(program, tileset, path.join(work, OURS), path.join(work, 'report.json'));
  const tiles = tilesOf(tileset, report);
  const names = tiles.map(({ name }) => name);
  await writeNumbered(tileset, tiles, path.join(work, 'numbered'));
  runOurs(program, path.join(work, 'numbered', path.basename(tileset)), path.join(work, 'numbered out'), path.join(work, 'numbered.json'));
  const rows = { [SOURCE]: newRow(), [OURS]: newRow() };
  for (const codec of CODEC_NAMES) rows[rowName(codec, false)] = rows[rowName(codec, true)] = undefined;
  for (const row of Object.keys(rows)) rows[row] = newRow();
  say('bits and errors of each tile');
  const least = await measureTiles(tiles, work, rows);
  const fixed = fixedBits(least);
  say('the other codecs');
  const seconds = await writeRows(tileset, tiles, work, rows, least, fixed);
  copyOthers(path.dirname(tileset), path.join(work, SOURCE), new Set());
  for (const [row, figures] of Object.entries(rows)) {
    say(`bytes of ${row}`);
    Object.assign(figures, await sizesOf(path.join(work, row), names));
  }
  for (const folder of ['numbered', 'numbered out']) rmSync(path.join(work, folder), { recursive: true });
  return { tiles: tiles.length, fixed, levels: levelsOf(tiles), rows, seconds };
}

const newRow = () => ({ bits: [], errors: {}, shares: {}, unchanged: [] });

function levelsOf(tiles) {
  const levels = [];
  for (const { level, promise } of tiles) {
    levels[level] ??= { tiles: 0, promise: Infinity };
    ++levels[level].tiles;
    if (promise > 0) levels[level].promise = Math.min(levels[level].promise, promise);
  }
  // JSON has no infinity; 0 is that there is no promise.
  return Array.from(levels, ({ tiles: number, promise } = { tiles: 0, promise: 0 }) => ({ tiles: number, promise: Number.isFinite(promise) ? promise : 0 }));
}

const FAMILIES = [...new Set(Object.values(CODECS).map(({ errorsOf }) => errorsOf))];

function fixedBits(least) {
  return Object.fromEntries(FAMILIES.map((codec) => [codec, Math.max(1, ...Object.values(least[codec]))]));
}

/**
 * Finds the bits that each tile needs, measures all errors, and notes them in the rows.
 * @returns { [codec]: { [tile]: bits } }
 */
async function measureTiles(tiles, work, rows) {
  const least = Object.fromEntries(FAMILIES.map((codec) => [codec, {}]));
  for (const tile of tiles) {
    const meter = await Meter.of(tile);
    if (!meter.isModel) continue;
    if (tile.isCopied) rows[OURS].unchanged.push(tile.name);
    note(rows[OURS], tile, await meter.errorOfFile(readFileSync(path.join(work, 'numbered out', tile.name))));
    if (tile.bits !== undefined) rows[OURS].bits.push(tile.bits);
    for (const codec of FAMILIES) {
      if (!await meter.canEncode(codec)) continue;
      const bits = await meter.leastBits(codec);
      least[codec][tile.name] = bits;
      noteAll(rows, codec, true, tile, await meter.error(codec, bits), bits);
    }
  }
  const fixed = fixedBits(least);
  for (const tile of tiles) {
    const meter = await Meter.of(tile);
    if (!meter.isModel) continue;
    for (const codec of FAMILIES) {
      if (least[codec][tile.name] !== undefined) noteAll(rows, codec, false, tile, await meter.error(codec, fixed[codec]), fixed[codec]);
    }
  }
  return least;
}

function noteAll(rows, family, isEach, tile, error, bits) {
  for (const codec of CODEC_NAMES.filter((name) => CODECS[name].errorsOf === family)) {
    const row = rows[rowName(codec, isEach)];
    note(row, tile, error);
    row.bits.push(bits);
  }
}

/** The smallest of the contents that some ways to change models make: fewer bits are not always smaller. */
async function smallest(bytes, ways) {
  let best;
  for (const way of ways) {
    const made = await changeModels(bytes, way);
    if (best === undefined || made.length < best.length) best = made;
  }
  return best;
}

/** Writes the tilesets of the other codecs; returns the seconds that each row took, with reading and writing. */
async function writeRows(tileset, tiles, work, rows, least, fixed) {
  const seconds = {};
  const contents = new Set(tiles.map(({ name }) => name));
  for (const codec of CODEC_NAMES) {
    const { make, errorsOf } = CODECS[codec];
    for (const isEach of [false, true]) {
      const row = rowName(codec, isEach);
      copyOthers(path.dirname(tileset), path.join(work, row), contents);
      const begin = performance.now();
      for (const { name } of tiles) {
        const bytes = readFileSync(path.join(path.dirname(tileset), name));
        const bits = isEach ? least[errorsOf][name] ?? DEFAULT_BITS : fixed[errorsOf];
        const choices = isEach ? [[bits, false], [bits, true], [fixed[errorsOf], false]] : [[bits, false]];
        const made = await smallest(bytes, choices.map(([of, hasIntegers]) => (glb) => make(hasIntegers ? withIntegerIds(glb) : glb, of))).catch((error) => {
          if (!(error instanceof Unsupported)) throw error;
          rows[row].unchanged.push(`${name}: ${error.message}`);
          return bytes;
        });
        const place = path.join(work, row, name);
        mkdirSync(path.dirname(place), { recursive: true });
        writeFileSync(place, made);
      }
      seconds[row] = (performance.now() - begin) / 1000;
    }
  }
  return seconds;
}

/** Whether what `work` has was made of these inputs, and remembers that it is, after makeAll(). */
export const isMade = (work, key) => existsSync(path.join(work, 'made')) && readFileSync(path.join(work, 'made'), 'utf8') === key;
export const setMade = (work, key) => writeFileSync(path.join(work, 'made'), key);
