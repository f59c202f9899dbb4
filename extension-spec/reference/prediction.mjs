// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Predictions of positions from a fan [A.6.4, A.6.5], and the normal of a fan [A.6.10].
//
// Sums of i32 are exact in Numbers, so that it suffices to wrap them (| 0) before they are shifted or become floats.

import { SELECT, WEIGHTS_BIT } from './attributeheader.mjs';
import { add32, clamp, cross32, f, max, min, move } from './floats.mjs';
import { NONE, across, next, prev } from './surface.mjs';

// A vector of what `make` makes of each axis.
export const vector = (make) => [make(0), make(1), make(2)];
const float = (i) => f(i | 0);
const absFloat = (i) => Math.abs(float(i));
const sumOfVector = (x) => f(f(x[0] + x[1]) + x[2]);
export const predict = (p, fan) => (fan.plain ? predictPlain(p, fan) : predictOther(p, fan));

// [A.6.4] A prediction: step, fraction, spread and third by component, magnitudes by slot.
function predictPlain(p, fan) {
	const [n0, n1, n2] = fan.n.map((g) => p.q[g]);
	const [o0, o1] = fan.o.map((g) => p.q[g]);
	const between = vector((s) => (n2[s] - o1[s] - (n0[s] - o0[s])) | 0);
	const sums = vector((k) => fan.n.reduce((sum, g) => sum + p.magnitude[g][k], 0));
	const prediction = {
		step: vector((s) => (n0[s] + n1[s] - o0[s] + (between[s] >> 1)) | 0),
		fraction: vector((s) => 128 * (between[s] & 1)),
		spread: vector((s) => absFloat(between[s])),
		third: vector((s) => absFloat(n0[s] + n2[s] + o0[s] + o1[s] - 4 * n1[s])),
		magnitudes: sums.map(absFloat),
	};
	if (p.predictor & WEIGHTS_BIT) addWeighted(p, fan, prediction.fraction, { n0, n1, n2, o0, o1 });
	return prediction;
}

// [A.6.4] With weights: moves the fraction along differences.
function addWeighted(p, fan, fraction, { n0, n1, n2, o0, o1 }) {
	const { xa, xb, ya, yb } = verticesBeyond(p, fan);
	const [g0, g1, g2] = fan.n.map((g) => p.degree[g]);
	const g = p.degree[fan.v];
	const ua = vector((s) => (ya === undefined ? 0 : (ya[s] - n0[s] - o0[s] + n1[s]) | 0));
	const ub = vector((s) => (yb === undefined ? 0 : (yb[s] - n2[s] - o1[s] + n1[s]) | 0));
	const degrees = clamp(g0 + g2 - 12, -12, 12), skew = clamp(g0 - g2, -12, 12);
	let c = 3 + clamp(g, 3, 9), better = 0;
	if ((p.predictor & SELECT) && xa !== undefined && xb !== undefined && g1 >= 6 && g === 6) {
		const e1 = sumOfVector(vector((s) => absFloat(n1[s] + o0[s] - xa[s] - n0[s])));
		const e0 = sumOfVector(vector((s) => absFloat(n1[s] + o1[s] - xb[s] - n2[s])));
		const e2 = sumOfVector(vector((s) => f(absFloat(ua[s]) + absFloat(ub[s]))));
		({ c, better } = selectTip(e0, e1, e2, [ya, yb].filter((y) => y !== undefined).length));
	}
	const w = p.w[c];
	for (let s = 0; s < 3; ++s) {
		const f1 = n0[s] + n2[s] - 2 * n1[s], f0 = f1 + o0[s] + o1[s] - 2 * n1[s];
		let x = f(float(f0) * f(w[0] + w[4] * degrees));
		x = f(x + f(float(f1) * f(w[1])));
		x = f(x + f(float(2 * (ua[s] + ub[s])) * f(w[2])));
		x = f(x + f(float(2 * (n0[s] - n2[s])) * f(w[3] * skew)));
		if (better !== 0) {
			x = f(x + f(float(n0[s] - n2[s] + o1[s] - o0[s]) * f(better * w[5])));
			x = f(x + f(float(o0[s] - xa[s] - n0[s] - (o1[s] - xb[s] - n2[s])) * f(better * w[6])));
			x = f(x + f(float(ua[s] - ub[s]) * f(better * w[7])));
		}
		fraction[s] = (fraction[s] + move(x)) | 0;
	}
}

// [A.6.4] Coordinates of the known vertices beyond o0 and o1; those that are missing are undefined.
function verticesBeyond(p, fan) {
	const { twin, tail } = p.surface;
	const b0 = twin[next(fan.fan[0])], b1 = twin[next(fan.fan[1])];
	const beyond = (h) => {
		const x = across(p.surface, h);
		return x === NONE ? undefined : p.q[tail[x]];
	};
	return { ya: beyond(next(b0)), yb: beyond(prev(b1)), xa: beyond(prev(b0)), xb: beyond(next(b1)) };
}

// [A.6.4] The class of tip selection; `there` is how many of ya and yb are.
function selectTip(e0, e1, sum, there) {
	const e2 = there === 2 ? f(sum * 0.5) : sum, low = min(e0, e1), high = max(e0, e1);
	const limit = f(f(3 * low) + 2);
	const preference = (f(2 * high) > limit ? 1 : 0) + (high > limit ? 1 : 0);
	const alike = there === 0 ? 0 : (e2 <= f(2 * low) ? 1 : 0) + (f(2 * e2) <= low ? 1 : 0);
	return { c: 13 + 3 * preference + alike, better: (e0 < e1 ? 1 : 0) - (e0 > e1 ? 1 : 0) };
}

// [A.6.5]
function predictOther(p, fan) {
	const N = fan.count, neighbours = fan.n.slice(0, N), tips = [];
	for (let i = 0; i < fan.m; ++i) {
		if (fan.o[i] === NONE) continue;
		const [a, b, o] = [p.q[fan.n[i]], p.q[fan.n[i + 1]], p.q[fan.o[i]]];
		tips.push(vector((s) => (a[s] + b[s] - o[s]) | 0));
	}
	const T = tips.length, step = T === 0 ? p.q[fan.n[0]].slice() : tips[0];
	const w = p.w[fan.closed ? 4 + (T >= 4 ? 1 : 0) : Math.max(Math.min(T, 4), 1) - 1];
	const meanOf = (points, s) => f(float(points.reduce((sum, point) => sum + point[s] - step[s], 0)) / points.length);
	const fraction = vector((s) => {
		const mean = meanOf(neighbours.map((g) => p.q[g]), s);
		const mean2 = T === 0 ? mean : meanOf(tips, s);
		return move(f(f(256 * mean2) + f(f(mean - mean2) * f(2 * w[0]))));
	});
	const share = f(3 / N);
	return {
		step, fraction, third: [0, 0, 0],
		spread: vector((s) => (T >= 2 ? absFloat(tips[1][s] - tips[0][s]) : 0)),
		magnitudes: vector((k) => f(absFloat(neighbours.reduce((sum, g) => sum + p.magnitude[g][k], 0)) * share)),
	};
}

// [A.6.10] The normal of a fan.
export function normalOfFan(p, fan) {
	let normal = [0, 0, 0];
	for (let i = 0; i < fan.m; ++i) {
		if (fan.o[i] === NONE) continue;
		const [a, b, o] = [p.q[fan.n[i]], p.q[fan.n[i + 1]], p.q[fan.o[i]]];
		const product = cross32(vector((s) => float(a[s] - b[s])), vector((s) => float(o[s] - b[s])));
		normal = add32(normal, product);
	}
	return normal;
}

// [A.6.10] The axes by |normal|, ascending, lower axes first among equals.
export const sortAxes = (axes, normal) =>
	axes.slice().sort((a, b) => Math.abs(normal[a]) - Math.abs(normal[b]) || a - b);
