// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Values of any number of components: A.8.4 of the specification. Their simpler predictions: B.3.1.

import { Blend } from './blend.mjs';
import { models, rows } from './entropy.mjs';
import { IdModels, Ids } from './ids.mjs';
import { following, readByLength, readSmallSigned } from './lengths.mjs';
import { next, NONE, prev } from './mesh.mjs';
import { bendsOf, UnitDeltas } from './morphs.mjs';
import { NORMAL, POSITION } from './names.mjs';
import { bundles } from './wedges.mjs';

const MEAN = 1, DIAGONAL = 2, BLEND = 3;
const NO_NEIGHBOUR = 11; // the context

// By semantic, by whether the set index is 0, by whether it is a morph target.
export class ValueModels {
	constructor() {
		this.sets = models([8, 2, 2], () => ({
			ROW: rows([4, 12]),
			ZERO: models([4, 2, 2]),
			SAME: models([2, 3]),
			FOLLOWING: rows([2]),
		}));
		this.ids = new IdModels();
	}

	of(attribute) {
		return this.sets[attribute.semantic][attribute.set === 0 ? 1 : 0][attribute.target !== 0 ? 1 : 0];
	}
}

// [A.8.4] What moved: flags of the wedges by semantic, of one piece
export class Moved {
	constructor(wedgeCount) {
		this.now = Array.from({ length: 8 }, () => new Uint8Array(wedgeCount));
		this.before = undefined;
		this.target = undefined;
	}

	begin(target) {
		if (this.target !== target) this.before = this.now.map((flags) => flags.slice());
		this.target = target;
	}
}

class Values {
	constructor(context, state) {
		const { attribute } = state;
		const byte = attribute.predictor;
		this.streams = context.streams;
		this.context = context;
		this.state = state;
		this.wedges = state.wedges;
		this.models = context.models.values.of(attribute);
		this.predictor = byte & 3;
		this.same = (byte & 4) !== 0;
		this.zero = (byte & 8) !== 0;
		this.small = (byte & 16) !== 0;
		this.isMorph = attribute.target !== 0;
		this.ids = byte & 32 && !this.isMorph ? new Ids(context.streams, context.models.values.ids) : undefined;
		this.bends = byte & 32 && this.isMorph && attribute.semantic === NORMAL ? bendsOf(context, attribute) : undefined;
		this.units = byte & 64 ? new UnitDeltas(context, attribute, this.bends) : undefined;
		this.blend = this.predictor === BLEND ? new Blend(state) : undefined;
	}

	decode() {
		const { state, context } = this;
		if (this.isMorph) context.moved.begin(state.attribute.target);
		for (const bundle of bundles(this.wedges, state.bundleOf)) this.bundle(bundle);
		if (this.bends !== undefined) this.addBends();
	}

	bundle(bundle) {
		const neighbours = this.neighbours(bundle);
		const { value, L } = this.flagged(bundle, neighbours) ?? this.coded(bundle, neighbours);
		this.state.finish(bundle, value, L);
		if (this.isMorph) this.noteMoved(bundle.members, value);
	}

	noteMoved(members, value) {
		const flags = this.context.moved.now[this.state.attribute.semantic];
		for (const w of members) flags[w] = value.some((x) => x !== 0) ? 1 : 0;
	}

	// [A.8.14]
	addBends() {
		const { state } = this;
		for (let w = 0; w < this.wedges.count; ++w) {
			const bend = this.bends[state.bundleOf[w][0]];
			state.set(w, state.value(w).map((x, c) => x + bend[c]));
		}
	}

	// ---- Neighbours and flags

	neighbours(bundle) {
		if (bundle.isolated) return { n: NONE, p: NONE };
		const { n, p } = bundle.hasEntry ? this.codedOnes(bundle.n, bundle.p) : this.neighbourInRun(bundle.first);
		return n === NONE ? { n: p, p: n } : { n, p };
	}

	codedOnes(n, p) {
		const { state } = this;
		return { n: state.isCoded(n) ? n : NONE, p: state.isCoded(p) ? p : NONE };
	}

	neighbourInRun(w) {
		const { surface } = this.wedges;
		for (const h of this.wedges.run(w)) {
			const { n, p } = this.codedOnes(surface.tail(next(h)), surface.tail(prev(h)));
			if (n !== NONE || p !== NONE) return { n: n !== NONE ? n : p, p: NONE };
		}
		return { n: NONE, p: NONE };
	}

	isZero(w) {
		return this.state.value(w).every((x) => x === 0);
	}

	areEqual(v, w) {
		const other = this.state.value(w);
		return this.state.value(v).every((x, c) => x === other[c]);
	}

	// The value that a flag tells, if one does.
	flagged(bundle, { n, p }) {
		if (this.zero && this.streams.bit(this.zeroModel(bundle.first, n, p))) {
			return { value: new Int32Array(this.state.components), L: 0 };
		}
		if (!this.same || n === NONE) return undefined;
		return this.flaggedSame(n, p);
	}

	zeroModel(w, n, p) {
		const [b, m] = this.movements(w);
		if (n === NONE) return this.models.ZERO[3][b][m];
		const z = Number(this.isZero(n)) + Number(this.isZero(p === NONE ? n : p));
		return this.models.ZERO[z][b][m];
	}

	movements(w) {
		if (!this.isMorph) return [0, 0];
		const { moved } = this.context;
		return [moved.before[this.state.attribute.semantic][w], moved.now[POSITION][w]];
	}

	flaggedSame(n, p) {
		const { streams, state } = this;
		const { SAME } = this.models;
		const k = p === NONE ? 2 : Number(this.areEqual(n, p));
		const valueOf = (w) => ({ value: state.value(w).slice(), L: 0 });
		if (!(this.zero && this.isZero(n)) && streams.bit(SAME[0][k])) return valueOf(n);
		if (k === 0 && streams.bit(SAME[1][0])) return valueOf(p);
		return undefined;
	}

	// ---- Predictions and residuals

	coded(bundle, { n, p }) {
		if (this.ids !== undefined) return { value: [this.ids.read(this.beside(bundle, n))], L: 0 };
		const { L } = this.state;
		const context = n === NONE ? NO_NEIGHBOUR : Math.min(Math.floor((L[n] + L[p === NONE ? n : p] + 1) / 2), 10);
		if (this.blend !== undefined && this.blend.applies(bundle)) {
			const blended = this.blend.predict(bundle);
			const result = this.residuals(bundle, blended.predicted, blended.contexts);
			this.blend.learn(bundle, result.value);
			return result;
		}
		return this.residuals(bundle, this.predict(bundle, n, p), undefined, context);
	}

	beside(bundle, n) {
		const w = n !== NONE ? n : bundle.before;
		return w === NONE ? 0 : this.state.value(w)[0];
	}

	readResidual(state, row) {
		return this.small ? readSmallSigned(this.streams, state, row) : readByLength(this.streams, state, row);
	}

	// contexts: those of a blend, by component; else `context` is that of the first component.
	residuals(bundle, predicted, contexts, context) {
		if (this.units !== undefined) return this.unitResiduals(bundle, predicted, (c) => contexts?.[c] ?? context);
		const value = new Int32Array(predicted.length);
		let longest = 0;
		for (let c = 0; c < predicted.length; ++c) {
			if (contexts !== undefined) context = contexts[c];
			const { residual, length } = this.readResidual(c % 3, this.models.ROW[Math.min(c, 3)][context]);
			value[c] = predicted[c] + residual;
			if (context !== NO_NEIGHBOUR) context = following(context, length);
			longest = Math.max(longest, length);
		}
		return { value, L: longest };
	}

	unitResiduals(bundle, predicted, contextOf) {
		const { ROW, FOLLOWING } = this.models;
		return this.units.read(bundle.first, predicted, (i, c, follows) => {
			const row = follows ? FOLLOWING[i - 1] : ROW[i][contextOf(c)];
			return this.readResidual(i, row);
		});
	}

	// ---- [B.3.1] Parallelograms, means, diagonals

	predict(bundle, n, p) {
		const { state } = this;
		const { sum, count } = this.predictor === MEAN ? { count: 0 } : this.parallelograms(bundle);
		if (count !== 0) return sum.map((x) => Math.trunc(x / count) | 0);
		if (n !== NONE && p !== NONE) {
			const other = state.value(p);
			return [...state.value(n)].map((x, c) => Math.trunc((x + other[c]) / 2) | 0);
		}
		if (n !== NONE) return [...state.value(n)];
		return bundle.before !== NONE ? [...state.value(bundle.before)] : new Array(state.components).fill(0);
	}

	parallelograms(bundle) {
		const { state, wedges } = this;
		const { surface } = wedges;
		const values = (w) => [...state.value(w)];
		let sum = new Array(state.components).fill(0);
		let count = 0;
		let longest = -1;
		for (const h of bundle.halfEdges.slice(0, 8)) {
			const [n, p, o] = [surface.tail(next(h)), surface.tail(prev(h)), wedges.behind(h)];
			if (![n, p, o].every((w) => state.isCoded(w))) continue;
			if (this.predictor === DIAGONAL) {
				const l = wedges.squaredDistance(n, p);
				if (!(l > longest)) continue;
				longest = l;
				sum = sum.fill(0);
				count = 0;
			}
			const [vn, vp, vo] = [n, p, o].map(values);
			sum = sum.map((x, c) => x + vn[c] + vp[c] - vo[c]);
			++count;
		}
		return { sum, count };
	}
}

export function decodeValues(context, state) {
	new Values(context, state).decode();
}
