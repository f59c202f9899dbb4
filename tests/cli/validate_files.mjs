// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node validate_files.mjs PATH_OF_GLTF_VALIDATOR FILE…: validates files with those beside them. Prints
// every message except the remarks that the extension is not known, that nobody refers to its payload,
// and that a GLB names a second file; the exit status is 1 when there are any.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

const validator = createRequire(import.meta.url)(process.argv[2]);
const expected = new Set(['UNSUPPORTED_EXTENSION', 'UNUSED_OBJECT', 'URI_GLB']);
let isClean = true;
for (const file of process.argv.slice(3)) {
  const folder = path.dirname(file);
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
    uri: path.basename(file),
    externalResourceFunction: async (uri) =>
      new Uint8Array(fs.readFileSync(path.join(folder, decodeURIComponent(uri)))),
  });
  for (const { severity, code, pointer, message } of report.issues.messages) {
    if (severity >= 2 && expected.has(code)) continue;
    console.log(`${file}: ${code} ${pointer}: ${message}`);
    isClean = false;
  }
  // Loaded and looked into, not skipped.
  const loaded = report.info.resources.filter(({ byteLength }) => byteLength > 0).length;
  console.log(`${path.basename(file)}: ${loaded} of ${report.info.resources.length} resources`);
}
process.exit(isClean ? 0 : 1);
