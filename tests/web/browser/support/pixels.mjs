// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { PNG } from 'pngjs';

/** @param {string} url data: URL of a PNG */
export function readPicture(url) {
  return PNG.sync.read(Buffer.from(url.slice(url.indexOf(',') + 1), 'base64'));
}

/** A small PNG, without alpha. */
export function writePicture({ width, height, data }) {
  return PNG.sync.write(Object.assign(new PNG({ width, height }), { data }), { colorType: 2, deflateLevel: 9 });
}

/** Fraction of the pixels that differ by more than `tolerance` of 255 in a channel. */
export function differenceOf(a, b, tolerance = 8) {
  if (a.width !== b.width || a.height !== b.height) return 1;
  return fractionOfPixels(a, (i) => Math.abs(a.data[i] - b.data[i]) > tolerance);
}

/** Fraction of the pixels that differ from that of the upper left corner. */
export function coverageOf(a, tolerance = 8) {
  return fractionOfPixels(a, (i) => Math.abs(a.data[i] - a.data[i % 4]) > tolerance);
}

function fractionOfPixels({ width, height }, differs) {
  let count = 0;
  for (let pixel = 0; pixel < width * height; ++pixel) {
    if ([0, 1, 2, 3].some((channel) => differs(4 * pixel + channel))) ++count;
  }
  return count / (width * height);
}
