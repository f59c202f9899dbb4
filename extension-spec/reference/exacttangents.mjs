// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Tangents whose bits are kept [A.10.17]. All floats are f64.

import { arrayOf, binaryModel, bit, raw } from './entropy.mjs';
import { exactVectorModels, meanError, readVector } from './exactvectors.mjs';
import { finite, flatten, makeUnit, ordered, orderedBits } from './floats.mjs';
import { NONE, forEachFace } from './surface.mjs';
import { codeBundles } from './wedges.mjs';

const PERPENDICULAR = 1;
export const exactTangentModels = () => ({ ...exactVectorModels(), NEGATIVE: arrayOf(3), ODD: binaryModel() });

// [A.10.17] The sums T, four numbers of each wedge; chartOf(w) are chart coordinates, and is undefined without a chart.
function exactTangentSums({ piece, surface }, positions, chartOf) {
	const T = Array.from({ length: piece.wedge_count }, () => [0, 0, 0, 0]);
	if (chartOf === undefined) return T;
	forEachFace(surface, (corners) => {
		const tangent = tangentOf(corners.map((w) => positions[w]), corners.map(chartOf));
		if (tangent !== undefined) for (const w of corners) T[w] = add4(T[w], tangent);
	});
	return T;
}
const add4 = (a, b) => a.map((x, c) => x + b[c]);

// What a face adds, or undefined if its chart has no area.
function tangentOf([p0, p1, p2], [uv0, uv1, uv2]) {
	const v0 = uv1[1] - uv0[1], v1 = uv2[1] - uv0[1];
	const determinant = (uv1[0] - uv0[0]) * v1 - (uv2[0] - uv0[0]) * v0;
	if (!(Math.abs(determinant) > 1e-60)) return undefined;
	const side = determinant < 0 ? -1 : 1;
	const t = p0.map((x, s) => side * ((p1[s] - x) * v1 - (p2[s] - x) * v0));
	return [...makeUnit(t).vector, side];
}

// [A.10.17] normal(w) are the components of the exact normal, and is undefined without one.
export function decodeExactTangents(coding, models, attribute, positions, chartOf, normal) {
	const { coder } = coding;
	const T = exactTangentSums(coding.wedges, positions, chartOf);
	const errors = T.map(() => ({ size: 0, places: 0 }));
	let last = [0, 0, 0], error = { size: 0, places: 0 };
	codeBundles(coding, ({ w, members, entry, n, p }) => {
		const total = members.map((member) => T[member]).reduce(add4, [0, 0, 0, 0]);
		if (entry !== NONE) error = meanError(errors[n], errors[p]);
		const N = makeUnit(normal === undefined ? [0, 0, 0] : normal(w).map(finite)).vector;
		const sum = makeUnit(flatten(N, total.slice(0, 3)));
		const predicted = sum.there ? sum.vector : makeUnit(flatten(N, last)).vector;
		const plane = attribute.predictor & PERPENDICULAR ? N : undefined;
		const read = readVector(coder, models.ROW, predicted, error, plane);
		const fourth = readFourth(coder, models, total[3]);
		error = read.error;
		for (const member of members) errors[member] = error;
		last = makeUnit(read.value.map(finite)).vector;
		return { value: [...read.value, fourth], length: 0 };
	});
}

// The sign, as an ordered float.
function readFourth(coder, models, side) {
	if (bit(coder, models.ODD)) {
		const high = raw(coder, 16);
		return orderedBits(high * 65536 + raw(coder, 16));
	}
	return ordered(bit(coder, models.NEGATIVE[side > 0 ? 1 : side < 0 ? 2 : 0]) ? -1 : 1);
}
