// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

const LEAST_RUNS = 3, MOST_RUNS = 40, ENOUGH_MILLISECONDS = 800;

/**
 * Returns the shortest of several runs: the first runs compile the code, and other programs
 * interfere.
 */
export function bestTime(run) {
  let best = Infinity;
  const begin = performance.now();
  for (let i = 0; i < MOST_RUNS && (i < LEAST_RUNS || performance.now() - begin < ENOUGH_MILLISECONDS); ++i) {
    const start = performance.now();
    run();
    best = Math.min(best, performance.now() - start);
  }
  return best;
}
