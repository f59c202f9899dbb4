// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What validators say about a tileset and about the compressed one.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import validator from 'gltf-validator';
import { modelsOf } from './contents.mjs';
import { contentsOf } from './tileset.mjs';

const SEVERITIES = ['error', 'warning', 'info', 'hint'];

/** { ["severity CODE: example"]: count } of Khronos' glTF validator over the models in all contents. */
export async function glTFIssues(tileset) {
  const issues = new Map();
  for (const name of contentsOf(tileset).keys()) {
    const file = path.join(path.dirname(tileset), name);
    for (const { glb } of await modelsOf(readFileSync(file))) {
      const report = await validator.validateBytes(new Uint8Array(glb), {
        maxIssues: 0,
        externalResourceFunction: async (uri) => new Uint8Array(readFileSync(path.join(path.dirname(file), decodeURIComponent(uri)))),
      });
      for (const { severity, code, message } of report.issues.messages) {
        // Messages have numbers and names of the file in them, except those about extensions.
        const key = `${SEVERITIES[severity]} ${code}${code === 'UNSUPPORTED_EXTENSION' ? `: ${message}` : ''}`;
        issues.set(key, (issues.get(key) ?? 0) + 1);
      }
    }
  }
  return Object.fromEntries([...issues].sort());
}

/** The same of the 3D Tiles validator, which is a command with the options of the npm package 3d-tiles-validator. */
export function tilesIssues(command, tileset, report) {
  const [program, ...args] = command.split(' ');
  execFileSync(program, [...args, '--tilesetFile', tileset, '--reportFile', report], { stdio: ['ignore', 'ignore', 'inherit'] });
  const issues = new Map();
  const waiting = [...JSON.parse(readFileSync(report)).issues ?? []];
  while (waiting.length !== 0) {
    const { type, severity, message, causes = [] } = waiting.pop();
    const key = `${severity} ${type}${/extension/i.test(message) ? `: ${message}` : ''}`;
    issues.set(key, (issues.get(key) ?? 0) + 1);
    waiting.push(...causes);
  }
  return Object.fromEntries([...issues].sort());
}

/** What there is more of in the result: { [issue]: [in the source, in the result] }. */
export function newIssues(source, result) {
  return Object.fromEntries(Object.entries(result).filter(([key, count]) => count > (source[key] ?? 0)).map(([key, count]) => [key, [source[key] ?? 0, count]]));
}
