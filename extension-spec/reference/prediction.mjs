// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Prediction of positions from a fan: B.2.2, B.2.3 and B.2.4 of the specification, and the weights of A.6.2.

import { next, NONE, prev } from './mesh.mjs';
import { add32, cross32, f } from './vectors.mjs';

// [A.6.2] Integers of 32 or of 64 bits, as BigInt.
export class Wide {
	constructor(bits) {
		this.bits = bits;
	}

	wrap(x) {
		return BigInt.asIntN(this.bits, x);
	}

	unsigned(x) {
		return BigInt.asUintN(this.bits, x);
	}

	abs(x) {
		const wrapped = this.wrap(x);
		return this.unsigned(wrapped < 0n ? -wrapped : wrapped);
	}
}

export const toI32 = (x) => Number(BigInt.asIntN(32, x));

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

const clampDegrees = (x) => Math.min(Math.max(x, -12), 12);
const xyz = [0, 1, 2];

// Predictions of one piece. `records` holds what B.2.1 keeps of the groups.
export class Prediction {
	constructor(surface, region, records, wide, select, weights) {
		this.surface = surface;
		this.region = region;
		this.records = records;
		this.wide = wide;
		this.select = select;
		this.weights = weights;
	}

	// q8, spread and magnitudes of a fan, by component, as BigInt; for a plain fan d0 - d1, too.
	predict(fan) {
		return fan.plain ? this.plainFan(fan) : this.otherFan(fan);
	}

	// The coordinates of vertices on axis s.
	on(s, vertices) {
		return vertices.map((v) => (v === NONE ? NONE : BigInt(this.records.q[3 * v + s])));
	}

	magnitude(v, k) {
		return BigInt(this.records.magnitude[3 * v + k]);
	}

	// ---- [B.2.2] Prediction of a plain fan

	plainFan(fan) {
		const { wide, records } = this;
		const around = this.aroundPlainFan(fan);
		const degrees = [fan.v, ...fan.neighbours].map((v) => records.degree[v]);
		const w = this.plainWeights(around, degrees);
		const q8 = xyz.map((s) => wide.wrap(this.plainComponent(around[s], degrees, w)));
		const difference = xyz.map((s) => wide.wrap(around[s].d0 - around[s].d1));
		const spread = difference.map((x) => wide.abs(x));
		const magnitudes = xyz.map((k) => wide.unsigned(fan.neighbours.reduce((m, n) => m + this.magnitude(n, k), 0n)));
		return { q8, spread, difference, magnitudes };
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
			const ua = ya === NONE ? 0n : ya - n0 - o0 + n1;
			const ub = yb === NONE ? 0n : yb - n2 - o1 + n1;
			return { n0, n1, n2, o0, o1, ya, yb, xa, xb, ua, ub, d0: n0 - o0, d1: n2 - o1 };
		});
	}

	plainComponent({ n0, n1, n2, o0, o1, xa, xb, ua, ub, d0, d1 }, [, g0, , g2], { w, better }) {
		let q8 = (d0 + d1 + 2n * n1) << 7n;
		const sum = clampDegrees(g0 + g2 - 12);
		const skew = clampDegrees(g0 - g2);
		const f1 = n0 + n2 - 2n * n1;
		const f0 = f1 + o0 + o1 - 2n * n1;
		q8 += f0 * BigInt(w[0] + w[4] * sum) + f1 * BigInt(w[1]);
		q8 += 2n * (ua + ub) * BigInt(w[2]) + 2n * (n0 - n2) * BigInt(w[3] * skew);
		if (better === 0) return q8;
		q8 += (n0 - n2 + o1 - o0) * BigInt(better * w[5]);
		q8 += ((o0 - xa - n0) - (o1 - xb - n2)) * BigInt(better * w[6]);
		return q8 + (ua - ub) * BigInt(better * w[7]);
	}

	// The weights of the class of a plain fan, and better.
	plainWeights(around, [g, , g1]) {
		const select = this.select && around[0].xa !== NONE && around[0].xb !== NONE && g1 >= 6 && g === 6;
		if (select) return this.selectedWeights(around);
		return { w: this.weights[3 + Math.min(Math.max(g, 3), 9)], better: 0 };
	}

	selectedWeights(around) {
		const { wide } = this;
		const total = (term) => wide.unsigned(around.reduce((sum, a) => sum + term(a), 0n));
		const e1 = total(({ n0, n1, o0, xa }) => wide.abs(n1 + o0 - xa - n0));
		const e0 = total(({ n1, n2, o1, xb }) => wide.abs(n1 + o1 - xb - n2));
		const e2 = this.thirdError(around[0], total(({ ua, ub }) => wide.abs(ua) + wide.abs(ub)));
		const low = e0 < e1 ? e0 : e1;
		const high = e0 < e1 ? e1 : e0;
		const preference = Number(wide.unsigned(2n * high) > wide.unsigned(3n * low + 2n))
			+ Number(high > wide.unsigned(3n * low + 2n));
		const hasThird = around[0].ya !== NONE || around[0].yb !== NONE;
		const third = hasThird ? Number(e2 <= wide.unsigned(2n * low)) + Number(wide.unsigned(2n * e2) <= low) : 0;
		const better = Number(e0 < e1) - Number(e0 > e1);
		return { w: this.weights[13 + 3 * preference + third], better };
	}

	thirdError({ ya, yb }, e2) {
		return ya !== NONE && yb !== NONE ? this.wide.unsigned(e2 + 1n) >> 1n : e2;
	}

	// ---- [B.2.4] Prediction of any other fan

	otherFan(fan) {
		const { wide } = this;
		const ring = ringOfNeighbours(fan);
		const indices = fan.tips.flatMap((o, i) => (o === NONE ? [] : [i])); // of the tips
		const T = indices.length;
		const w = T === 0 ? 0 : this.weights[classOfOtherFan(T, fan.closed)][0];
		const q8 = [];
		const spread = [];
		for (const s of xyz) {
			const n = this.on(s, ring);
			const o = this.on(s, fan.tips);
			const tips = indices.map((i) => n[i] + n[i + 1] - o[i]);
			q8.push(wide.wrap(this.otherComponent(this.on(s, fan.neighbours), tips, w)));
			spread.push(T >= 2 ? wide.abs(tips[0] - tips[1]) : 0n);
		}
		const magnitudes = xyz.map((k) => this.otherMagnitude(fan, k));
		return { q8, spread, magnitudes };
	}

	otherComponent(neighbours, tips, w) {
		const { wide } = this;
		const meanOf = (list) => wide.wrap(256n * list.reduce((a, b) => a + b, 0n)) / BigInt(list.length);
		const mean = meanOf(neighbours);
		if (tips.length === 0) return mean;
		const base = meanOf(tips);
		const m2 = wide.wrap(mean - base) >> 7n;
		return base + m2 * BigInt(w);
	}

	otherMagnitude(fan, k) {
		const { wide } = this;
		const N = fan.neighbours.length;
		const total = wide.unsigned(fan.neighbours.reduce((m, n) => m + this.magnitude(n, k), 0n));
		return N === 3 ? total : wide.unsigned(total * 3n) / BigInt(N);
	}

	// ---- [B.2.3] The normal of a fan

	normal(fan) {
		const ring = ringOfNeighbours(fan);
		const coordinates = xyz.map((s) => ({ n: this.on(s, ring), o: this.on(s, fan.tips) }));
		const float = (x) => f(Number(this.wide.wrap(x)));
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

// n[0] .. n[m], where n[m] is n[0] if the fan is closed.
function ringOfNeighbours(fan) {
	return fan.closed ? [...fan.neighbours, fan.neighbours[0]] : fan.neighbours;
}

function classOfOtherFan(T, closed) {
	if (closed) return T < 4 ? 4 : 5;
	return Math.min(T, 4) - 1;
}

// [B.2.3] The axes by |normal|, ascending, lower axes first among equals
export function axesByNormal(normal) {
	return [0, 1, 2].sort((a, b) => Math.abs(normal[a]) - Math.abs(normal[b]) || a - b);
}
