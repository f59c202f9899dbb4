// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Measures our codec and others: one step after the other, so that nothing else of the page runs while something is timed.
import { runJob } from './jobs.mjs';

/** In the order in which they are shown. */
export const CODECS = { ours: 'Mesh collapse', draco: 'Draco', meshopt: 'meshopt' };

const sizeOf = (parts) => parts.reduce((sum, { length }) => sum + length, 0);

/**
 * A step that fails is told in the `errors` of its codec, and the other steps go on.
 * @param {{ source: Uint8Array, payloads: { bytes: Uint8Array }[], bits: object, lossless: boolean }} request payloads: ours
 * @param {{ signal: AbortSignal, onStep(text: string, done?: number): void, onFigures(codecs: object): void }} listeners figures
 * come after each step, by codec: { bytes, streams, first, best, triangles, brotliBytes, errors } as far as they are known
 */
export async function compareCodecs({ source, payloads, bits, lossless }, { signal, onStep, onFigures }) {
  const figures = Object.fromEntries(Object.keys(CODECS).map((codec) => [codec, { errors: [] }]));
  const coded = { ours: { payloads, parts: payloads.map(({ bytes }) => bytes) } };
  figures.ours.bytes = sizeOf(coded.ours.parts);
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

  for (const codec of ['draco', 'meshopt']) {
    await step(codec, `Compressing with ${CODECS[codec]} for comparison`, async (onProgress) => {
      const how = { signal, onProgress: ({ done }) => onProgress(done) };
      const { payloads: theirs, streams, uncoded = [] } = await runJob(`./workers/${codec}.mjs`, { bytes: source, bits, lossless }, how);
      coded[codec] = { payloads: theirs, parts: [...theirs.map(({ bytes }) => bytes), ...uncoded] };
      return { bytes: sizeOf(coded[codec].parts), streams };
    });
  }
  for (const [codec, { payloads: own }] of Object.entries(coded)) {
    if (own.length === 0) continue;
    await step(codec, `Timing the decoder of ${CODECS[codec]}`, async () => {
      const { first, best, triangles } = await runJob('./workers/timing.mjs', { codec, payloads: own }, { signal, isFresh: true });
      return { first, best, triangles };
    });
  }
  for (const [codec, { parts }] of Object.entries(coded)) {
    await step(codec, `Compressing ${CODECS[codec]} with brotli`, async () => {
      const { byteLength } = await runJob('./workers/brotli.mjs', { parts }, { signal });
      return { brotliBytes: byteLength };
    });
  }
}
