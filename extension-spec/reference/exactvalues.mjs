// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Exact values: A.8.11 of the specification. Their prediction from faces: B.7.5.

import { models } from './entropy.mjs';
import { readComponent, rowsOfSlots } from './exactvectors.mjs';
import { finite } from './floats.mjs';
import { EdgeMemory } from './memories.mjs';
import { next, NONE, prev } from './mesh.mjs';
import { dot64, sub64 } from './vectors.mjs';
import { bundles } from './wedges.mjs';

// By semantic.
export class ExactValueModels {
	constructor() {
		this.sets = models([8], () => ({ ROW: rowsOfSlots(4), KNOWN: models([2, 4]) }));
	}
}

const MEAN = 1, HINGE = 2;

class ExactValues {
	constructor(context, state) {
		const byte = state.attribute.predictor;
		this.streams = context.streams;
		this.models = context.models.exactValues.sets[state.attribute.semantic];
		this.state = state;
		this.wedges = state.wedges;
		this.predictor = byte & 3;
		this.edges = byte & 4 ? new EdgeMemory(state, (i) => i >>> 0) : undefined;
		this.history = 0;
		this.E = new Float32Array(state.wedges.count);
	}

	decode() {
		for (const bundle of bundles(this.wedges, this.state.bundleOf)) this.bundle(bundle);
	}

	bundle(bundle) {
		const bothCoded = bundle.hasEntry && this.state.isCoded(bundle.n) && this.state.isCoded(bundle.p);
		const [a, b] = bothCoded ? [bundle.n, bundle.p] : [bundle.before, bundle.before];
		const expected = a === NONE ? 0 : (this.E[a] + this.E[b]) / 2;
		const known = this.edges && bothCoded ? this.askEdges(bundle) : undefined;
		const isKnown = known !== undefined;
		const { value, error } = isKnown ? { value: known, error: expected } : this.readValue(bundle, a, b, expected);
		for (const w of bundle.members) this.E[w] = error;
		this.state.finish(bundle, value, 0);
		for (const w of bundle.members) this.edges?.learnFaces(w);
	}

	readValue(bundle, a, b, expected) {
		const predicted = this.predict(bundle, a, b);
		const value = new Int32Array(predicted.length);
		let error = expected;
		let all = 0;
		for (let c = 0; c < predicted.length; ++c) {
			const near = Math.abs(predicted[c]) < 1e38 ? predicted[c] : 0;
			value[c] = readComponent(this.streams, c % 3, this.models.ROW[c], near, error).value;
			const distance = Math.abs(finite(value[c]) - near);
			const missed = distance < 1e30 ? distance : 1e30;
			error = (error + missed) / 2;
			all += missed;
		}
		return { value, error: all / predicted.length };
	}

	// A value that the memory knows, if the flags say so.
	askEdges(bundle) {
		const asked = [];
		const o = this.wedges.behind(bundle.halfEdges[0]);
		if (this.state.isCoded(o)) asked.push(o);
		let count = 0;
		for (const k of this.edges.at(this.edges.key(bundle.n, bundle.p))) {
			if (asked.some((w) => this.areEqual(w, k))) continue;
			const hit = this.streams.bit(this.models.KNOWN[count][this.history]);
			this.history = (2 * this.history + hit) & 3;
			if (hit) return this.state.value(k).slice();
			asked.push(k);
			++count;
		}
		return undefined;
	}

	areEqual(v, w) {
		const other = this.state.value(w);
		return this.state.value(v).every((x, c) => x === other[c]);
	}

	// ---- Prediction

	predict(bundle, a, b) {
		const sum = new Array(this.state.components).fill(0);
		const weight = this.predictor === MEAN ? 0 : this.addFaces(bundle, sum);
		if (weight > 0) return sum.map((x) => x / weight);
		if (a === NONE) return sum;
		const other = this.state.value(b);
		return [...this.state.value(a)].map((x, c) => (finite(x) + finite(other[c])) / 2);
	}

	addFaces(bundle, sum) {
		let weight = 0;
		for (const h of bundle.halfEdges.slice(0, 16)) {
			const term = this.faceTerm(h);
			if (term === undefined) continue;
			term.values.forEach((x, c) => { sum[c] += x; });
			weight += term.weight;
		}
		return weight;
	}

	// [B.7.5] Faces of exact values
	faceTerm(h) {
		const { state, wedges } = this;
		const [v, n, p] = [h, next(h), prev(h)].map((g) => wedges.surface.tail(g));
		const o = wedges.behind(h);
		if (![n, p, o].every((w) => state.isCoded(w))) return undefined;
		const [xn, xp, xo] = [n, p, o].map((w) => [...state.value(w)].map(finite));
		if (this.predictor === HINGE) return this.hinge([v, n, p, o], xn, xp, xo);
		return { values: xn.map((x, c) => x + xp[c] - xo[c]), weight: 1 };
	}

	hinge(corners, xn, xp, xo) {
		const [v, n, p, o] = corners.map((w) => this.wedges.exactPositions[w]);
		const [e, d, g] = [p, v, o].map((x) => sub64(x, n));
		const ee = dot64(e, e);
		if (!(ee > 1e-90)) return undefined;
		const s = dot64(e, d) / ee;
		const so = dot64(e, g) / ee;
		const height = Math.max(dot64(d, d) - s * s * ee, 0);
		const heightO = dot64(g, g) - so * so * ee;
		if (!(height < 36 * heightO)) return undefined;
		const ratio2 = height / heightO;
		const ratio = Math.sqrt(ratio2);
		const weight = 1 / (1 + ratio2);
		const values = xn.map((x, c) => {
			const dx = xp[c] - x;
			const dxo = xo[c] - x;
			return weight * (x + s * dx + ratio * (so * dx - dxo));
		});
		return { values, weight };
	}
}

export function decodeExactValues(context, state) {
	new ExactValues(context, state).decode();
}
