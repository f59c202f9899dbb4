// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Prediction of positions from a fan: A.6.4, A.6.10 and A.6.5 of the specification, and the weights of A.6.2.

import { next, NONE, prev } from './mesh.mjs';
import { add32, clamp, cross32, f } from './vectors.mjs';

// [A.6.2] Universal weights of the classes
const UNIVERSAL_WEIGHTS = [
	[5],
	[37],
	[23],
	[26],
	[84],
	[78],
	[0, 0, 0, 0, 0],
	[98, -97, -4, -2, -4],
	[71, -53, -5, -4, -4],
	[50, -5, -7, -7, -3],
	[34, 13, -8, -9, -4],
	[20, 35, -9, -10, -4],
	[3, 60, -15, -11, -5],
	...Array.from({ length: 9 }, () => new Array(8).fill(0)),
];

export const universalWeights = () => UNIVERSAL_WEIGHTS.map((w) => [...w]);
export const zeroWeights = () => UNIVERSAL_WEIGHTS.map((w) => w.map(() => 0));

const clampDegrees = (x) => clamp(x, -12, 12);
const xyz = [0, 1, 2];

// [A.6.3] float(x) of an i32, whose sums wrap
const float = (x) => f(x | 0);
const sumOf = (list) => list.reduce((a, b) => a + b, 0);
const sum32 = (list) => list.reduce((a, b) => f(a + b), 0);

// [A.6.3] A movement in 1/256 of a step
export const movement = (x) => Math.trunc(clamp(x, -(2 ** 29), 2 ** 29));

// Predictions of one piece. `records` holds what A.6.3 keeps of the groups.
export class Prediction {
	constructor(surface, region, records, select, weights) {
		this.surface = surface;
		this.region = region;
		this.records = records;
		this.select = select;
		this.weights = weights;
	}

	// By component the fine point `at`, spread, third and magnitudes of a fan.
	predict(fan) {
		return fan.plain ? this.plainFan(fan) : this.otherFan(fan);
	}

	// The coordinates of vertices on axis s, undefined where there is none.
	on(s, vertices) {
		return vertices.map((v) => (v === NONE ? undefined : this.records.q[3 * v + s]));
	}

	// |float(sum)| of the magnitudes of the neighbours
	magnitudes(fan) {
		const { magnitude } = this.records;
		return xyz.map((k) => Math.abs(float(sumOf(fan.neighbours.map((n) => magnitude[3 * n + k])))));
	}

	// ---- [A.6.4] Prediction of a plain fan

	plainFan(fan) {
		const around = this.aroundPlainFan(fan);
		const degrees = [fan.v, ...fan.neighbours].map((v) => this.records.degree[v]);
		const w = this.plainWeights(around, degrees);
		const between = around.map(({ d0, d1 }) => (d1 - d0) | 0);
		const at = around.map(({ n1, d0, ...rest }, s) => ({
			step: (d0 + n1 + (between[s] >> 1)) | 0,
			fraction: 128 * (between[s] & 1) + movement(weightedFeatures({ n1, d0, ...rest }, degrees, w)),
		}));
		const spread = between.map((x) => Math.abs(f(x)));
		const third = around.map(({ n0, n1, n2, o0, o1 }) => Math.abs(float(n0 + n2 + o0 + o1 - 4 * n1)));
		return { at, spread, third, magnitudes: this.magnitudes(fan) };
	}

	// The coordinates around the fan and the vertices beyond, by component.
	aroundPlainFan(fan) {
		const { surface, region } = this;
		const b0 = surface.twin(next(fan.halfEdges[0]));
		const b1 = surface.twin(next(fan.halfEdges[1]));
		const beyond = [next(b0), prev(b1), prev(b0), next(b1)].map((h) => region.tip(h)); // ya, yb, xa, xb
		return xyz.map((s) => {
			const [n0, n1, n2] = this.on(s, fan.neighbours);
			const [o0, o1] = this.on(s, fan.tips);
			const [ya, yb, xa, xb] = this.on(s, beyond);
			const ua = ya === undefined ? 0 : ya - n0 - o0 + n1;
			const ub = yb === undefined ? 0 : yb - n2 - o1 + n1;
			return { n0, n1, n2, o0, o1, ya, yb, xa, xb, ua, ub, d0: n0 - o0, d1: n2 - o1 };
		});
	}

	// The weights of the class of a plain fan, and better.
	plainWeights(around, [g, , g1]) {
		const select = this.select && around[0].xa !== undefined && around[0].xb !== undefined && g1 >= 6 && g === 6;
		if (select) return this.selectedWeights(around);
		return { w: this.weights[3 + clamp(g, 3, 9)], better: 0 };
	}

	selectedWeights(around) {
		const total = (term) => sum32(around.map(term));
		const size = (x) => Math.abs(float(x));
		const e1 = total(({ n0, n1, o0, xa }) => size(n1 + o0 - xa - n0));
		const e0 = total(({ n1, n2, o1, xb }) => size(n1 + o1 - xb - n2));
		const [hasYa, hasYb] = [around[0].ya !== undefined, around[0].yb !== undefined];
		const e2 = total(({ ua, ub }) => f(size(ua) + size(ub))) * (hasYa && hasYb ? 0.5 : 1);
		const low = Math.min(e0, e1);
		const high = Math.max(e0, e1);
		const limit = f(f(3 * low) + 2);
		const preference = Number(2 * high > limit) + Number(high > limit);
		const third = hasYa || hasYb ? Number(e2 <= 2 * low) + Number(2 * e2 <= low) : 0;
		return { w: this.weights[13 + 3 * preference + third], better: Number(e0 < e1) - Number(e0 > e1) };
	}

	// ---- [A.6.5] Prediction of any other fan

	otherFan(fan) {
		const ring = ringOfNeighbours(fan);
		const indices = fan.tips.flatMap((o, i) => (o === NONE ? [] : [i])); // of the tips
		const T = indices.length;
		const w = this.weights[classOfOtherFan(T, fan.closed)][0];
		const N = fan.neighbours.length;
		const at = [];
		const spread = [];
		for (const s of xyz) {
			const n = this.on(s, ring);
			const o = this.on(s, fan.tips);
			const tips = indices.map((i) => (n[i] + n[i + 1] - o[i]) | 0);
			const step = T === 0 ? n[0] : tips[0];
			const meanOf = (list) => f(float(sumOf(list.map((x) => x - step))) / list.length);
			const mean = meanOf(this.on(s, fan.neighbours));
			const tip = T === 0 ? mean : meanOf(tips);
			at.push({ step, fraction: movement(f(256 * tip + f(f(mean - tip) * 2 * w))) });
			spread.push(T >= 2 ? Math.abs(float(tips[1] - tips[0])) : 0);
		}
		const magnitudes = this.magnitudes(fan).map((m) => f(m * f(3 / N)));
		return { at, spread, third: [0, 0, 0], magnitudes };
	}

	// ---- [A.6.10] The normal of a fan

	normal(fan) {
		const ring = ringOfNeighbours(fan);
		const coordinates = xyz.map((s) => ({ n: this.on(s, ring), o: this.on(s, fan.tips) }));
		let normal = [0, 0, 0];
		fan.tips.forEach((tip, i) => {
			if (tip === NONE) return;
			const u = coordinates.map(({ n }) => float(n[i] - n[i + 1]));
			const w = coordinates.map(({ n, o }) => float(o[i] - n[i + 1]));
			normal = add32(normal, cross32(u, w));
		});
		return normal;
	}
}

// By how much the weights move the prediction of a plain fan from the middle of its tips, in 1/256 of a step.
function weightedFeatures({ n0, n1, n2, o0, o1, xa, xb, ua, ub }, [, g0, , g2], { w, better }) {
	const f1 = n0 + n2 - 2 * n1;
	const terms = [
		[f1 + o0 + o1 - 2 * n1, w[0] + w[4] * clampDegrees(g0 + g2 - 12)],
		[f1, w[1]],
		[2 * (ua + ub), w[2]],
		[2 * (n0 - n2), w[3] * clampDegrees(g0 - g2)],
	];
	if (better !== 0) {
		terms.push([n0 - n2 + o1 - o0, better * w[5]]);
		terms.push([o0 - xa - n0 - (o1 - xb - n2), better * w[6]]);
		terms.push([ua - ub, better * w[7]]);
	}
	return sum32(terms.map(([feature, weight]) => f(float(feature) * weight)));
}

// n[0] .. n[m], where n[m] is n[0] if the fan is closed.
function ringOfNeighbours(fan) {
	return fan.closed ? [...fan.neighbours, fan.neighbours[0]] : fan.neighbours;
}

function classOfOtherFan(T, closed) {
	if (closed) return T < 4 ? 4 : 5;
	return clamp(T, 1, 4) - 1;
}

// [A.6.10] The axes by |normal|, ascending, lower axes first among equals
export function axesByNormal(normal) {
	return [0, 1, 2].sort((a, b) => Math.abs(normal[a]) - Math.abs(normal[b]) || a - b);
}
