// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Values of any number of components: A.10.4 of the specification. Their prediction: A.10.4.

import { models, rows } from './entropy.mjs';
import { following, readByLength } from './lengths.mjs';
import { next, NONE, prev } from './mesh.mjs';
import { bundles } from './wedges.mjs';

const NO_NEIGHBOUR = 11; // the context

// By semantic, by whether the set index is 0, by whether it is a morph target.
export class ValueModels {
	constructor() {
		this.sets = models([8, 2, 2], () => ({ ROW: rows([4, 12]), ZERO: models([4]), SAME: models([2, 3]) }));
	}

	of(attribute) {
		return this.sets[attribute.semantic][attribute.set === 0 ? 1 : 0][attribute.target !== 0 ? 1 : 0];
	}
}

class Values {
	constructor(context, state) {
		const { attribute } = state;
		const byte = attribute.predictor;
		this.streams = context.streams;
		this.state = state;
		this.wedges = state.wedges;
		this.models = context.models.values.of(attribute);
		this.hasFlags = (byte & 1) !== 0;
	}

	decode() {
		for (const bundle of bundles(this.wedges, this.state.bundleOf)) {
			const neighbours = this.neighbours(bundle);
			const { value, L } = this.flagged(neighbours) ?? this.coded(bundle, neighbours);
			this.state.finish(bundle, value, L);
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
	flagged({ n, p }) {
		if (!this.hasFlags) return undefined;
		if (this.streams.bit(this.zeroModel(n, p))) return { value: new Int32Array(this.state.components), L: 0 };
		return n === NONE ? undefined : this.flaggedSame(n, p);
	}

	zeroModel(n, p) {
		if (n === NONE) return this.models.ZERO[3];
		return this.models.ZERO[Number(this.isZero(n)) + Number(this.isZero(p === NONE ? n : p))];
	}

	flaggedSame(n, p) {
		const { streams, state } = this;
		const { SAME } = this.models;
		const k = p === NONE ? 2 : Number(this.areEqual(n, p));
		const valueOf = (w) => ({ value: state.value(w).slice(), L: 0 });
		if (!this.isZero(n) && streams.bit(SAME[0][k])) return valueOf(n);
		if (k === 0 && streams.bit(SAME[1][0])) return valueOf(p);
		return undefined;
	}

	// ---- Predictions and residuals

	coded(bundle, { n, p }) {
		const { L } = this.state;
		let context = n === NONE ? NO_NEIGHBOUR : Math.min(Math.floor((L[n] + L[p === NONE ? n : p] + 1) / 2), 10);
		const value = this.predict(bundle, n, p);
		let longest = 0;
		for (let c = 0; c < value.length; ++c) {
			const { residual, length } = readByLength(this.streams, c % 3, this.models.ROW[Math.min(c, 3)][context]);
			value[c] += residual;
			if (context !== NO_NEIGHBOUR) context = following(context, length);
			longest = Math.max(longest, length);
		}
		return { value, L: longest };
	}

	// ---- [A.10.4] The prediction, in integers that wrap

	predict(bundle, n, p) {
		const { state } = this;
		const diagonal = this.diagonal(bundle);
		if (diagonal !== undefined) {
			const [vn, vp, vo] = diagonal.map((w) => state.value(w));
			return vn.map((x, c) => x + vp[c] - vo[c]);
		}
		const from = n !== NONE ? n : bundle.before;
		if (from === NONE) return new Int32Array(state.components);
		const other = state.value(p === NONE ? from : p);
		return state.value(from).map((x, c) => x + Math.trunc(((other[c] - x) | 0) / 2));
	}

	// The wedges n, p and o of the longest diagonal, if there is one.
	diagonal(bundle) {
		const { state, wedges } = this;
		let longest = -1;
		let found;
		for (const h of bundle.halfEdges.slice(0, 8)) {
			const [n, p, o] = [wedges.surface.tail(next(h)), wedges.surface.tail(prev(h)), wedges.beyond(h)];
			if (![n, p, o].every((w) => state.isCoded(w))) continue;
			const l = wedges.squaredDistance(n, p);
			if (!(l > longest)) continue;
			longest = l;
			found = [n, p, o];
		}
		return found;
	}
}

export function decodeValues(context, state) {
	new Values(context, state).decode();
}
