// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Residuals of attributes and their contexts [A.10.2].

import { ATTRIBUTES, arrayOf, raw, rowModel, token } from './entropy.mjs';

export const NO_NEIGHBOURS = 11;

// Rows by context.
export const contextRows = () => arrayOf(12, () => rowModel());
export const contextOf = ({ L }, n, p) => Math.min((L[n] + L[p] + 1) >> 1, 10);
export const contextAfter = (context, l) => (context === NO_NEIGHBOURS ? NO_NEIGHBOURS : (context + l + 1) >> 1);

// The result is an i32; with length 32 it wraps.
function below(coder, length) {
	const b = raw(coder, length);
	if (length === 0) return 0;
	const top = 2 ** (length - 1);
	return (b >= top ? -b : top + b) | 0;
}

// [A.10.2] A residual and its length in context.
export function byLength(coder, s, row) {
	const t = token(coder, s, row, ATTRIBUTES);
	const residual = below(coder, t < 15 ? t : Math.min(15 + raw(coder, 5), 32));
	return { residual, length: Math.min(t, 10) };
}

const SMALL = [0, 1, -1, 2, -2, 3, -3];
const SMALL_LENGTHS = [0, 1, 1, 2, 2, 2, 2];
export function smallSigned(coder, s, row) {
	const t = token(coder, s, row, ATTRIBUTES);
	if (t <= 6) return { residual: SMALL[t], length: SMALL_LENGTHS[t] };
	if (t <= 14) return { residual: below(coder, t - 4), length: Math.min(t - 4, 10) };
	return { residual: below(coder, Math.min(11 + raw(coder, 5), 32)), length: 10 };
}
