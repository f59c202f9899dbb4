// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { readFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { LIBRARY } from './paths.mjs';

/** The Content-Security-Policy that the README of lib/web gives: sources by directive. */
export function policyOfReadme() {
  const [, policy] = /^## Content security policy$.*?^```http\n(.*?)\n^```$/ms.exec(readFileSync(path.join(LIBRARY, 'README.md'), 'utf8'));
  return Object.fromEntries(policy.split('; ').map((directive) => [directive.split(' ', 1)[0], directive.slice(directive.indexOf(' ') + 1)]));
}

/**
 * The first block of a language below "### heading" in the README of lib/web: what users copy is what the tests run.
 * @param {string} heading
 * @param {string} [language]
 */
export async function snippetOf(heading, language = 'js') {
  const text = await readFile(path.join(LIBRARY, 'README.md'), 'utf8');
  const section = text.split(/^(?=##+ )/m).find((part) => part.startsWith(`### ${heading}\n`));
  const code = section?.match(new RegExp(`^\`\`\`${language}\\n(.*?)^\`\`\`$`, 'ms'))?.[1];
  if (code === undefined) throw new Error(`lib/web/README.md: no code below "### ${heading}"`);
  return code;
}
