// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Vectors of three components and the arithmetic of A.1.2 of the specification: binary32, where each operation is rounded
// on its own, and binary64, which is that of Numbers.

export const f = Math.fround;

// ---- binary32

export const add32 = (a, b) => [f(a[0] + b[0]), f(a[1] + b[1]), f(a[2] + b[2])];
export const sub32 = (a, b) => [f(a[0] - b[0]), f(a[1] - b[1]), f(a[2] - b[2])];
export const scale32 = (a, s) => [f(a[0] * s), f(a[1] * s), f(a[2] * s)];
export const dot32 = (a, b) => f(f(f(a[0] * b[0]) + f(a[1] * b[1])) + f(a[2] * b[2]));
export const sqrt32 = (x) => f(Math.sqrt(x));
export const length1 = (v) => f(f(Math.abs(v[0]) + Math.abs(v[1])) + Math.abs(v[2])); // |v| of A.10.8

export function cross32(a, b) {
	return [
		f(f(a[1] * b[2]) - f(a[2] * b[1])),
		f(f(a[2] * b[0]) - f(a[0] * b[2])),
		f(f(a[0] * b[1]) - f(a[1] * b[0])),
	];
}

// trunc(x + copysign(0.5, x)), whose sum is rounded
export const round32 = (x) => Math.trunc(f(x + (isNegative(x) ? -0.5 : 0.5)));

const isNegative = (x) => x < 0 || Object.is(x, -0);
export const copysign = (x, y) => (isNegative(x) === isNegative(y) ? x : -x);

// ---- binary64

export const add64 = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub64 = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale64 = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot64 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross64 = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// ---- both

// [A.1.2] `min(a, b)`, `max(a, b)` and `clamp`: what comparisons with a NaN yield follows from their form.
export const min = (a, b) => (b < a ? b : a);
export const max = (a, b) => (a < b ? b : a);
export const clamp = (x, low, high) => (x < low ? low : high < x ? high : x);
