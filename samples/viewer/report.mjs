// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the page has measured, as JSON. Names of numbers end with their units.
import { CODECS } from './comparison.mjs';
import { sum } from './figures.mjs';
import { VERSIONS } from './vendor/versions.mjs';

/** Figures that are missing are left out. */
export function reportOf({ file, result, options, remarks }) {
  const { report, glb, codecs, errors, isCompressed, sourceBytes } = result;
  return {
    generator: 'gltf-mcc viewer',
    date: new Date().toISOString(),
    userAgent: navigator.userAgent,
    hardwareThreads: navigator.hardwareConcurrency,
    file: { name: file.name, bytes: file.bytes.length, ...(isCompressed ? { decodedBytes: sourceBytes } : {}), resultBytes: glb.length },
    primitives: report.primitives.length,
    triangles: sum(report.payloads, 'triangles'),
    vertices: sum(report.payloads, 'vertices'),
    options,
    positionErrors: errors && { largest: errors.most, mean: errors.mean, longestSideOfBox: errors.side, missedVertices: errors.missed },
    comparedWithoutMorphTargets: codecs.ours.allBytes !== undefined,
    codecs: Object.fromEntries(Object.entries(CODECS).map(([codec, name]) => [codec, codecOf(name, VERSIONS[codec], codecs[codec])])),
    brotli: { version: VERSIONS.brotli, quality: 11 },
    remarks,
  };
}

const codecOf = (name, version, { bytes, allBytes, uncodedBytes, speed, brotliBytes, first, best, streams, errors }) => ({
  name,
  version,
  speed,
  bytes,
  withMorphTargetsBytes: allBytes,
  uncodedMorphTargetBytes: uncodedBytes,
  brotliBytes,
  loadAndFirstDecodeMilliseconds: toMicroseconds(first),
  bestDecodeMilliseconds: toMicroseconds(best),
  streamBytes: streams && Object.fromEntries(streams),
  errors,
});

/** Further decimals say nothing. */
const toMicroseconds = (milliseconds) => milliseconds && Number(milliseconds.toFixed(3));
