// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Residuals of attributes: A.10.2 of the specification. Each has a value and a length in context.

import { ATTRIBUTES } from './entropy.mjs';

function below(streams, length) {
	const b = streams.raw(length);
	if (length === 0) return 0;
	const leading = 2 ** (length - 1);
	const negative = b >= leading;
	const m = negative ? b : b + leading; // 2^(length-1) | (b without bit length-1)
	return negative ? -m | 0 : m | 0;
}

// By length
export function readByLength(streams, state, row) {
	const t = streams.token(state, row, ATTRIBUTES);
	const length = t < 15 ? t : Math.min(15 + streams.raw(5), 32);
	return { residual: below(streams, length), length: Math.min(t, 10) };
}

const SMALL = [0, 1, -1, 2, -2, 3, -3];
const SMALL_LENGTH = [0, 1, 1, 2, 2, 2, 2];

// Small signed
export function readSmallSigned(streams, state, row) {
	const t = streams.token(state, row, ATTRIBUTES);
	if (t <= 6) return { residual: SMALL[t], length: SMALL_LENGTH[t] };
	if (t <= 14) return { residual: below(streams, t - 4), length: Math.min(t - 4, 10) };
	return { residual: below(streams, Math.min(11 + streams.raw(5), 32)), length: 10 };
}

// The context of the next residual of the same wedge.
export const following = (context, length) => Math.floor((context + length + 1) / 2);
