// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Vectors of length 1 whose bits are kept [A.10.15]. All floats are f64 unless they are rounded by f.

import { arrayOf } from './entropy.mjs';
import { cross64, f, finite, ordered, ulp } from './floats.mjs';
import { bucketOf, readUnfolded } from './positionresiduals.mjs';
import { PLAIN_ROWS, trainedRow } from './positionrows.mjs';

export const exactVectorModels = () => ({ ROW: arrayOf(3, () => PLAIN_ROWS.map(trainedRow)) });

// [A.10.15] Three ordered floats, and the error of this vector. Without N two components are coded by themselves.
export function readVector(coder, ROW, predicted, error, N) {
	const v = { coder, ROW, value: [0, 0, 0] };
	const changed = N === undefined ? readComponents(v, predicted, error) : readInPlane(v, predicted, error, N);
	return { value: v.value, error: changed };
}

// Sets a component of the value, and returns how far the prediction has missed it.
function component(v, slot, s, predicted, expected) {
	const from = ordered(f(predicted)), place = ulp(from), scale = (16 * expected) / place;
	const bucket = bucketOf(f(scale < 2e9 ? scale : 2e9));
	const residual = readUnfolded(v.coder, slot, v.ROW[slot][bucket], bucket);
	v.value[s] = (from + residual) | 0;
	const m = Math.abs(residual * place);
	return m < 2 ? m : 2;
}

const largestOf = (v) => {
	let l = 0;
	for (const s of [1, 2]) if (Math.abs(v[s]) > Math.abs(v[l])) l = s;
	return l;
};
const rootOf = (rest) => (rest > 0 ? Math.sqrt(rest) : 0);
const limited = (x) => (Math.abs(x) < 4 ? x : 0);
const placeOf = (x) => ulp(ordered(f(x)));
function readComponents(v, predicted, error) {
	const l = largestOf(predicted), a = l === 0 ? 1 : 0, b = l === 2 ? 1 : 2;
	const ma = component(v, 0, a, predicted[a], error.size);
	const mb = component(v, 1, b, predicted[b], (error.size + ma) / 2);
	const xa = finite(v.value[a]), xb = finite(v.value[b]), root = rootOf(1 - xa * xa - xb * xb);
	const last = limited(predicted[l] < 0 ? -root : root), place = placeOf(last);
	const m = component(v, 2, l, last, error.places * place);
	return { size: f((ma + mb) / 2), places: f(f(error.places + f(m / place)) / 2) };
}

function readInPlane(v, predicted, error, N) {
	const B = cross64(N, predicted), F = largestOf(B);
	const size = f(component(v, 0, F, predicted[F], error.size));
	const x = finite(v.value[F]), p = predicted[F], b = B[F];
	const reach = p * p + b * b, root = rootOf(reach - x * x), i = reach > 1e-30 ? 1 / reach : 0;
	const g = (x * p + Math.abs(b) * root) * i, h = (x * b - (b < 0 ? -p : p) * root) * i;
	let missed = 0;
	for (const j of [1, 2]) {
		const s = (F + j) % 3, last = limited(g * predicted[s] + h * B[s]), place = placeOf(last);
		missed = f(missed + f(component(v, j, s, last, error.places * place) / place));
	}
	return { size, places: f(f(error.places + f(missed / 2)) / 2) };
}
export const meanError = (a, b) => ({ size: f(f(a.size + b.size) / 2), places: f(f(a.places + b.places) / 2) });
