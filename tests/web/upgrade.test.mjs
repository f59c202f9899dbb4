// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The commands of docs/cli.md that make compressed GLB of 3D Tiles 1.1 from b3dm.
import assert from 'node:assert/strict';
import { execSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { EXTENSION_NAME } from '../../lib/web/document.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { ROOT, SAMPLES } from './support/paths.mjs';
import { PROGRAM } from './support/program.mjs';

const padded = (text, size = Math.ceil(text.length / 8) * 8) => Buffer.from(text.padEnd(size));

/** A district of the sample as a b3dm, without its images, which are files of their own. */
function makeB3dm() {
  const source = readFileSync(path.join(SAMPLES, 'city/town/district-1.b3dm'));
  const tables = [12, 16, 20, 24].map((at) => source.readUInt32LE(at));
  const begin = 28 + tables.reduce((sum, bytes) => sum + bytes);
  const glb = source.subarray(begin);
  const jsonBytes = glb.readUInt32LE(12);
  const json = JSON.parse(glb.toString('utf8', 20, 20 + jsonBytes));
  for (const list of ['materials', 'textures', 'images', 'samplers']) delete json[list];
  for (const { primitives } of json.meshes) for (const primitive of primitives) delete primitive.material;
  // Within the length of the old JSON, so that no length changes.
  padded(JSON.stringify(json), jsonBytes).copy(source, begin + 20);
  return source;
}

test('b3dm are upgraded by 3d-tiles-tools and then compressed', () => {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'gltf-mcc-'));
  try {
    for (const name of ['city', 'bin']) mkdirSync(path.join(folder, name));
    symlinkSync(PROGRAM, path.join(folder, 'bin/gltf-mcc'));
    writeFileSync(path.join(folder, 'city/a.b3dm'), makeB3dm());
    const root = {
      boundingVolume: { sphere: [0, 0, 0, 200] }, refine: 'REPLACE', geometricError: 1, content: { uri: 'a.b3dm' },
    };
    writeFileSync(path.join(folder, 'city/tileset.json'), JSON.stringify({ asset: { version: '1.0' }, geometricError: 9, root }));
    const [command] = readFileSync(path.join(ROOT, 'docs/cli.md'), 'utf8').match(/(?<=^ {4})npx 3d-tiles-tools upgrade .*$/m);
    const PATH = [path.join(folder, 'bin'), path.join(ROOT, 'tests/web/node_modules/.bin'), process.env.PATH].join(path.delimiter);
    execSync(command, { cwd: folder, env: { ...process.env, PATH }, stdio: ['ignore', 'ignore', 'inherit'] });
    const read = (name) => readFileSync(path.join(folder, 'city-small', name));
    const tileset = JSON.parse(read('tileset.json'));
    assert.equal(tileset.asset.version, '1.1');
    assert.equal(tileset.root.content.uri, 'a.glb');
    const { json } = readGlb(new Uint8Array(read('a.glb')));
    for (const name of [EXTENSION_NAME, 'EXT_mesh_features', 'EXT_structural_metadata']) {
      assert.ok(json.extensionsUsed.includes(name), name);
    }
  } finally {
    rmSync(folder, { recursive: true });
  }
});
