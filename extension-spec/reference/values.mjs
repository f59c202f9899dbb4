// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The method "values" [A.10.4].

import { arrayOf, bit } from './entropy.mjs';
import { NO_NEIGHBOURS, byLength, contextAfter, contextOf, contextRows } from './residuals.mjs';
import { squaredDistance } from './seenpositions.mjs';
import { NONE, next, prev } from './surface.mjs';
import { codeBundles, neighbourAlongRun } from './wedges.mjs';

const FLAGS = 1;
const LOOKED_AT = 8;
export const valuesModels = () => ({
	ROW: arrayOf(4, contextRows), ZERO: arrayOf(4), SAME: arrayOf(2, () => arrayOf(3)),
});
const isZero = (value) => value.every((x) => x === 0);
const isEqual = (a, b) => a.every((x, c) => x === b[c]);

// [A.10.4]
export function decodeValues(coding, models, attribute, positions) {
	codeBundles(coding, (bundle) => {
		const [n, p] = neighboursOf(coding, bundle);
		const known = attribute.predictor & FLAGS ? readFlags(coding, models, attribute.components, n, p) : undefined;
		if (known !== undefined) return { value: known, length: 0 };
		const predicted = predict(coding, bundle, n, p, positions, attribute.components);
		return readResiduals(coding, models.ROW, predicted, n, p);
	});
}

// Those that are missing are NONE; if only one is there, it is n.
function neighboursOf(coding, { w, entry, n, p }) {
	if (entry === NONE) return [neighbourAlongRun(coding, w), NONE];
	const known = [n, p].map((x) => (coding.coded[x] ? x : NONE));
	return known[0] === NONE ? known.reverse() : known;
}

// The value, if flags tell it.
function readFlags({ coder, values }, models, components, n, p) {
	const zero = Array(components).fill(0);
	if (n === NONE) return bit(coder, models.ZERO[3]) ? zero : undefined;
	const nZero = isZero(values[n]) ? 1 : 0, pZero = p === NONE ? nZero : isZero(values[p]) ? 1 : 0;
	if (bit(coder, models.ZERO[nZero + pZero])) return zero;
	let k = 2;
	if (p !== NONE) k = isEqual(values[n], values[p]) ? 1 : 0;
	if (!nZero && bit(coder, models.SAME[0][k])) return values[n];
	if (k === 0 && bit(coder, models.SAME[1][0])) return values[p];
	return undefined;
}

function predict(coding, bundle, n, p, positions, components) {
	const { values } = coding;
	const parallelogram = longestEdge(coding, bundle, positions);
	if (parallelogram !== undefined) {
		const [a, b, o] = parallelogram.map((w) => values[w]);
		return a.map((x, c) => (x + b[c] - o[c]) | 0);
	}
	if (n !== NONE) {
		const y = values[p === NONE ? n : p];
		return values[n].map((x, c) => (x + Math.trunc(((y[c] - x) | 0) / 2)) | 0);
	}
	return coding.bundleBefore === undefined ? Array(components).fill(0) : values[coding.bundleBefore];
}

// The wedges n', p' and o of the completed half-edge that is opposite to the longest edge.
function longestEdge({ surface, coded }, { completed }, positions) {
	const { tail, twin } = surface;
	let longest = -1, best;
	for (const h of completed.slice(0, LOOKED_AT)) {
		const n = tail[next(h)], p = tail[prev(h)], t = twin[next(h)];
		if (t === NONE || tail[t] !== p || tail[next(t)] !== n) continue;
		const o = tail[prev(t)];
		if (!coded[n] || !coded[p] || !coded[o]) continue;
		const l = squaredDistance(positions[n], positions[p]);
		if (l > longest) [longest, best] = [l, [n, p, o]];
	}
	return best;
}

function readResiduals(coding, ROW, predicted, n, p) {
	let context = n === NONE ? NO_NEIGHBOURS : contextOf(coding, n, p === NONE ? n : p), longest = 0;
	const value = predicted.map((x, c) => {
		const { residual, length } = byLength(coding.coder, c % 3, ROW[Math.min(c, 3)][context]);
		context = contextAfter(context, length);
		longest = Math.max(longest, length);
		return (x + residual) | 0;
	});
	return { value, length: longest };
}
