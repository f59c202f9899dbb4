// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Khronos' glTF validator finds nothing new in the models of a compressed tileset, whatever contains them.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import validator from 'gltf-validator';
import { EXTENSION_NAME, payloadsOf } from '../../lib/web/document.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { contentsOf } from './support/bench_tiles/tileset.mjs';
import { SAMPLES } from './support/paths.mjs';
import { PROGRAM } from './support/program.mjs';

const SOURCE = path.join(SAMPLES, 'city/tileset.json');
const HEADER_BYTES = { b3dm: 28, i3dm: 32 };

/** The GLBs in a content, without what follows them in it. */
function modelsOf(bytes) {
  const magic = bytes.toString('latin1', 0, 4);
  if (magic === 'glTF') return [bytes.subarray(0, bytes.readUInt32LE(8))];
  if (magic === 'cmpt') {
    const models = [];
    for (let at = 16, left = bytes.readUInt32LE(12); left > 0; --left) {
      const length = bytes.readUInt32LE(at + 8);
      models.push(...modelsOf(bytes.subarray(at, at + length)));
      at += length;
    }
    return models;
  }
  assert.ok(magic in HEADER_BYTES, `a content begins with "${magic}"`);
  const tableBytes = [12, 16, 20, 24].reduce((sum, at) => sum + bytes.readUInt32LE(at), 0);
  return modelsOf(bytes.subarray(HEADER_BYTES[magic] + tableBytes));
}

/** { ["severity CODE"]: count } of a model; severities are 0 for errors to 3 for hints. */
async function issuesOf(glb, folder) {
  const { issues } = await validator.validateBytes(new Uint8Array(glb), {
    maxIssues: 0,
    externalResourceFunction: async (uri) => new Uint8Array(readFileSync(path.join(folder, decodeURIComponent(uri)))),
  });
  const counts = {};
  for (const { severity, code } of issues.messages) counts[`${severity} ${code}`] = (counts[`${severity} ${code}`] ?? 0) + 1;
  return counts;
}

test('compressing a tileset adds no issue but that the extension and its payloads are unknown', async () => {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'gltf-mcc-'));
  try {
    execFileSync(PROGRAM, ['tiles', '--quiet', SOURCE, folder]);
    let compressedCount = 0;
    for (const name of contentsOf(SOURCE).keys()) {
      const [sources, results] = [path.dirname(SOURCE), folder].map((root) => modelsOf(readFileSync(path.join(root, name))));
      assert.equal(results.length, sources.length, name);
      for (const [i, glb] of results.entries()) {
        const { json } = readGlb(new Uint8Array(glb));
        const before = await issuesOf(sources[i], path.dirname(path.join(path.dirname(SOURCE), name)));
        const isCompressed = json.extensionsUsed?.includes(EXTENSION_NAME) ?? false;
        compressedCount += isCompressed;
        // To a validator without the extension payloads look unused.
        const allowed = isCompressed ? { '2 UNSUPPORTED_EXTENSION': 1, '2 UNUSED_OBJECT': payloadsOf(json).length } : {};
        for (const [issue, count] of Object.entries(await issuesOf(glb, path.dirname(path.join(folder, name))))) {
          assert.ok(count <= (before[issue] ?? 0) + (allowed[issue] ?? 0), `${name}, model ${i}: ${count} of "${issue}", ${before[issue] ?? 0} in the source`);
        }
      }
    }
    assert.ok(compressedCount >= 20, `${compressedCount} models are compressed`);
  } finally {
    rmSync(folder, { recursive: true });
  }
});
