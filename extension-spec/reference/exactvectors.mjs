// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Vectors of binary64 and exact vectors: A.10.9 and A.10.15 of the specification.

import { models } from './entropy.mjs';
import { finite, ordered, ulp } from './floats.mjs';
import { readScaledResidual, scaledRows } from './residuals.mjs';
import { cross64, dot64, f } from './vectors.mjs';

const xyz = [0, 1, 2];

// ROW, by what the vectors are: normals or tangents
export const vectorRows = () => models([3], scaledRows);

// ---- [A.10.9] Vectors: makeUnit changes v and says whether it could; flatten returns the part of v beside N.

export function makeUnit(v) {
	const q = dot64(v, v);
	const possible = q > 1e-290 && q < 1e290;
	const i = possible ? 1 / Math.sqrt(q) : 0;
	for (const s of xyz) v[s] = possible ? v[s] * i : 0;
	return possible;
}

export function flatten(N, v) {
	const a = dot64(N, v);
	return xyz.map((s) => v[s] - a * N[s]);
}

export const vectorOf = (value) => xyz.map((s) => finite(value[s]));
export const bounded = (x) => (Math.abs(x) < 4 ? x : 0);

export const meanError = (a, b) => ({ size: f(f(a.size + b.size) / 2), places: f(f(a.places + b.places) / 2) });

// The value of a component and what its residual amounts to: [A.10.15]
export function readComponent(streams, state, rowsByBucket, predicted, expected) {
	const from = ordered(f(predicted));
	const size = ulp(from);
	const scale = 16 * expected / size;
	const residual = readScaledResidual(streams, state, rowsByBucket, f(scale < 2e9 ? scale : 2e9));
	return { value: (from + residual) | 0, missed: Math.abs(residual * size) };
}

// ---- The expected error: { size, places }, binary32

export const noError = () => ({ size: 0, places: 0 });

// ---- [A.10.15] Exact vectors

export class VectorReader {
	constructor(streams, ROW) {
		this.streams = streams;
		this.ROW = ROW;
	}

	// The three components; error is that expected and becomes that of this vector.
	read(predicted, error, N) {
		const value = new Int32Array(3);
		if (N !== undefined) this.inPlane(value, predicted, error, N);
		else this.components(value, predicted, error);
		return value;
	}

	// Reads value[s] and returns m.
	component(value, s, slot, predicted, expected) {
		const { value: x, missed } = readComponent(this.streams, slot, this.ROW[slot], predicted, expected);
		value[s] = x;
		return missed < 2 ? missed : 2;
	}

	// A component that follows from others; returns m in places.
	follower(value, s, slot, predicted, error) {
		const size = ulp(ordered(f(predicted)));
		return f(this.component(value, s, slot, predicted, error.places * size) / size);
	}

	components(value, predicted, error) {
		const L = largestAxis(predicted);
		const a = L === 0 ? 1 : 0;
		const b = L === 2 ? 1 : 2;
		const x = error.size;
		const ma = this.component(value, a, 0, predicted[a], x);
		const mb = this.component(value, b, 1, predicted[b], (x + ma) / 2);
		error.size = f((ma + mb) / 2);
		const [va, vb] = [finite(value[a]), finite(value[b])];
		const root = rootOf(1 - va * va - vb * vb);
		const m = this.follower(value, L, 2, bounded(predicted[L] < 0 ? -root : root), error);
		error.places = f(f(error.places + m) / 2);
	}

	inPlane(value, predicted, error, N) {
		const B = cross64(N, predicted);
		const F = largestAxis(B);
		error.size = f(this.component(value, F, 0, predicted[F], error.size));
		const [g, h] = solveInPlane(finite(value[F]), predicted[F], B[F]);
		let missed = 0;
		for (const j of [1, 2]) {
			const s = (F + j) % 3;
			missed = f(missed + this.follower(value, s, j, bounded(g * predicted[s] + h * B[s]), error));
		}
		error.places = f(f(error.places + f(missed / 2)) / 2);
	}
}

function solveInPlane(x, p, b) {
	const reach = p * p + b * b;
	const root = rootOf(reach - x * x);
	const i = reach > 1e-30 ? 1 / reach : 0;
	const g = (x * p + Math.abs(b) * root) * i;
	const h = (x * b - (b < 0 ? -p : p) * root) * i;
	return [g, h];
}

const rootOf = (rest) => (rest > 0 ? Math.sqrt(rest) : 0);

function largestAxis(v) {
	let L = 0;
	for (const s of [1, 2]) {
		if (Math.abs(v[s]) > Math.abs(v[L])) L = s;
	}
	return L;
}
