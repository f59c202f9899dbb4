// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node validate_report.mjs FOLDER_OF_NODE_MODULES SCHEMA REPORT…: checks reports against a JSON schema of 2020-12, prints
// what is wrong; the exit status is 1 when anything is.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

const [modules, schema, ...reports] = process.argv.slice(2);
const require = createRequire(path.join(modules, 'x.js'));
const Ajv = require('ajv/dist/2020').default;
const validate = new Ajv({ allErrors: true, strict: true, allowUnionTypes: true, strictTypes: false, strictRequired: false })
  .compile(JSON.parse(fs.readFileSync(schema)));
let isValid = true;
for (const report of reports) {
  if (validate(JSON.parse(fs.readFileSync(report)))) continue;
  isValid = false;
  for (const { instancePath, message, params } of validate.errors) {
    console.log(`${report}: ${instancePath} ${message} ${JSON.stringify(params)}`);
  }
}
process.exit(isValid ? 0 : 1);
