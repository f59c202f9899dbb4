// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Blends of four candidates: B.3.2 of the specification. Floats are binary32.

import { width } from './bytes.mjs';
import { next, NONE, prev } from './mesh.mjs';
import { f, min, round32 } from './vectors.mjs';

export class Blend {
	constructor(state) {
		this.state = state;
		this.wedges = state.wedges;
		this.surface = state.wedges.surface;
		// Q[(4 w + k) components + c]: the squared errors of candidate k at wedge w
		this.Q = new Float32Array(state.wedges.count * 4 * state.components);
	}

	applies({ hasEntry, n, p }) {
		return hasEntry && this.state.isCoded(n) && this.state.isCoded(p);
	}

	// Values relative to that of the origin.
	rel(w) {
		const value = this.state.value(w);
		const from = this.state.value(this.origin);
		return [...value].map((x, c) => f((x - from[c]) | 0));
	}

	Qat(w, k, c) {
		return (4 * w + k) * this.state.components + c;
	}

	predict(bundle) {
		this.origin = bundle.n;
		this.expected = Array.from({ length: 4 }, () => new Array(this.state.components).fill(0));
		this.N = 0;
		this.P = 0;
		this.a = NONE;
		this.edge = NONE;
		this.candidate = [];
		for (const h of bundle.halfEdges.slice(0, 8)) this.lookAt(h);
		this.finishCandidates();
		const perComponent = this.candidate[0].map((_, c) => this.component(c));
		return { predicted: perComponent.map((x) => x.predicted), contexts: perComponent.map((x) => x.context) };
	}

	lookAt(h) {
		const { surface, state, wedges } = this;
		const [v, n, p] = [h, next(h), prev(h)].map((g) => surface.tail(g));
		if (!state.isCoded(n) || !state.isCoded(p)) return;
		this.neighbour(n);
		this.neighbour(p);
		this.look(surface.twin(h), n, v);
		this.look(prev(h), p, v);
		const o = wedges.behind(h);
		if (!state.isCoded(o)) return;
		this.neighbour(o);
		const [rn, rp, ro] = [n, p, o].map((w) => this.rel(w));
		this.addParallelogram(rn.map((x, c) => f(f(x + rp[c]) - ro[c])), wedges.squaredDistance(n, p));
	}

	addParallelogram(s, l) {
		if (this.P === 0 || l > this.longest) {
			this.longest = l;
			this.candidate[0] = s;
		}
		this.candidate[1] = this.P === 0 ? s : this.candidate[1].map((x, c) => f(x + s[c]));
		++this.P;
	}

	neighbour(w) {
		for (let k = 0; k < 4; ++k) {
			this.expected[k] = this.expected[k].map((x, c) => f(x + this.Q[this.Qat(w, k, c)]));
		}
		++this.N;
	}

	look(g, w, v) {
		const l = this.wedges.squaredDistance(w, v);
		if (this.a !== NONE && !(l < this.shortest)) return;
		this.shortest = l;
		this.a = w;
		this.edge = this.wedges.leaves(g, w) ? g : NONE;
	}

	finishCandidates() {
		const { candidate } = this;
		candidate[3] = this.rel(this.a);
		const b = this.oppositeOfV();
		if (b !== NONE) {
			this.neighbour(b);
			const rb = this.rel(b);
			candidate[2] = candidate[3].map((x, c) => f(f(x + x) - rb[c]));
		} else {
			candidate[2] = candidate[3];
		}
		if (this.P === 0) {
			candidate[0] = candidate[3];
			candidate[1] = candidate[3];
		} else {
			const share = f(1 / this.P);
			candidate[1] = candidate[1].map((x) => f(x * share));
		}
	}

	// b: three edges further around a
	oppositeOfV() {
		let r = this.edge;
		for (let i = 0; i < 3; ++i) {
			if (r === NONE) return NONE;
			r = this.surface.ccw(r);
			if (!this.wedges.leaves(r, this.a)) return NONE;
		}
		const b = this.surface.head(r);
		return this.state.isCoded(b) ? b : NONE;
	}

	component(c) {
		const share = f(1 / this.N);
		let W = 0;
		let V = 0;
		let E = 0;
		for (let k = 0; k < 4; ++k) {
			const e = f(f(this.expected[k][c] * share) + 1);
			const w = f(1 / f(e * e));
			W = f(W + w);
			V = f(V + f(w * this.candidate[k][c]));
			E = f(E + f(w * e));
		}
		const i = f(1 / W);
		V = f(V * i);
		E = f(E * i);
		const delta = Math.abs(V) < 2e9 ? round32(V) : 0;
		const x = width(Math.trunc(f(min(E, 1e9) * 4)));
		const context = x < 10 ? Math.max(x - 3, 0) : Math.min(7 + Math.floor((x - 10) / 4), 10);
		return { predicted: (this.state.value(this.origin)[c] + delta) | 0, context };
	}

	// Once the value is known, which all members of the bundle get.
	learn({ members }, value) {
		const from = this.state.value(this.origin);
		for (let k = 0; k < 4; ++k) {
			for (let c = 0; c < value.length; ++c) {
				const d = f(f((value[c] - from[c]) | 0) - this.candidate[k][c]);
				for (const w of members) this.Q[this.Qat(w, k, c)] = min(f(d * d), f(1e12));
			}
		}
	}
}
