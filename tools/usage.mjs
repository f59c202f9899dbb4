// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// As tools/usage, for scripts in JavaScript, which import it first.
import { readFileSync } from 'node:fs';

if (['--help', '-h'].includes(process.argv[2])) {
  const lines = readFileSync(process.argv[1], 'utf8').split('\n').slice(3);
  const end = lines.findIndex((line) => !line.startsWith('//'));
  console.log(lines.slice(0, end).map((line) => line.replace(/^\/\/ ?/, '')).join('\n'));
  process.exit();
}
