// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Times of decoders, in Node and in pages, in milliseconds by the clock on the wall.
import { loadDecoder } from './decoders.mjs';

async function timeOf(work) {
  const begin = performance.now();
  const result = await work();
  return [performance.now() - begin, result];
}

/**
 * Loads the decoder and decodes twice. Only the first call in a process or page says anything.
 * @param read (codec) => promise of its units
 * @returns {{ first, second }} `first` contains the loading
 */
export async function measureCold(codec, read) {
  const units = await read(codec);
  const [load, decode] = await timeOf(() => loadDecoder(codec));
  const [first] = await timeOf(() => decode(units));
  const [second] = await timeOf(() => decode(units));
  return { first: load + first, second };
}

/**
 * The least time of each codec's runs, which take turns. Before them come runs to warm up, and a
 * pause in which the engine finishes what it compiles.
 * @param read (codec) => promise of its units
 * @returns {{ [codec]: milliseconds, triangles }}
 */
export async function measureWarm(codecs, read, { warmups, pause, runs }) {
  const decoders = [];
  for (const codec of codecs) decoders.push({ codec, units: await read(codec), decode: await loadDecoder(codec) });
  const best = {};
  for (let i = 0; i < warmups + runs; ++i) {
    if (i === warmups) await new Promise((resolve) => setTimeout(resolve, pause));
    for (const { codec, units, decode } of decoders) {
      const [time] = await timeOf(() => decode(units));
      if (i >= warmups) best[codec] = Math.min(best[codec] ?? Infinity, time);
    }
  }
  return best;
}
