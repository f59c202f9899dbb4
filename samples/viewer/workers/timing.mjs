// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Times a codec's decoder. This worker must be a new one. It gets { codec, payloads } and posts { name: 'error', message } or
// { name: 'done', first, best, triangles }. `first` is the milliseconds until all payloads are decoded for the first time, with everything
// that has to be loaded for that; `best` those of the shortest of several further runs; `triangles` what came out.

const LEAST_RUNS = 3, MOST_RUNS = 40, ENOUGH_MILLISECONDS = 500;
/** A page's clock may have steps of 0.1 ms, so a run decodes again and again until it has taken this long. */
const LEAST_MILLISECONDS = 5;
const PAUSE_MILLISECONDS = 150;

async function bestTime(decode) {
  let [best, times] = [Infinity, 1];
  const begin = performance.now();
  for (let i = 0; i < MOST_RUNS && (i < LEAST_RUNS || performance.now() - begin < ENOUGH_MILLISECONDS);) {
    const start = performance.now();
    for (let t = 0; t < times; ++t) await decode();
    const took = performance.now() - start;
    if (took < LEAST_MILLISECONDS) {
      times *= 2;
      continue;
    }
    best = Math.min(best, took / times);
    ++i;
  }
  return best;
}

/** In the pause, the engine finishes what it began to compile in the first runs. Other programs interfere, so these count, too. */
async function bestOfTwo(decode) {
  const early = await bestTime(decode);
  await new Promise((resolve) => setTimeout(resolve, PAUSE_MILLISECONDS));
  return Math.min(early, await bestTime(decode));
}

async function run({ codec, payloads }) {
  const begin = performance.now();
  const { loadDecoder } = await import(`./decoders/${codec}.mjs`); // nothing of the decoder is loaded before
  const decode = await loadDecoder();
  const triangles = await decode(payloads);
  const first = performance.now() - begin;
  return { first, triangles, best: await bestOfTwo(() => decode(payloads)) };
}

onmessage = async ({ data }) => {
  try {
    postMessage({ name: 'done', ...await run(data) });
  } catch (error) {
    postMessage({ name: 'error', message: error.message });
  }
};
