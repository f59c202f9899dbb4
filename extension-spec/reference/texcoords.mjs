// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Texture coordinates: A.10.11 of the specification. Their prediction: A.10.11.

import { models, rows } from './entropy.mjs';
import { following, readByLength } from './lengths.mjs';
import { Memory, memoryModels } from './memories.mjs';
import { next, NONE, prev } from './mesh.mjs';
import { bundles } from './wedges.mjs';
import { dot32, f, max, round32, sqrt32, sub32 } from './vectors.mjs';

const NO_NEIGHBOUR = 11; // the context

// By whether the set index is 0.
export class TexcoordModels {
	constructor() {
		this.sets = models([2], () => ({ ROW: rows([2, 12]), KNOWN: memoryModels() }));
	}

	of(attribute) {
		return this.sets[attribute.set === 0 ? 1 : 0];
	}
}

const add = (a, b) => [f(a[0] + b[0]), f(a[1] + b[1])];
const difference = (a, b) => [f((a[0] - b[0]) | 0), f((a[1] - b[1]) | 0)]; // diff of A.10.11
const change = (u) => (Math.abs(u) < 1e9 ? round32(u) : 0);

class Texcoords {
	constructor(context, state) {
		const byte = state.attribute.predictor;
		this.streams = context.streams;
		this.models = context.models.texcoords.of(state.attribute);
		this.state = state;
		this.wedges = state.wedges;
		this.hinge = (byte & 1) !== 0;
		this.memory = byte & 2 ? new Memory(context.streams, this.models.KNOWN, state, (x) => x >>> 0) : undefined;
		this.side = 1;
		this.last = [0, 0];
	}

	decode() {
		for (const bundle of bundles(this.wedges, this.state.bundleOf)) this.bundle(bundle);
	}

	bundle(bundle) {
		const faces = this.faces(bundle);
		const { value, L } = this.known(faces) ?? this.coded(bundle, faces);
		this.last = value;
		this.state.finish(bundle, value, L);
		if (faces.length !== 0 && this.hinge) this.learnSide(faces[0], value);
		this.memory?.learnFaces(bundle.members);
	}

	coded(bundle, faces) {
		const { predicted, context } = faces.length !== 0 ? this.fromFaces(bundle, faces) : this.withoutFaces(bundle);
		const { pair, L } = this.readResiduals(context);
		return { value: predicted.map((x, k) => (x + pair[k]) | 0), L };
	}

	// What the memory knows, if a flag says so.
	known(faces) {
		if (this.memory === undefined || faces.length === 0) return undefined;
		const { n, p, o } = faces[0];
		this.memory.begin();
		const k = this.memory.ask(this.memory.edgeKey(n, p), o === n ? NONE : o);
		return k === NONE ? undefined : { value: [...this.state.value(k)], L: this.state.meanLength({ n, p }) };
	}

	// [A.10.11] Faces
	faces(bundle) {
		const { state, wedges } = this;
		const { surface } = wedges;
		const faces = [];
		for (const h of bundle.halfEdges) {
			const n = surface.tail(next(h));
			const p = surface.tail(prev(h));
			if (!state.isCoded(n) || !state.isCoded(p)) continue;
			const beyond = wedges.beyond(h);
			faces.push({ n, p, o: state.isCoded(beyond) ? beyond : n });
		}
		return faces.slice(0, 4);
	}

	fromFaces(bundle, faces) {
		const { n, p } = faces[0];
		const delta = this.hinge ? this.unfolded(bundle.first, faces) : this.diagonal(faces);
		const predicted = [...this.state.value(n)].map((x, k) => (x + change(delta[k])) | 0);
		return { predicted, context: this.state.meanLength({ n, p }) };
	}

	withoutFaces(bundle) {
		const n = bundle.isolated ? NONE : this.neighbourInRun(bundle.first);
		if (n === NONE) return { predicted: this.last, context: NO_NEIGHBOUR };
		return { predicted: [...this.state.value(n)], context: 10 };
	}

	neighbourInRun(w) {
		const { state, wedges } = this;
		for (const h of wedges.run(w)) {
			const [n, p] = [next(h), prev(h)].map((g) => wedges.surface.tail(g));
			if (state.isCoded(n)) return n;
			if (state.isCoded(p)) return p;
		}
		return NONE;
	}

	readResiduals(context) {
		const first = readByLength(this.streams, 0, this.models.ROW[0][context]);
		const secondContext = context === NO_NEIGHBOUR ? NO_NEIGHBOUR : following(context, first.length);
		const second = readByLength(this.streams, 1, this.models.ROW[1][secondContext]);
		return { pair: [first.residual, second.residual], L: Math.max(first.length, second.length) };
	}

	// ---- [A.10.11] Hinge

	unfolded(v, faces) {
		const R = faces.map((face) => this.faceTerm(v, face, this.state.value(faces[0].n)));
		const at = (i) => R[i] ?? [0, 0, 0];
		const [U, V, W] = [0, 1, 2].map((k) => f(f(at(0)[k] + at(1)[k]) + f(at(2)[k] + at(3)[k])));
		if (!(W > 0)) return [0, 0];
		const i = f(1 / W);
		return [f(U * i), f(V * i)];
	}

	faceTerm(v, { n, p, o }, origin) {
		const { positions } = this.wedges;
		const [un, up, uo] = [n, p, o].map((w) => this.state.value(w));
		const [e, d, g] = [p, v, o].map((w) => sub32(positions[w], positions[n]));
		const base = difference(un, origin);
		const ee = dot32(e, e);
		return ee > 0 ? this.unfoldedTerm(e, d, g, base, difference(up, un), difference(uo, un)) : [0, 0, 0];
	}

	// e, d, g: p, v and o relative to n; (du, dv) and (ou, ov): p and o relative to n in the chart
	unfoldedTerm(e, d, g, [x, y], [du, dv], [ou, ov]) {
		const inverse = f(1 / dot32(e, e));
		const ed = dot32(e, d);
		const s = f(ed * inverse);
		const height = max(f(dot32(d, d) - f(s * ed)), 0);
		const eg = dot32(e, g);
		const so = f(eg * inverse);
		const heightO = f(dot32(g, g) - f(so * eg));
		let away = this.similarity([du, dv], [ou, ov], f(height * inverse));
		let weight = 0.25;
		if (height < f(36 * heightO)) {
			const ratio2 = f(height / heightO);
			const ratio = sqrt32(ratio2);
			away = [f(ratio * f(f(so * du) - ou)), f(ratio * f(f(so * dv) - ov))];
			weight = f(1 / f(1 + ratio2));
		}
		return [
			f(weight * f(f(x + f(s * du)) + away[0])),
			f(weight * f(f(y + f(s * dv)) + away[1])),
			weight,
		];
	}

	similarity([du, dv], [ou, ov], square) {
		const turn = f(f(du * ov) - f(dv * ou));
		const side = turn > 0 ? -1 : turn < 0 ? 1 : this.side;
		const k = f(side * sqrt32(square));
		return [f(0 - f(k * dv)), f(k * du)];
	}

	learnSide({ n, p }, value) {
		const un = this.state.value(n);
		const a = difference(this.state.value(p), un);
		const b = difference(value, un);
		const turn = f(f(a[0] * b[1]) - f(a[1] * b[0]));
		if (turn > 0) this.side = 1;
		else if (turn < 0) this.side = -1;
	}

	// ---- [A.10.11] Diagonal

	diagonal(faces) {
		const value = (w) => this.state.value(w);
		let delta = [0, 0];
		let longest = -1;
		for (const { n, p, o } of faces) {
			if (o === n) continue;
			const l = this.wedges.squaredDistance(n, p);
			if (!(l > longest)) continue;
			longest = l;
			delta = add(difference(value(n), value(faces[0].n)), difference(value(p), value(o)));
		}
		return delta;
	}
}

export function decodeTexcoords(context, state) {
	new Texcoords(context, state).decode();
}
