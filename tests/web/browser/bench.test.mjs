// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { startChromium } from '../support/bench/chromium.mjs';
import { CODECS } from '../support/bench/decoders.mjs';
import { encodeFile, writeUnits } from '../support/bench/encode.mjs';
import { SAMPLES } from '../support/paths.mjs';
import { PROGRAM } from '../support/program.mjs';

test('pages measure every codec', async (t) => {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'bench-web-test-'));
  const units = path.join(folder, 'a model');
  writeUnits(units, (await encodeFile(PROGRAM, path.join(SAMPLES, 'torus.glb'))).codecs);
  const chromium = await startChromium(folder);
  t.after(() => chromium.close());
  t.after(() => rmSync(folder, { recursive: true }));
  for (const codec of CODECS) {
    const times = await chromium.cold(units, codec);
    assert.deepEqual(Object.keys(times), ['first', 'second']);
    assert.ok(times.first > 0 && times.second > 0, JSON.stringify(times));
  }
  assert.deepEqual(Object.keys(await chromium.warm(units, CODECS, { warmups: 1, pause: 0, runs: 1 })), CODECS);
});
