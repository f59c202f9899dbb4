// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node tools/check/coverage.mjs BUILD PERCENT: reports which lines of lib/ were run, from what gcc
// --coverage left in the folder BUILD. Prints a row per folder, and one for the reader. The
// reader's row counts its own objects alone, so that lines that only the writer runs in shared
// files do not count. The exit status is 1 if less than PERCENT of the reader's lines were run.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

const [build, leastPercent] = process.argv.slice(2);
const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../..');
const lib = path.join(root, 'lib') + path.sep;

function* dataFiles(folder) {
  for (const entry of fs.readdirSync(folder, { withFileTypes: true })) {
    const file = path.join(folder, entry.name);
    if (entry.isDirectory()) yield* dataFiles(file);
    else if (entry.name.endsWith('.gcda')) yield file;
  }
}

/** Adds to `lines`, by file and line, whether one of an object's functions ran it. */
function addObject(data, lines) {
  const text = execFileSync('gcov', ['--json-format', '--stdout', data], {
    maxBuffer: 2 ** 30, cwd: build, stdio: ['ignore', 'pipe', 'ignore'],
  });
  const { files, current_working_directory: folder } = JSON.parse(text);
  for (const { file, lines: found } of files) {
    const name = path.resolve(folder, file);
    if (!name.startsWith(lib)) continue;
    const known = lines.get(name) ?? lines.set(name, new Map()).get(name);
    for (const { line_number: number, count } of found) known.set(number, (known.get(number) ?? false) || count > 0);
  }
}

const all = new Map();
const ofReader = new Map();
for (const data of dataFiles(path.resolve(build))) {
  addObject(data, all);
  if (data.includes('mcc_reader.dir')) addObject(data, ofReader);
}

const rows = new Map();
function addRow(name, lines) {
  const row = rows.get(name) ?? rows.set(name, { total: 0, run: 0 }).get(name);
  row.total += lines.size;
  row.run += [...lines.values()].filter(Boolean).length;
}
for (const [file, lines] of [...all].sort(([a], [b]) => (a < b ? -1 : 1))) {
  addRow(path.posix.join('lib', path.relative(lib, path.dirname(file))), lines);
}
for (const lines of all.values()) addRow('all', lines);
for (const lines of ofReader.values()) addRow('the reader', lines);

const percentOf = ({ total, run }) => (total === 0 ? 0 : (100 * run) / total);
console.log(`${'folder'.padEnd(24)}   lines     run       %`);
for (const [name, row] of rows) {
  const cells = [String(row.total).padStart(7), String(row.run).padStart(7), percentOf(row).toFixed(1).padStart(7)];
  console.log(`${name.padEnd(24)} ${cells.join(' ')}`);
}
if (process.env.MCC_UNCOVERED) {
  for (const [file, lines] of ofReader) {
    const missed = [...lines].filter(([, isRun]) => !isRun).map(([number]) => number).sort((a, b) => a - b);
    if (missed.length > 0) console.log(`${path.relative(root, file)}: ${missed.join(' ')}`);
  }
}
const reached = percentOf(rows.get('the reader') ?? { total: 0, run: 0 });
if (reached < Number(leastPercent)) {
  console.error(`coverage: ${reached.toFixed(1)} % of the reader's lines were run, ${leastPercent} % should be`);
  process.exit(1);
}
