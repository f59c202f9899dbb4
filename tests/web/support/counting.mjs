// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Counts work instead of measuring time: how often the functions and the blocks of code in lib/web run.
import assert from 'node:assert/strict';
import { Session } from 'node:inspector/promises';
import { setFlagsFromString } from 'node:v8';

setFlagsFromString('--no-opt'); // optimised code does not count the calls of functions
const session = new Session();
session.connect();
await session.post('Profiler.enable');
await session.post('Profiler.startPreciseCoverage', { callCount: true, detailed: true });

/** The runs of all functions, branches and loop bodies of lib/web since the last call. */
async function take() {
  const { result } = await session.post('Profiler.takePreciseCoverage');
  const ranges = result.filter(({ url }) => url.includes('/lib/web/')).flatMap(({ functions }) => functions).flatMap((one) => one.ranges);
  return ranges.reduce((sum, { count }) => sum + count, 0);
}

/** The number of such runs while `work` goes on. */
export async function countOf(work) {
  await take();
  await work();
  return take();
}

/** The work on 4 n things is to that on 2 n as this is to n; quadratic work would be twice as much. */
export async function assertLinear(n, workOn) {
  await countOf(() => workOn(n)); // what is done once
  const counts = [];
  for (const factor of [1, 2, 4]) counts.push(await countOf(() => workOn(factor * n)));
  const [once, twice, fourTimes] = counts;
  assert.ok(once > 0, 'nothing was counted');
  assert.ok(fourTimes - twice <= 2.4 * (twice - once) + 100, `${counts} for ${n}, ${2 * n} and ${4 * n}`);
}
