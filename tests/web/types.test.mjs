// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { spawnSync } from 'node:child_process';
import assert from 'node:assert/strict';
import path from 'node:path';
import test from 'node:test';
import { ENGINES, ROOT } from './support/paths.mjs';

test('the types fit the code that applications write', () => {
  const compiler = path.join(ENGINES, 'typescript/bin/tsc');
  const project = path.join(ROOT, 'tests/web/types');
  const { stdout, status } = spawnSync(process.execPath, [compiler, '-p', project], { encoding: 'utf8' });
  assert.equal(status, 0, stdout);
});
