// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
export { formatCount } from './glb.mjs';

/** Returns "12 %", with one decimal if it matters. */
export function formatPercent(fraction) {
  return `${(100 * fraction).toLocaleString('en-US', { maximumFractionDigits: fraction < 0.1 ? 1 : 0 })} %`;
}

/** Returns three significant digits: "0.0000367" is "3.67e-5". */
export function formatSmall(value) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  return size < 1e-3 || size >= 1e5 ? value.toExponential(2).replace('e+', 'e') : String(Number(value.toPrecision(3)));
}

export function formatMilliseconds(value) {
  if (value >= 1000) return `${(value / 1000).toFixed(2)} s`;
  return `${value.toFixed(value < 10 ? 2 : value < 100 ? 1 : 0)} ms`;
}
