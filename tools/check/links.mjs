#!/usr/bin/env node
// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// tools/check/links.mjs: checks every link of the tree's Markdown files that leads into the tree: the file is there, and so is the
// heading or the anchor. Prints one line per link that leads nowhere; the exit status is 0 if there is none.
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, statSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../..', import.meta.url));
const files = execFileSync('git', ['ls-files', '*.md'], { cwd: root, encoding: 'utf8' }).trim().split('\n');
const withoutCode = (text) => text.replace(/^```.*?^```$/gms, '').replace(/`[^`\n]*`/g, '');
/** As GitHub makes them of headings. */
const slug = (heading) => heading.toLowerCase().replace(/<[^>]*>/g, '').replace(/\[([^\]]*)\]\([^)]*\)/g, '$1').replace(/[^\p{L}\p{N} _-]/gu, '').trim().replace(/ /g, '-');

function anchorsOf(file) {
  const text = readFileSync(path.join(root, file), 'utf8');
  const headings = [...text.matchAll(/^#+ (.*)$/gm)].map(([, heading]) => slug(heading));
  return new Set([...headings, ...[...text.matchAll(/<a id="([^"]*)"/g)].map(([, id]) => id)]);
}

let count = 0;
let wrong = 0;
for (const file of files) {
  const text = withoutCode(readFileSync(path.join(root, file), 'utf8'));
  for (const [, link] of text.matchAll(/\]\(([^)\s]+)\)/g)) {
    if (/^[a-z]+:/.test(link)) continue;
    ++count;
    const [name, anchor] = link.split('#');
    const target = name === '' ? file : path.join(path.dirname(file), decodeURIComponent(name));
    const full = path.join(root, target);
    const isThere = existsSync(full) && (anchor === undefined || (statSync(full).isFile() && anchorsOf(target).has(anchor)));
    if (isThere) continue;
    ++wrong;
    console.log(`${file}: ${link} leads nowhere`);
  }
}
console.log(`${count} links in ${files.length} files, ${wrong} lead nowhere`);
process.exit(wrong === 0 ? 0 : 1);
