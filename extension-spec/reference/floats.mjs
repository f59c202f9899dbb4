// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Arithmetic of integers and floats [A.1.2], ordered floats [A.10.9].

const view = new DataView(new ArrayBuffer(8));

// Every operation in f32 is written f(...): Math.fround rounds the sum, product or quotient of two f32, or the root of
// one, to the same f32 that the operation in f32 yields.
export const f = Math.fround;

// [A.1.2]
export const clamp = (x, a, b) => (x < a ? a : b < x ? b : x);
// Unlike Math.min and Math.max, these give a if a comparison with a NaN is false.
export const min = (a, b) => (b < a ? b : a);
export const max = (a, b) => (a < b ? b : a);
export const copysign = (x, y) => (isNegative(x) === isNegative(y) ? x : -x);
const isNegative = (x) => x < 0 || Object.is(x, -0);

// [A.1.2] Of an f32, whose sum is rounded.
export const round32 = (x) => Math.trunc(f(x + copysign(0.5, x)));

// [A.6.4] The comparison with infinities is defined; the result is an i32.
export const move = (x) => Math.trunc(clamp(x, -(2 ** 29), 2 ** 29)) | 0;
export function bitsOfFloat(x) {
	view.setFloat32(0, x);
	return view.getUint32(0);
}

function floatOfBits(bits) {
	view.setUint32(0, bits);
	return view.getFloat32(0);
}

// [A.10.9] Of the bits of a float, not of the float, since a NaN may lose its bits in a Number.
export const orderedBits = (b) => (b < 2 ** 31 ? b : ~b ^ 0x80000000) | 0;
export const ordered = (x) => orderedBits(bitsOfFloat(x));
export const bitsOfOrdered = (i) => (i >= 0 ? i : ~(i ^ 0x80000000)) >>> 0;
export function finite(i) {
	const x = floatOfBits(bitsOfOrdered(i));
	return Number.isFinite(x) ? x : 0;
}
const exponentOf = (i) => (bitsOfOrdered(i) >>> 23) & 255;
export const ulp = (i) => 2 ** (Math.max(exponentOf(i), 1) - 150);

// The largest e with 2^e <= x, for a positive normal f64.
export function floorLog2(x) {
	view.setFloat64(0, x);
	return ((view.getUint16(0) >> 4) & 2047) - 1023;
}

// [A.1.2] Vectors in f32: each operation is rounded.
export const subtract32 = (a, b) => [f(a[0] - b[0]), f(a[1] - b[1]), f(a[2] - b[2])];
export const add32 = (a, b) => [f(a[0] + b[0]), f(a[1] + b[1]), f(a[2] + b[2])];
export const scale32 = (a, x) => [f(a[0] * x), f(a[1] * x), f(a[2] * x)];
export const dot32 = (a, b) => f(f(f(a[0] * b[0]) + f(a[1] * b[1])) + f(a[2] * b[2]));
const minor32 = (a, b, i, j) => f(f(a[i] * b[j]) - f(a[j] * b[i]));
export const cross32 = (a, b) => [minor32(a, b, 1, 2), minor32(a, b, 2, 0), minor32(a, b, 0, 1)];

// The same in f64.
export const subtract64 = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scale64 = (a, x) => [a[0] * x, a[1] * x, a[2] * x];
export const dot64 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross64 = (a, b) =>
	[a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// [A.10.9] The unit vector, and whether there is one.
export function makeUnit(v) {
	const q = dot64(v, v);
	if (q > 1e-290 && q < 1e290) return { vector: scale64(v, 1 / Math.sqrt(q)), there: true };
	return { vector: [0, 0, 0], there: false };
}

export function flatten(N, v) {
	const a = dot64(N, v);
	return v.map((x, s) => x - a * N[s]);
}
