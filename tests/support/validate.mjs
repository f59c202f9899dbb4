// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node validate.mjs PATH_OF_GLTF_VALIDATOR LIST [--odd] [--table]: LIST has three lines per model, the source, the
// converted and the decoded file. Prints errors, warnings, infos and hints the source does not have; the
// exit status is 1 when there is one. With --table, also prints the bytes and the numbers of messages of all.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

const require = createRequire(import.meta.url);
const validator = require(process.argv[2]);
const lines = fs.readFileSync(process.argv[3], 'utf8').trim().split('\n');
const severities = ['error', 'warning', 'info', 'hint'];
// Joints are exact; that of a weight that rounds to 0 stays. Strips are only seen to have degenerate triangles
// when they are lists. Animations that others coded stay so after decoding.
const expected = new Set(['ACCESSOR_JOINTS_USED_ZERO_WEIGHT', 'ACCESSOR_INDEX_TRIANGLE_DEGENERATE', 'UNSUPPORTED_EXTENSION']);
// To a reader without the extension payloads look unused, and so do buffer views that hold a number for unknown extensions.
const codings = ['EXT_meshopt_compression', 'KHR_draco_mesh_compression'];
// With --odd, of documents that have everything wrong already: values that are wrong in one accessor of the source are so in
// two where primitives no longer share it, and so are its extras, and it is as unused; vectors near ones that are not of unit length are off by
// rounding; data URIs that a .gltf may have are in a GLB.
const isOdd = process.argv.includes('--odd');
const hasTable = process.argv.includes('--table');
const ofValues = /^ACCESSOR_(INVALID_FLOAT|NON_CLAMPED|INVALID_SIGN|VECTOR3_NON_UNIT|WEIGHTS_.*|JOINTS_.*)$/;
const mayRepeat = key => ofValues.test(key.split(' ')[1]) || key === 'info NON_OBJECT_EXTRAS' || key === 'info UNUSED_OBJECT';
const expectedOfConverted = new Set([...expected, 'UNUSED_OBJECT']);

/** Number of messages per "severity code", and of those that say that values are coded by others. */
async function countMessages(file) {
  const readBeside = async uri => new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri))));
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)),
                                               { maxIssues: 0, externalResourceFunction: readBeside });
  const counts = new Map();
  for (const { severity, code } of report.issues.messages) {
    const key = `${severities[severity]} ${code}`;
    counts.set(key, (counts.get(key) ?? 0) + 1);
  }
  const used = report.info?.extensionsUsed ?? [];
  counts.isCoded = codings.some(name => used.includes(name));
  return counts;
}

/** A row of Markdown: the name, then of source, converted and decoded file the bytes and the numbers of errors, warnings, infos, hints. */
function rowOf(paths, found) {
  const cells = found.map((counts, k) => {
    const numbers = severities.map(name => [...counts].reduce((sum, [key, n]) => sum + (key.startsWith(name) ? n : 0), 0));
    return `${fs.statSync(paths[k]).size} | ${numbers.join(' ')}`;
  });
  return `| ${path.basename(paths[0]).replace(/_source\.glb$/, '')} | ${cells.join(' | ')} |`;
}

let failures = 0;
if (hasTable) console.log('| document | source, bytes | messages | converted | messages | decoded | messages |\n|---|---:|---|---:|---|---:|---|');
for (let i = 0; i < lines.length; i += 3) {
  const source = await countMessages(lines[i]).catch(error => ({ failure: String(error) }));
  if (source.failure !== undefined) {  // the validator itself fails, at a document that nothing of ours has touched
    console.log(`${lines[i]}: the validator cannot read the source: ${source.failure.split('\n')[0]}`);
    continue;
  }
  const found = [source];
  for (const file of [lines[i + 1], lines[i + 2]]) {
    found.push(await countMessages(file));
    for (const [key, count] of found.at(-1)) {
      if (count <= (source.get(key) ?? 0)) continue;
      const code = key.split(' ')[1];
      if (isOdd && mayRepeat(key) && source.has(key)) continue;
      if (isOdd && (code === 'URI_GLB' || code === 'DATA_URI_GLB')) continue;
      if (source.isCoded && ofValues.test(code)) continue;  // they cannot be seen in the source
      // Buffer views keep their numbers for the sake of extensions that are not known.
      if (code === 'UNUSED_OBJECT' && source.has('info UNSUPPORTED_EXTENSION')) continue;
      if ((file === lines[i + 1] ? expectedOfConverted : expected).has(code)) continue;
      console.log(`${file}: ${key}: ${count}, in the source ${source.get(key) ?? 0}`);
      failures += 1;
    }
  }
  if (hasTable) console.log(rowOf(lines.slice(i, i + 3), found));
}
process.exit(failures === 0 ? 0 : 1);
