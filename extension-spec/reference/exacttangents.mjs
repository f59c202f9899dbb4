// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Exact tangents: A.10.17 of the specification. What they are predicted from: A.10.17.

import { models } from './entropy.mjs';
import { flatten, makeUnit, meanError, noError, vectorOf, VectorReader, vectorRows } from './exactvectors.mjs';
import { ordered, orderedOfBits } from './floats.mjs';
import { add64 } from './vectors.mjs';
import { bundles } from './wedges.mjs';

const xyz = [0, 1, 2];

export class ExactTangentModels {
	constructor() {
		this.ROW = vectorRows();
		this.NEGATIVE = models([3]);
		this.ODD = models([]);
	}
}

// ---- [A.10.17] Exact sums of face tangents

function exactFaceTangentSums(wedges, chart) {
	const { surface, exactPositions } = wedges;
	const T = Array.from({ length: wedges.count }, () => [0, 0, 0, 0]);
	if (chart === undefined) return T;
	for (let h = 0; h < surface.halfEdgeCount; h += 3) {
		const corners = [h, h + 1, h + 2].map((g) => surface.tail(g));
		const tangent = exactFaceTangent(corners.map((w) => exactPositions[w]), corners.map((w) => chart[w]));
		if (tangent === undefined) continue;
		for (const w of corners) T[w] = [...add64(T[w], tangent.t), T[w][3] + tangent.side];
	}
	return T;
}

function exactFaceTangent([p0, p1, p2], [c0, c1, c2]) {
	const v0 = c1[1] - c0[1];
	const v1 = c2[1] - c0[1];
	const determinant = (c1[0] - c0[0]) * v1 - (c2[0] - c0[0]) * v0;
	if (!(Math.abs(determinant) > 1e-60)) return undefined;
	const side = determinant < 0 ? -1 : 1;
	const t = xyz.map((s) => side * ((p1[s] - p0[s]) * v1 - (p2[s] - p0[s]) * v0));
	makeUnit(t);
	return { t, side };
}

// ---- [A.10.17] Exact tangents

class ExactTangents {
	constructor(context, state) {
		const byte = state.attribute.predictor;
		const { wedges } = state;
		this.streams = context.streams;
		this.models = context.models.exactTangents;
		this.state = state;
		this.wedges = wedges;
		this.perpendicular = (byte & 1) !== 0;
		this.reader = new VectorReader(context.streams, this.models.ROW);
		this.normals = unitExactNormals(context, wedges);
		this.T = exactFaceTangentSums(wedges, context.chart());
		this.E = Array.from({ length: wedges.count }, noError);
		this.last = [0, 0, 0];
		this.error = noError();
	}

	decode() {
		for (const bundle of bundles(this.wedges, this.state.bundleOf)) this.bundle(bundle);
	}

	bundle(bundle) {
		const total = this.total(bundle.members);
		const N = this.normals[bundle.first];
		if (bundle.hasEntry) this.error = meanError(this.E[bundle.n], this.E[bundle.p]);
		const vector = this.reader.read(this.direction(total, N), this.error, this.perpendicular ? N : undefined);
		const value = [...vector, this.readSign(total[3])];
		for (const w of bundle.members) this.E[w] = { ...this.error };
		this.state.finish(bundle, value, 0);
		this.last = vectorOf(value);
		makeUnit(this.last);
	}

	total(members) {
		let total = [0, 0, 0, 0];
		for (const w of members) total = total.map((x, k) => x + this.T[w][k]);
		return total;
	}

	direction(total, N) {
		const sum = flatten(N, total);
		if (makeUnit(sum)) return sum;
		const direction = flatten(N, this.last);
		makeUnit(direction);
		return direction;
	}

	readSign(side) {
		const { streams, models: m } = this;
		if (streams.bit(m.ODD)) {
			const high = streams.raw(16);
			return orderedOfBits((high * 2 ** 16 + streams.raw(16)) >>> 0);
		}
		const s = side > 0 ? 1 : side < 0 ? 2 : 0;
		return ordered(streams.bit(m.NEGATIVE[s]) ? -1 : 1);
	}
}

// The exact normals as unit vectors, (0, 0, 0) if there are none.
function unitExactNormals(context, wedges) {
	const state = context.exactNormalState();
	return Array.from({ length: wedges.count }, (_, w) => {
		const N = state === undefined ? [0, 0, 0] : vectorOf(state.value(w));
		makeUnit(N);
		return N;
	});
}

export function decodeExactTangents(context, state) {
	new ExactTangents(context, state).decode();
}
