// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The program gltf-mcc, for models to test with.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { ROOT, SAMPLES } from './paths.mjs';

export const programOf = (tree) => path.join(tree, 'build/release/tools/gltf-mcc');
export const PROGRAM = process.env.MCC_PROGRAM ?? programOf(ROOT);

export const readSample = (name) => new Uint8Array(readFileSync(path.join(SAMPLES, `${name}.glb`)));

/** @param {string} [program] another than PROGRAM */
export const convert = (glb, options = [], program = PROGRAM) => inMemory(['convert', '--compare', 'none', ...options], glb, program);
export const decode = (glb) => inMemory(['decode'], glb);

/** A sample with its fallback, whose buffer is a file of its own: { glb, fallback, fallbackName }. */
export function convertWithFallback(name) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'gltf-mcc-'));
  try {
    run(['convert', '--compare', 'none', '--fallback', path.join(SAMPLES, `${name}.glb`), path.join(folder, 'model.glb')]);
    const read = (file) => new Uint8Array(readFileSync(path.join(folder, file)));
    const fallbackName = readdirSync(folder).find((file) => file.endsWith('.fallback.bin'));
    return { glb: read('model.glb'), fallback: read(fallbackName), fallbackName };
  } finally {
    rmSync(folder, { recursive: true });
  }
}

// In memory of its own, as loaders like it.
const inMemory = (args, glb, program) => new Uint8Array(run([...args, '-', '-'], glb, program));

function run([command, ...args], input, program = PROGRAM) {
  if (!existsSync(program)) {
    throw new Error(`${program} is missing: tools/build release gltf-mcc, or name the program in MCC_PROGRAM`);
  }
  return execFileSync(program, [command, '--quiet', ...args], { input, maxBuffer: 1 << 28 });
}
