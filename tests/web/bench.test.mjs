// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// tools/bench-web: that all codecs decode the same, and what the tables say. Times are not judged.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { CODECS, loadDecoder } from './support/bench/decoders.mjs';
import { encodeFile, writeUnits } from './support/bench/encode.mjs';
import { startNode } from './support/bench/node.mjs';
import { summary, tables } from './support/bench/tables.mjs';
import { readUnits } from './support/bench/units.mjs';
import { PROGRAM } from './support/program.mjs';
import { ROOT, SAMPLES } from './support/paths.mjs';

const BENCH = path.join(ROOT, 'tools/bench-web');
const sample = (name) => path.join(SAMPLES, `${name}.glb`);

async function withFolder(t) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'bench-web-test-'));
  t.after(() => rmSync(folder, { recursive: true }));
  return folder;
}

/** Corners of all triangles of what a codec decodes: how many, and sums of coordinates and their squares. */
async function cornersOf(codec, units) {
  const decoded = await (await loadDecoder(codec))(units);
  const found = { count: 0, sums: [0, 0, 0], squares: [0, 0, 0] };
  const add = (indices, positions) => {
    found.count += indices.length;
    for (const index of indices) {
      for (let c = 0; c < 3; ++c) {
        found.sums[c] += positions(index, c);
        found.squares[c] += positions(index, c) ** 2;
      }
    }
  };
  decoded.forEach((unit, i) => {
    if (codec === 'mcc') {
      for (const { attributes, parts } of unit.pieces) {
        for (const { indices } of parts) add(indices, (index, c) => attributes[0].array[3 * index + c]);
      }
    } else if (codec === 'meshopt') {
      const [{ stride }, { origin, range, bits }] = units[i].streams;
      const indices = new (stride === 2 ? Uint16Array : Uint32Array)(unit[0].buffer);
      const lattice = new Uint16Array(unit[1].buffer); // 4 numbers per vertex
      add(indices, (index, c) => origin[c] + lattice[4 * index + c] * (range / (2 ** bits - 1)));
    } else {
      add(unit.indices, (index, c) => unit.attributes[0].array[3 * index + c]);
    }
  });
  return found;
}

for (const name of ['textured', 'two_materials', 'skinned']) {
  test(`${name}: all codecs decode the same positions`, async (t) => {
    const folder = await withFolder(t);
    const { triangles, codecs } = await encodeFile(PROGRAM, sample(name));
    writeUnits(folder, codecs);
    const expected = await cornersOf('draco 0', codecs['draco 0']);
    assert.equal(expected.count, 3 * triangles);
    for (const codec of CODECS) {
      // Halfway between two points of the lattice we and Draco may round differently: a step is 6e-5.
      const tolerance = codec === 'mcc' ? 1e-5 : 1e-6;
      const units = await readUnits(new URL(`file://${folder}/`), codec);
      assert.deepEqual(units.map(({ bytes }) => bytes.length), codecs[codec].map(({ bytes }) => bytes.length));
      const theirs = await cornersOf(codec, units);
      assert.equal(theirs.count, expected.count, codec);
      for (const moment of ['sums', 'squares']) {
        theirs[moment].forEach((sum, c) => {
          const off = Math.abs(sum - expected[moment][c]) / expected.count;
          assert.ok(off < tolerance, `${codec}: the ${moment} of coordinate ${c} differ by ${off} per corner`);
        });
      }
    }
  });
}

test('processes of Node measure every codec', async (t) => {
  const folder = await withFolder(t);
  writeUnits(folder, (await encodeFile(PROGRAM, sample('torus'))).codecs);
  const node = await startNode();
  for (const codec of CODECS) {
    const times = await node.cold(folder, codec);
    assert.deepEqual(Object.keys(times), ['first', 'second']);
    assert.ok(times.first > 0 && times.second > 0, JSON.stringify(times));
  }
  const warm = await node.warm(folder, CODECS, { warmups: 1, pause: 0, runs: 1 });
  assert.deepEqual(Object.keys(warm), CODECS);
});

test('the tables have means of ratios per set, and the worst file', () => {
  const times = (mcc, others) => Object.fromEntries(CODECS.map((codec) => [codec, codec === 'mcc' ? mcc : others]));
  const result = (set, name, mcc, others) => ({
    set, name, triangles: 1000, native: mcc / 2, brotli: 1,
    bytes: { ...times(mcc, others), 'mcc+brotli': mcc, 'meshopt+brotli': others },
    engines: { Engine: { warm: times(mcc, others), first: times(mcc, others), second: times(mcc, others) } },
    whole: { mcc, tool: others },
  });
  const results = [result('one', 'a', 10, 20), result('one', 'b', 10, 5), result('two', 'c', 10, 30)];
  const text = summary(results);
  assert.match(text, /^\| Engine, warm \| one \| 1\.00 \| 1\.00 \| 1\.00 \| 1\.00 \| 0\.50 \| b 0\.50 \|$/m);
  assert.match(text, /^\| Engine, second decode \| two \| 3\.00 \| 3\.00 \| 3\.00 \| 3\.00 \|  \| c 3\.00 \|$/m);
  assert.match(text, /^\| whole files, brotli \| one \|  \|  \|  \|  \| 1\.00 \| b 0\.50 \|$/m);
  assert.match(tables(results), /^\| \*\*mean, two\*\* .*\*\*3\.00\*\* \|$/m);
  assert.match(tables(results), /^\| a \| 1,000 \| 10 \| 10 \| 20 \|/m);
});

test('the program prints tables, and says what is wrong with its arguments', () => {
  const printed = execFileSync(BENCH, ['--quick', '--parts', 'node', sample('torus')], { encoding: 'utf8', stdio: 'pipe' });
  assert.match(printed, /^\| Node [\d.]+, warm, ms \| mcc \|/m);
  assert.match(printed, /^\| torus \| 4,096 \|/m);
  for (const [args, message] of [
    [['--parts', 'deno'], /not "deno"/], [['--write', '--parts', 'node'], /needs all parts/],
    [['no_such.glb'], /there is no .*no_such\.glb/], [['--unknown'], /usage/],
  ]) {
    const { status, stderr } = spawnSync(BENCH, args, { encoding: 'utf8', env: { ...process.env, MCC_CORPUS_DIR: '/nowhere' } });
    assert.equal(status, 2);
    assert.match(stderr, message);
  }
});
