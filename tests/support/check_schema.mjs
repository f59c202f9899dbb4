// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node check_schema.mjs NODE_MODULES SCHEMA LIST: LIST has a line per GLB, "valid PATH" or "invalid PATH". Validates the
// extension objects of each against the schema and prints the lines that are wrong; the exit status is 1 when there is
// one. "invalid" asks for at least one object that the schema refuses. Objects of its own that are wrong in one place
// each, must be refused besides.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

const EXTENSION = 'KHR_mesh_collapse_compression';
const [modules, schemaPath, listPath] = process.argv.slice(2);
const Ajv2020 = createRequire(path.join(path.resolve(modules), 'index.js'))('ajv/dist/2020').default;

// What the schema takes from glTF's own schemas.
const glTFProperty = {
  $id: 'glTFProperty.schema.json',
  type: 'object',
  properties: { extensions: { type: 'object', additionalProperties: { type: 'object' } }, extras: {} },
};
const glTFid = { $id: 'glTFid.schema.json', type: 'integer', minimum: 0 };

const ajv = new Ajv2020({ allErrors: true, strict: true, strictTypes: false });
ajv.addKeyword({ keyword: 'gltf_detailedDescription', schemaType: 'string' });
const validate = ajv.addSchema(glTFProperty).addSchema(glTFid).compile(JSON.parse(fs.readFileSync(schemaPath, 'utf8')));

const WRONG = [
  {}, 1, [], { bufferView: -1 }, { bufferView: 0.5 }, { bufferView: '0' }, { bufferView: null },
  ...['piece', 'part'].flatMap((name) => [-1, 0.5, '0', 2 ** 32].map((value) => ({ bufferView: 0, [name]: value }))),
  ...[[], 1, { POSITION: -1 }, { POSITION: '0' }, { POSITION: 2 ** 32 }].map((attributes) => ({ bufferView: 0, attributes })),
  ...[[], {}, [1], [{ POSITION: 0.5 }]].map((targets) => ({ bufferView: 0, targets })),
  { bufferView: 0, extensions: 1 }, { bufferView: 0, extensions: { OTHER: 1 } },
];
const RIGHT = [
  { bufferView: 0 },
  { bufferView: 7, piece: 4294967295, part: 1, attributes: { POSITION: 0, _OWN: 3 }, targets: [{}, { POSITION: 1 }] },
  { bufferView: 0, attributes: {}, extensions: { OTHER: {} }, extras: [1], later: true },
];

function extensionsOf(file) {
  const bytes = fs.readFileSync(file);
  const json = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString('utf8'));
  const objects = json.meshes.flatMap((mesh) => mesh.primitives).map((primitive) => primitive.extensions?.[EXTENSION]);
  return objects.filter((object) => object !== undefined);
}

let failures = 0;
function report(what) {
  console.log(what);
  failures += 1;
}

for (const object of WRONG) {
  if (validate(object)) report(`accepted: ${JSON.stringify(object)}`);
}
for (const object of RIGHT) {
  if (!validate(object)) report(`refused: ${JSON.stringify(object)}: ${ajv.errorsText(validate.errors)}`);
}
const counts = { valid: 0, invalid: 0 };
for (const line of fs.readFileSync(listPath, 'utf8').trim().split('\n')) {
  const space = line.indexOf(' ');
  const [kind, file] = [line.slice(0, space), line.slice(space + 1)];
  const objects = extensionsOf(file);
  const refused = objects.filter((object) => !validate(object));
  if (objects.length === 0) report(`${file}: has no extension object`);
  if (kind === 'valid' && refused.length > 0) report(`${file}: ${JSON.stringify(refused[0])} is refused`);
  if (kind === 'invalid' && refused.length === 0) report(`${file}: nothing is refused`);
  counts[kind] += 1;
}
console.log(`${counts.valid} valid and ${counts.invalid} invalid files, ${failures} failures`);
process.exit(failures === 0 ? 0 : 1);
