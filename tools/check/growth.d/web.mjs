#!/usr/bin/env node
// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// tools/check/growth web [--library FOLDER] [PART OF A NAME...]: for documents and tiles with n, 2 n and 4 n of one thing, prints
// the processor time that unpackTile() of lib/web takes, and the largest memory of its process. Linear time doubles from column to column. Each
// document has a process of its own, and at most a minute.
import { execFileSync } from 'node:child_process';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { FAMILIES } from '../../../tests/web/support/families.mjs';

const SECONDS = 60;
const self = fileURLToPath(import.meta.url);

/** In a process of its own: prints { ms, megabytes, error } for one document. */
async function measure(library, name, n) {
  const { unpackTile } = await import(path.join(path.resolve(library), 'index.mjs'));
  const file = FAMILIES[name].make(n);
  const begin = process.cpuUsage();
  const error = await unpackTile(file).then(() => 'none', ({ code, name: kind }) => code ?? kind);
  await new Promise((resolve) => { process.once('beforeExit', resolve); }); // what goes on after an error counts, too
  const { user, system } = process.cpuUsage(begin);
  console.log(JSON.stringify({ ms: (user + system) / 1000, megabytes: process.resourceUsage().maxRSS / 1024, error }));
}

function measured(library, name, n) {
  try {
    return JSON.parse(execFileSync(process.execPath, [self, '--one', library, name, `${n}`], { encoding: 'utf8', timeout: 1000 * SECONDS }));
  } catch {
    return undefined;
  }
}

function main(args) {
  const library = args[0] === '--library' ? args.splice(0, 2)[1] : fileURLToPath(new URL('../../../lib/web', import.meta.url));
  for (const [name, { n }] of Object.entries(FAMILIES)) {
    if (args.length > 0 && !args.some((part) => name.includes(part))) continue;
    const columns = [n, 2 * n, 4 * n].map((count) => [count, measured(library, name, count)]);
    const textOf = ([count, result]) => (result === undefined ? `${count}: more than ${SECONDS} s, or no memory`
      : `${count}: ${Math.round(result.ms)} ms, ${Math.round(result.megabytes)} MB`);
    console.log(`${name} | ${columns.map(textOf).join(' | ')} | ${columns.findLast(([, result]) => result)?.[1].error}`);
  }
}

const [first, ...others] = process.argv.slice(2);
if (first === '--one') await measure(others[0], others[1], Number(others[2]));
else main(process.argv.slice(2));
