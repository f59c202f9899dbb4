// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Models inside of tiles of 3D Tiles 1.0: what unpackTile() changes of a tile, what it does not, and what it refuses.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, describe, test } from 'node:test';
import { namedBytes } from '../../lib/web/budget.mjs';
import { payloadsOf } from '../../lib/web/document.mjs';
import { createDecoderPool, MccError, unpackGlb, unpackTile } from '../../lib/web/index.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { glbOf } from './support/glb.mjs';
import { SAMPLES } from './support/paths.mjs';
import { PROGRAM } from './support/program.mjs';
import { b3dm, cmpt, i3dm, i3dmOf, joined, modelTile, pnts, readTile, textBytes } from './support/tiles.mjs';

const assetNamed = (part) => readAsset(manifest.assets.find(({ file }) => file.includes(part)));
const MODEL = assetNamed('_tetrahedron.glb');
const MODELS = manifest.assets.slice(0, 30).map(readAsset);
const PLAIN = await unpackGlb(MODEL);
const TABLES = [textBytes('{"BATCH_LENGTH":2}'), new Uint8Array([1, 2, 3]), textBytes('{"name":["a","b"]}'), new Uint8Array([9, 8, 7, 6, 5])];

const failureOf = (promise) => promise.then(() => assert.fail('nothing was wrong'), (error) => error);

async function assertRefused(tile, pattern, code = 'Document') {
  const error = await failureOf(unpackTile(tile));
  assert.ok(error instanceof MccError, error.stack);
  assert.equal(error.code, code, error.message);
  assert.match(error.message, pattern);
}

/** Changed copies. */
const withNumber = (bytes, at, number) => {
  const changed = bytes.slice();
  new DataView(changed.buffer).setUint32(at, number, true);
  return changed;
};
const numberAt = (bytes, at) => new DataView(bytes.buffer, bytes.byteOffset).getUint32(at, true);

/** The tables are those of the source and padding: JSON has spaces, other bytes have zeros. */
function assertTables(tables, source) {
  tables.forEach((table, i) => {
    const { length } = source[i] ?? [];
    assert.deepEqual(table.subarray(0, length ?? 0), source[i] ?? new Uint8Array(0));
    assert.ok(table.length - (length ?? 0) < 8);
    assert.ok(table.subarray(length).every((byte) => byte === (i % 2 === 0 ? 0x20 : 0)), `table ${i} is padded with something else`);
  });
}

describe('tiles with compressed models', () => {
  test('the model becomes what unpackGlb() makes of it; tables of all lengths stay byte for byte', async () => {
    for (const [i, glb] of MODELS.entries()) {
      for (const magic of ['b3dm', 'i3dm']) {
        const tables = [`{"BATCH_LENGTH":${10 ** (i % 9)}}`, 'x'.repeat(i % 10), `"${'y'.repeat(i % 7)}"`, 'z'.repeat((3 * i) % 11)].map(textBytes);
        const source = modelTile(magic, glb, { tables, padding: i % 3 });
        const tile = readTile(await unpackTile(source));
        assert.equal(tile.magic, magic);
        assert.deepEqual(tile.glb, await unpackGlb(glb));
        assertTables(tile.tables, tables);
      }
    }
  });

  test('tables that are aligned keep their lengths, and what comes after them in the header is kept', async () => {
    const tables = [textBytes('{"a":"bcde"}'), new Uint8Array(8), textBytes('{"a": 1}'), new Uint8Array(16)]; // 28 + 12, and on
    const tile = await unpackTile(b3dm(MODEL, { tables }));
    assert.deepEqual([12, 16, 20, 24].map((at) => numberAt(tile, at)), tables.map(({ length }) => length));
    assert.equal(numberAt(await unpackTile(i3dm(MODEL)), 28), 1);
  });

  test('tiles inside of composites inside of composites, in their order, with tiles of other kinds', async () => {
    const points = pnts(new Uint8Array([1, 2, 3, 4])); // 32 bytes
    const linked = i3dmOf('https://a.example/lamp.glb'.padEnd(32)); // 64 bytes
    assert.deepEqual([points.length % 8, linked.length % 8], [0, 0]);
    const inner = cmpt([points, b3dm(MODEL, { tables: TABLES, padding: 1 }), cmpt([i3dm(MODEL, { tables: TABLES })], 3), linked]);
    const unpacked = await unpackTile(cmpt([inner, cmpt([]), MODEL, b3dm(PLAIN, { tables: TABLES }), b3dm(MODEL)], 7));
    const { tiles: [first, second, glb, plain, last] } = readTile(withoutLinks(unpacked));
    assert.deepEqual(first.tiles.map(({ magic }) => magic), ['pnts', 'b3dm', 'cmpt', 'link']);
    assert.deepEqual(first.tiles[0].bytes, points);
    assert.deepEqual(first.tiles[3].bytes, withoutLinks(linked));
    for (const tile of [first.tiles[1], first.tiles[2].tiles[0], plain]) assertTables(tile.tables, TABLES);
    for (const tile of [first.tiles[1], first.tiles[2].tiles[0], plain, last]) assert.deepEqual(tile.glb, PLAIN);
    assert.deepEqual(second.tiles, []);
    assert.deepEqual(readGlb(glb.bytes), readGlb(await unpackGlb(MODEL)));
  });

  test('a GLB inside of a composite ends at a multiple of 8', async () => {
    const names = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => 'n'.repeat(i));
    const lengths = new Set();
    for (const name of names) {
      const glb = withName(MODEL, name);
      const { tiles: [inner, after] } = readTile(await unpackTile(cmpt([glb, b3dm(MODEL)])));
      const plain = await unpackGlb(glb);
      lengths.add(plain.length % 8);
      assert.equal(numberAt(inner.bytes, 8), inner.bytes.length);
      assert.deepEqual(readGlb(inner.bytes), readGlb(plain));
      assert.deepEqual(after.glb, PLAIN);
    }
    assert.deepEqual([...lengths].sort(), [0, 4]);
  });

  test('bytes inside of a larger buffer, and a decoder of another thread', async () => {
    const tile = b3dm(MODEL, { tables: TABLES });
    const pool = createDecoderPool({ workers: 1 });
    const inside = joined([new Uint8Array(5), tile, new Uint8Array(9)]).subarray(5, 5 + tile.length);
    assert.deepEqual(await unpackTile(inside, { decode: pool.decodePayload }), await unpackTile(tile));
    pool.dispose();
  });

  test('a GLB by itself', async () => assert.deepEqual(await unpackTile(MODEL), PLAIN));
});

/** i3dm with a URI are read as tiles of another kind here. */
function withoutLinks(tile) {
  const bytes = Buffer.from(tile);
  for (let at = bytes.indexOf('i3dm'); at !== -1; at = bytes.indexOf('i3dm', at + 1)) {
    if (bytes.readUInt32LE(at + 28) === 0) bytes.write('link', at);
  }
  return new Uint8Array(bytes);
}

/** A GLB with another name in its JSON, padded as it must be. */
function withName(glb, name) {
  const { json, chunks: [{ data }] } = readGlb(glb);
  return glbOf({ ...json, asset: { ...json.asset, generator: name } }, data);
}

describe('tiles without compressed models', () => {
  const old = withNumber(PLAIN, 4, 1);
  const others = {
    'a b3dm, not aligned': b3dm(PLAIN, { tables: TABLES, padding: 3 }),
    'an i3dm': i3dm(PLAIN),
    'an i3dm with a URI': i3dmOf('lamp.glb'),
    'a b3dm with glTF 1.0': b3dm(old),
    'a cmpt': cmpt([b3dm(PLAIN, { padding: 1 }), cmpt([i3dm(PLAIN)], 5), pnts(new Uint8Array(3)), PLAIN]),
    'an empty cmpt': cmpt([]),
    'pnts': pnts(textBytes('KHR_mesh_collapse_compression')),
    'a GLB': PLAIN,
    'JSON': textBytes('{ "asset": { "version": "1.0" } }'),
    'a few bytes': textBytes('b3d'),
    'nothing': new Uint8Array(0),
  };
  for (const [name, tile] of Object.entries(others)) {
    test(name, async () => {
      const before = tile.slice();
      assert.equal(await unpackTile(tile), tile);
      assert.deepEqual(tile, before);
    });
  }

  test('glTF 1.0 stays next to a compressed model', async () => {
    const { tiles } = readTile(await unpackTile(cmpt([b3dm(old), b3dm(MODEL)])));
    assert.deepEqual(tiles.map(({ glb }) => glb), [old, PLAIN]);
  });
});

describe('damaged tiles', () => {
  const whole = cmpt([b3dm(MODEL, { tables: TABLES }), cmpt([i3dm(MODEL, { tables: TABLES, padding: 2 })])]);

  for (const [name, tile] of Object.entries({ b3dm: b3dm(MODEL, { tables: TABLES }), i3dm: i3dm(MODEL, { tables: TABLES }), cmpt: whole })) {
    test(`${name}: every truncation is refused, also where the length is made to fit`, async () => {
      for (let length = 4; length < tile.length; ++length) {
        const cut = tile.slice(0, length);
        await assertRefused(cut, /^byte \d+: /);
        if (length >= 12) await assertRefused(withNumber(cut, 8, length), /byte \d+: /);
      }
    });
  }

  const inner = 16; // where the first tile of the cmpt is
  const second = inner + numberAt(whole, inner + 8);
  const glbAt = inner + 28 + TABLES.reduce((sum, { length }) => sum + length, 0);
  const lies = [
    ['the length', 8, [0, 11, 15, whole.length - 8, whole.length + 1, 0xffffffff], /^byte (0|8): /],
    ['the version', 4, [0, 2, 0x80000001], /^byte 4: the tile has version/],
    ['the number of tiles', 12, [0, 1, 3], /^byte \d+: .*inner tile/],
    ['the number of tiles, far too many', 12, [whole.length, 0xffffffff], /^byte 12: the tile claims to hold/],
    ['the length of an inner tile', inner + 8, [27, second - inner - 8], /^byte \d+: /],
    ['the length of an inner tile, impossible', inner + 8, [0, 11, whole.length, 0xffffffff], /^byte 24: the inner tile 0 claims/],
    ['the version of an inner tile', inner + 4, [0, 2], /^byte 20: the tile has version/],
    ...[0, 1, 2, 3].map((i) => [`the length of table ${i}`, inner + 12 + 4 * i, [0, TABLES[i].length + 1], /^byte \d+: there is no GLB/]),
    ...[0, 1, 2, 3].map((i) => [
      `the length of table ${i}, impossible`, inner + 12 + 4 * i, [whole.length, 0xffffffff], new RegExp(`^byte ${inner + 12 + 4 * i}: a table of the tile`),
    ]),
    ['the length of a GLB', glbAt + 8, [0, 11, MODEL.length + 1, 0xffffffff], /^byte \d+: the GLB claims/],
    ['the magic of a GLB', glbAt, [0], /there is no GLB where the tables end/],
    ['gltfFormat', second + 16 + 28, [2, 0xffffffff], /gltfFormat is neither 0 nor 1/],
  ];
  for (const [name, at, numbers, pattern] of lies) {
    test(`${name} is another`, async () => {
      await unpackTile(whole);
      for (const number of numbers) await assertRefused(withNumber(whole, at, number), pattern);
    });
  }

  test('a table of a tile whose model is elsewhere is too long', async () => {
    const linked = i3dmOf('lamp.glb');
    await assertRefused(withNumber(linked, 24, linked.length - 31), /^byte 24: a table of the tile/);
  });

  test('what is wrong inside of a model has its place and its code', async () => {
    const damaged = readAsset(manifest.negative.find(({ file }) => file.includes('damaged_checksum')));
    await assertRefused(cmpt([b3dm(MODEL), b3dm(damaged)]), new RegExp(`^in the GLB at byte ${16 + b3dm(MODEL).length + 28}: .*checksum`), 'BadChecksum');
    await assertRefused(b3dm(withNumber(MODEL, 4, 4)), /^in the GLB at byte 28: byte 4: only versions 2/);
  });

  test('composites are nested to a bound, and far deeper ones cost nothing', async () => {
    const nested = (count) => {
      const tile = b3dm(MODEL);
      const headers = new Uint32Array(4 * count);
      const total = 16 * count + tile.length;
      for (let i = 0; i < count; ++i) headers.set([0x74706d63, 1, total - 16 * i, 1], 4 * i);
      return joined([new Uint8Array(headers.buffer), tile]);
    };
    let tile = readTile(await unpackTile(nested(64)));
    while (tile.tiles !== undefined) [tile] = tile.tiles;
    assert.deepEqual(tile.glb, PLAIN);
    for (const count of [65, 200_000]) await assertRefused(nested(count), /byte 1024: composite tiles are nested deeper than 64/);
  });

  test('a composite of many tiles of twelve bytes takes time in proportion', async () => {
    const one = textBytes('none\0\0\0\0\x0c\0\0\0');
    const many = cmpt([...Array(300_000).fill(one), b3dm(MODEL)]);
    const unpacked = await unpackTile(many);
    assert.deepEqual(unpacked.subarray(16, 16 + 3_600_000), many.subarray(16, 16 + 3_600_000));
  });

  test('mutations are refused by an MccError or make a tile', async () => {
    let seed = 1;
    const random = (below) => {
      seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
      return Math.floor((seed / 2 ** 32) * below);
    };
    let refused = 0;
    for (let i = 0; i < 3000; ++i) {
      const mutated = whole.slice();
      // Half of them in the headers, where most bytes matter.
      for (let k = 0; k <= i % 3; ++k) mutated[random(i % 2 === 0 ? whole.length : glbAt + 20)] ^= 1 << random(8);
      await unpackTile(mutated, { limits: { maxDecodedBytes: 1 << 24 } }).catch((error) => {
        assert.ok(error instanceof MccError && error.code !== 'Trap', error.stack);
        ++refused;
      });
    }
    assert.ok(refused > 1000, `${refused}`);
  });

  test('other arguments than bytes', async () => {
    for (const bytes of [undefined, 'b3dm', whole.buffer]) assert.equal((await failureOf(unpackTile(bytes))).code, 'Document');
  });
});

describe('tiles that the program has compressed', () => {
  const source = path.join(SAMPLES, 'city');
  const compressed = mkdtempSync(path.join(tmpdir(), 'gltf-mcc-city-'));
  after(() => rmSync(compressed, { recursive: true }));
  execFileSync(PROGRAM, ['tiles', '--quiet', path.join(source, 'tileset.json'), compressed]);

  /** The models of a file and their tables, in a list. */
  const modelsOf = (tile) => (tile.tiles === undefined ? [tile] : tile.tiles.flatMap(modelsOf));

  for (const file of readdirSync(source, { recursive: true }).filter((name) => /\.(b3dm|i3dm|cmpt)$/.test(name))) {
    test(`${path.basename(file)} has its models and tables again`, async () => {
      const [before, packed] = [source, compressed].map((folder) => new Uint8Array(readFileSync(path.join(folder, file))));
      const unpacked = await unpackTile(packed);
      const [old, plain] = [before, unpacked].map((tile) => modelsOf(readTile(tile)));
      assert.deepEqual(plain.map(({ magic, tables }) => ({ magic, tables })), old.map(({ magic, tables }) => ({ magic, tables })));
      for (const [i, { glb }] of plain.entries()) {
        const [was, is] = [old[i].glb, glb].map((bytes) => readGlb(bytes).json);
        assert.deepEqual(triangleCounts(is), triangleCounts(was));
        assert.equal(JSON.stringify(is).includes('KHR_mesh_collapse'), false);
      }
      assert.equal(await unpackTile(unpacked), unpacked);
    });
  }
});

const triangleCounts = ({ meshes, accessors }) => meshes.flatMap(({ primitives }) => primitives.map(({ indices }) => accessors[indices].count / 3));

test('limits hold for all models of a tile together', async () => {
  const payloads = payloadsOf(readGlb(MODEL).json);
  const named = payloads.reduce((sum, payload) => sum + namedBytes(payload), 0);
  const tile = cmpt([b3dm(MODEL), i3dm(MODEL), MODEL]);
  await unpackTile(tile, { limits: { maxDecodedBytes: 3 * named } });
  let calls = 0;
  const decode = async () => { ++calls; };
  await assert.rejects(unpackTile(tile, { decode, limits: { maxDecodedBytes: 3 * named - 1 } }), { code: 'Limit' });
  assert.equal(calls, 0, 'the limit is checked before anything is decoded');
});
