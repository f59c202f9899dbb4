// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Ordered floats: A.10.9 of the specification. Floats are kept as integers, so that the bits of a NaN survive.

import { bitsOfFloat, floatOfBits } from './bytes.mjs';

export function orderedOfBits(bits) {
	return bits >>> 31 === 0 ? bits | 0 : (~bits ^ 0x80000000) | 0;
}

export function bitsOfOrdered(i) {
	return i >= 0 ? i : ~(i ^ 0x80000000) >>> 0;
}

// The ordered integer of a float that is not a NaN.
export const ordered = (x) => orderedOfBits(bitsOfFloat(x));

const exponentField = (i) => (bitsOfOrdered(i) >>> 23) & 255;

const isFinite32 = (i) => exponentField(i) !== 255;

// The float; 0 for infinities and NaN.
export function finite(i) {
	return isFinite32(i) ? floatOfBits(bitsOfOrdered(i)) : 0;
}

export function ulp(i) {
	return 2 ** (Math.max(exponentField(i), 1) - 150);
}
