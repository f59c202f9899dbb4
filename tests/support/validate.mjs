// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node validate.mjs PATH_OF_GLTF_VALIDATOR LIST: LIST has three lines per model, the source, the
// converted and the decoded file. Prints errors, warnings, infos and hints the source does not have; the
// exit status is 1 when there is one.
import fs from 'node:fs';
import { createRequire } from 'node:module';

const require = createRequire(import.meta.url);
const validator = require(process.argv[2]);
const lines = fs.readFileSync(process.argv[3], 'utf8').trim().split('\n');
const severities = ['error', 'warning', 'info', 'hint'];
// Joints are exact; that of a weight that rounds to 0 stays. Strips are only seen to have degenerate triangles
// when they are lists. Animations that others coded stay so after decoding.
const expected = new Set(['ACCESSOR_JOINTS_USED_ZERO_WEIGHT', 'ACCESSOR_INDEX_TRIANGLE_DEGENERATE', 'UNSUPPORTED_EXTENSION']);
// To a reader without the extension payloads look unused, and so do buffer views that hold a number for unknown extensions.
const expectedOfConverted = new Set([...expected, 'UNUSED_OBJECT']);

/** Number of messages per "severity code". */
async function countMessages(path) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(path)),
                                               { maxIssues: 0 });
  const counts = new Map();
  for (const { severity, code } of report.issues.messages) {
    const key = `${severities[severity]} ${code}`;
    counts.set(key, (counts.get(key) ?? 0) + 1);
  }
  return counts;
}

let failures = 0;
for (let i = 0; i < lines.length; i += 3) {
  const source = await countMessages(lines[i]);
  for (const path of [lines[i + 1], lines[i + 2]]) {
    for (const [key, count] of await countMessages(path)) {
      if (count <= (source.get(key) ?? 0)) continue;
      const code = key.split(' ')[1];
      if ((path === lines[i + 1] ? expectedOfConverted : expected).has(code)) continue;
      console.log(`${path}: ${key}: ${count}, in the source ${source.get(key) ?? 0}`);
      failures += 1;
    }
  }
}
process.exit(failures === 0 ? 0 : 1);
