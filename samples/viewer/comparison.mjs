// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Measures our codec and others: one step after the other, so that nothing else of the page runs while something is timed.
import { readGlb } from './glb.mjs';
import { runJob } from './jobs.mjs';
import { bytesOfTargets, hasTargets, withoutTargets } from './targets.mjs';

/** In the order in which they are shown. */
export const CODECS = { ours: 'Mesh collapse', draco: 'Draco', meshopt: 'meshopt' };

const bytesOf = (payloads) => payloads.reduce((sum, { bytes }) => sum + bytes.length, 0);

/**
 * A step that fails is told in the `errors` of its codec, and the other steps go on. What not all codecs can code is left out of the
 * comparison: of a file with morph targets, all figures but `allBytes` and `streams` are of what the file is without them.
 * @param {{ source: Uint8Array, payloads: { bytes: Uint8Array }[], options: object, bits: object, lossless: boolean }} request
 * payloads: ours; options: those of encodeGlb()
 * @param {{ signal: AbortSignal, onStep(text: string, done?: number): void, onFigures(codecs: object): void }} listeners figures
 * come after each step, by codec: { bytes, streams, first, best, triangles, brotliBytes, errors } as far as they are known, and for
 * files with morph targets { allBytes } or { uncodedBytes }, which the codec leaves as they are; Draco's also { speed }
 */
export async function compareCodecs({ source, payloads, options, bits, lossless }, { signal, onStep, onFigures }) {
  const { json } = readGlb(source);
  const bare = hasTargets(json) ? withoutTargets(source) : undefined;
  const figures = Object.fromEntries(Object.keys(CODECS).map((codec) => [codec, { errors: [] }]));
  const coded = {};
  const step = async (codec, text, run) => {
    onStep(text);
    try {
      Object.assign(figures[codec], await run((done) => onStep(text, done)));
    } catch (error) {
      signal.throwIfAborted();
      figures[codec].errors.push(error.message);
    }
    onFigures(figures);
  };

  const keep = (codec, own) => {
    coded[codec] = own;
    return { bytes: bytesOf(own) };
  };
  const compress = async (codec, bytes, onProgress) => (
    runJob(`./workers/${codec}.mjs`, { bytes, bits, lossless }, { signal, onProgress: ({ done }) => onProgress(done) }));

  if (bare === undefined) {
    Object.assign(figures.ours, keep('ours', payloads));
  } else {
    figures.ours.allBytes = bytesOf(payloads);
    await step('ours', 'Compressing without morph targets for comparison', async () => (
      keep('ours', (await runJob('./workers/encoder.mjs', { bytes: bare, options }, { signal })).payloads)));
  }
  await step('draco', `Compressing with ${CODECS.draco} for comparison`, async (onProgress) => {
    const { payloads: own, streams, speed } = await compress('draco', bare ?? source, onProgress);
    return { ...keep('draco', own), streams, speed, ...(bare === undefined ? {} : { uncodedBytes: bytesOfTargets(json) }) };
  });
  await step('meshopt', `Compressing with ${CODECS.meshopt} for comparison`, async (onProgress) => {
    const { payloads: all, streams } = await compress('meshopt', source, onProgress);
    if (bare === undefined) return { ...keep('meshopt', all), streams };
    return { ...keep('meshopt', (await compress('meshopt', bare, onProgress)).payloads), streams, allBytes: bytesOf(all) };
  });
  for (const [codec, own] of Object.entries(coded)) {
    if (own.length === 0) continue;
    await step(codec, `Timing the decoder of ${CODECS[codec]}`, async () => {
      const { first, best, triangles } = await runJob('./workers/timing.mjs', { codec, payloads: own }, { signal, isFresh: true });
      return { first, best, triangles };
    });
  }
  for (const [codec, own] of Object.entries(coded)) {
    await step(codec, `Compressing ${CODECS[codec]} with brotli`, async () => {
      const { byteLength } = await runJob('./workers/brotli.mjs', { parts: own.map(({ bytes }) => bytes) }, { signal });
      return { brotliBytes: byteLength };
    });
  }
}
