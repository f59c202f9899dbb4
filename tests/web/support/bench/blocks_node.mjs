// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes one payload in a process of Node that begins with this file: blocks_node.mjs FILE mcc WORKERS, or
// blocks_node.mjs FILE "draco 5".
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { createDecoderPool } from '../../../../lib/web/decoder.mjs';
import { loadDecoder } from './decoders.mjs';

const self = fileURLToPath(import.meta.url);
const MIB = 1 << 20;

/**
 * @param {string} file holds a payload, or what Draco made
 * @param {'mcc'|'draco 5'} codec
 * @param {number} workers of our pool
 * @returns {{ first?: number, all: number, warm: number, memory: number }} milliseconds until the first block and all were there,
 *   with workers started and code compiled; milliseconds of another decode; MiB that the process took on top at its peak
 */
export const measureInNode = (file, codec, workers) => (
  JSON.parse(execFileSync(process.execPath, [self, file, codec, String(workers)], { encoding: 'utf8' })));

const peak = () => Number(/VmHWM:\s*(\d+)/.exec(readFileSync('/proc/self/status', 'utf8'))[1]) * 1024;

async function timed(work) {
  const begin = performance.now();
  await work(() => performance.now() - begin);
  return performance.now() - begin;
}

async function measure(file, codec, workers) {
  const bytes = new Uint8Array(readFileSync(file));
  const before = peak();
  let decode;
  let pool;
  if (codec === 'mcc') {
    pool = createDecoderPool({ workers });
    decode = (onBlock) => pool.decodePayload(bytes.slice(), { onBlock });
  } else {
    const decodeUnits = await loadDecoder(codec);
    decode = () => decodeUnits([{ bytes }]);
  }
  let first;
  const all = await timed((elapsed) => decode(() => { first ??= elapsed(); }));
  const memory = (peak() - before) / MIB;
  const warm = await timed(() => decode());
  pool?.dispose();
  return { first, all, warm, memory };
}

if (process.argv[1] === self) {
  const [file, codec, workers] = process.argv.slice(2);
  console.log(JSON.stringify(await measure(file, codec, Number(workers))));
}
