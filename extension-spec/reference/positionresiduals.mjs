// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Scale, row and residual of a coordinate [A.6.6].

import { FOLD } from './attributeheader.mjs';
import { POSITIONS, raw, token } from './entropy.mjs';
import { bitsOfFloat, f } from './floats.mjs';
import { BASE, EXTRA } from './positionrows.mjs';

// [A.6.6] The scale and the set of rows of a slot; `c` are its coefficients.
export function contextOfSlot(c, magnitudes, spread, third, split) {
	const N = f(f(c[0] / 64) * magnitudes);
	const S = f(f(f(c[1] / 64) * spread) + f(f((c[3] ?? 0) / 64) * third));
	const scale = f(f(N + S) + f(c[2] / 64));
	if (!split) return { scale, set: 0 };
	return { scale, set: (S > f(2 * N) ? 1 : 0) + (N > f(2 * S) ? 2 : 0) };
}
export const bucketOf = (scale) => Math.min(39, (bitsOfFloat(f(scale + 1)) >>> 22) - 254);

// What a fraction, with a half added, leaves after rounding down: -128 .. 127.
export const offOf = (rounded) => (rounded & 255) - 128;
export const fractionClass = (off) => Math.min(Math.abs(off) >> 5, 3);

// [A.6.6] The residual of a coordinate; `off` is found from its fraction.
export function readResidual(p, slot, set, scale, off, fold) {
	const bucket = bucketOf(scale);
	if (fold && bucket < 10) {
		const row = p.models.FOLDED[slot][set][fractionClass(off)][bucket];
		return readFolded(p.coder, slot, row, off < 0);
	}
	return readUnfolded(p.coder, slot, p.models.ROW[slot][set][bucket], bucket);
}

// The residual of a slot, in the context found from the fraction without a shift.
export const residualOfSlot = (p, k, { set, scale }, fraction) =>
	readResidual(p, k, set, scale, offOf(fraction + 128), (p.predictor & FOLD) !== 0);

export function readUnfolded(coder, s, row, bucket) {
	const low = bucket < 10 ? 0 : (bucket >> 1) - 5, t = token(coder, s, row, POSITIONS);
	const a = readNumber(coder, t, low), negative = t === 15 || a !== 0 ? raw(coder, 1) : 0;
	return (negative ? -a : a) | 0;
}

// A folded residual has low = 0.
export function readFolded(coder, s, row, flip) {
	const a = readNumber(coder, token(coder, s, row, POSITIONS), 0), negative = (a % 2 === 0) !== flip;
	const size = Math.floor(a / 2) + (a % 2);
	return (negative ? -size : size) | 0;
}

// A u32.
function readNumber(coder, t, low) {
	if (t < 15) return (BASE[t] << low) + raw(coder, EXTRA[t] + low);
	const k = raw(coder, 5), z = (2 ** k + raw(coder, k) + 127) >>> 0;
	return ((z << low) | raw(coder, low)) >>> 0;
}
