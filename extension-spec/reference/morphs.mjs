// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Deltas of NORMAL and TANGENT of morph targets: B.8 of the specification.

import { flatten, makeUnit } from './exactvectors.mjs';
import { ANGLE, EQUAL, faceNormalSums, latticeFloat, rangeOfFloats } from './faces.mjs';
import { finite } from './floats.mjs';
import { scaleOfGrid } from './grids.mjs';
import { LATTICE, NORMAL } from './names.mjs';
import { add32, cross64, dot32, dot64, f, sqrt32 } from './vectors.mjs';

const xyz = [0, 1, 2];

const stepOf = (attribute) => (attribute.coding === LATTICE ? attribute.step : 1 / scaleOfGrid(attribute.grid));

function nearest(x) {
	return x > -2e9 && x < 2e9 ? Math.trunc(x + (x < 0 ? -0.5 : 0.5)) : 0;
}

// The value of a delta at a wedge, as three f32.
function deltaOf(state, w) {
	const { attribute } = state;
	return [...state.value(w)].map((q, c) => (attribute.coding === LATTICE ? latticeFloat(attribute, q, c) : finite(q)));
}

// ---- [B.8.1] Bends of all wedges

export function bendsOf(context, attribute) {
	const { wedges } = context;
	const normals = context.unitNormals();
	const smooth = smoothWedges(wedges, normals);
	const weight = weightOfFaces(context.attributes);
	const step = stepOf(attribute);
	const still = directions(wedges, wedges.positions, weight, smooth);
	const moved = directions(wedges, movedPositions(wedges, context.stateOf(attribute.positionDeltas)), weight, smooth);
	return still.map((d, w) => d.map((x, s) => nearest((moved[w][s] - x) / step)));
}

function movedPositions(wedges, deltas) {
	const moved = wedges.exactPositions.map((p, w) => add32(p, deltaOf(deltas, w)));
	return rangeOfFloats(moved.map((v) => v.map((x) => (Number.isFinite(x) ? x : 0))));
}

// The first wedge of the smooth wedges that each wedge is one of.
function smoothWedges(wedges, normals) {
	const { groupOf } = wedges;
	const smooth = Array.from({ length: wedges.count }, (_, w) => w);
	if (normals === undefined || !wedges.hasSeams) return smooth;
	const alike = (v, w) => normals[v].every((x, s) => Object.is(x, normals[w][s]));
	let first = 0;
	for (let w = 1; w < wedges.surfaceCount; ++w) {
		if (groupOf[w] !== groupOf[w - 1]) first = w;
		else if (alike(w - 1, w)) smooth[w] = smooth[w - 1];
		else if (alike(first, w)) smooth[w] = first;
	}
	return smooth;
}

function weightOfFaces({ exactNormal, octahedralNormal }) {
	const normal = exactNormal ?? octahedralNormal;
	const hasWeight = normal?.method === 'exact normal' || normal?.method === 'normal';
	if (!hasWeight || (normal.predictor & 3) === EQUAL) return ANGLE;
	return normal.predictor & 3;
}

function directions(wedges, positions, weight, smooth) {
	const sums = faceNormalSums(wedges.surface, wedges.count, positions, weight);
	smooth.forEach((first, w) => {
		if (first !== w) sums[first] = add32(sums[first], sums[w]);
	});
	return smooth.map((first) => unitOrZero(sums[first]));
}

function unitOrZero(v) {
	const length = sqrt32(dot32(v, v));
	return length > f(1e-30) && length < f(1e30) ? v.map((x) => f(x / length)) : [0, 0, 0];
}

// ---- [B.8.2] Deltas of unit vectors

export class UnitDeltas {
	// bends: of all wedges, or undefined
	constructor(context, attribute, bends) {
		this.step = stepOf(attribute);
		this.bends = bends;
		this.isNormal = attribute.semantic === NORMAL;
		this.base = this.isNormal ? context.unitNormals() : context.baseTangents();
		this.movedNormals = this.isNormal ? undefined : movedNormals(context, attribute);
	}

	// readResidual(i, c, follows) reads component c, the i-th.
	read(w, predicted, readResidual) {
		this.begin(w, predicted);
		const value = new Int32Array(3);
		let L = 0;
		this.order.forEach((c, i) => {
			const follows = this.isNormal ? i === 2 : i > 0;
			const { residual, length } = readResidual(i, c, follows);
			if (!follows) L = Math.max(L, length);
			value[c] = this.predicted[c] + residual;
			if (this.isNormal && i === 1) this.predictNormal(value);
			if (!this.isNormal && i === 0) this.predictTangent(value);
		});
		return { value, L };
	}

	begin(w, predicted) {
		this.predicted = [...predicted];
		this.baseOf = this.base[w];
		this.bend = this.bends?.[w] ?? [0, 0, 0];
		this.M = this.movedNormals?.[w];
		this.m = xyz.map((c) => this.moved(c, predicted[c]));
		if (!this.isNormal) this.m = flatten(this.M, this.m);
		this.order = this.findOrder();
	}

	moved(c, q) {
		return this.baseOf[c] + (q + this.bend[c]) * this.step;
	}

	integer(c, x) {
		return nearest((x - this.baseOf[c]) / this.step - this.bend[c]);
	}

	findOrder() {
		const v = this.isNormal ? this.m : cross64(this.M, this.m);
		let L = Math.abs(v[1]) > Math.abs(v[0]) ? 1 : 0;
		if (Math.abs(v[2]) > Math.abs(v[L])) L = 2;
		const order = [0, 1, 2];
		[order[L], order[2]] = [order[2], order[L]];
		if (!this.isNormal) [order[0], order[2]] = [order[2], order[0]];
		return order;
	}

	predictNormal(value) {
		const [x, y] = [0, 1].map((i) => this.moved(this.order[i], value[this.order[i]]));
		const q = 1 - x * x - y * y;
		const z = q > 0 ? Math.sqrt(q) : 0;
		const c = this.order[2];
		this.predicted[c] = this.integer(c, this.m[c] < 0 ? -z : z);
	}

	predictTangent(value) {
		const { M, order } = this;
		const F = order[0];
		const e1 = xyz.map((c) => (c === F ? 1 : 0) - M[F] * M[c]);
		const s = e1[F];
		if (!(s > 1e-6 && makeUnit(e1))) return;
		const e2 = cross64(M, e1);
		const x = this.moved(F, value[F]) / Math.sqrt(s);
		const q = 1 - x * x;
		let y = q > 0 ? Math.sqrt(q) : 0;
		if (dot64(this.m, e2) < 0) y = -y;
		for (const c of order.slice(1)) this.predicted[c] = this.integer(c, x * e1[c] + y * e2[c]);
	}
}

function movedNormals(context, attribute) {
	const deltas = context.stateOf(attribute.normalDeltas);
	return context.unitNormals().map((G, w) => {
		const delta = deltaOf(deltas, w);
		const m = xyz.map((s) => G[s] + delta[s]);
		makeUnit(m);
		return m.map(f);
	});
}
