// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Times a codec's decoder. This worker must be a new one. It gets { codec, payloads } and posts { name: 'error', message } or
// { name: 'done', first, best, triangles }. `first` is the milliseconds until all payloads are decoded for the first time, with everything
// that has to be loaded for that; `best` those of the shortest of several further runs; `triangles` what came out.

const LEAST_RUNS = 3, MOST_RUNS = 40, ENOUGH_MILLISECONDS = 800;

/** The first runs compile the code, and other programs interfere. */
async function bestTime(run) {
  let best = Infinity;
  const begin = performance.now();
  for (let i = 0; i < MOST_RUNS && (i < LEAST_RUNS || performance.now() - begin < ENOUGH_MILLISECONDS); ++i) {
    const start = performance.now();
    await run();
    best = Math.min(best, performance.now() - start);
  }
  return best;
}

async function run({ codec, payloads }) {
  const begin = performance.now();
  const { loadDecoder } = await import(`./decoders/${codec}.mjs`); // nothing of the decoder is loaded before
  const decode = await loadDecoder();
  const triangles = await decode(payloads);
  const first = performance.now() - begin;
  return { first, triangles, best: await bestTime(() => decode(payloads)) };
}

onmessage = async ({ data }) => {
  try {
    postMessage({ name: 'done', ...await run(data) });
  } catch (error) {
    postMessage({ name: 'error', message: error.message });
  }
};
