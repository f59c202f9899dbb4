// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Skins: A.10.14 of the specification. Tuples of four joints and four weights.

import { golombs, models, rows } from './entropy.mjs';
import { readByLength } from './lengths.mjs';
import { next, prev } from './mesh.mjs';
import { unitSum } from './methods.mjs';
import { bundles } from './wedges.mjs';

const NO_NEIGHBOUR = 11; // the context
const slots = [0, 1, 2, 3];

// By whether the set index is 0.
export class SkinModels {
	constructor() {
		this.sets = models([2], () => ({
			SAME: models([4, 4]),
			WEIGHTLESS: models([4, 5]),
			RANK: models([4, 6, 3]),
			IDLE: models([]),
			HAS_SUM: models([]),
			JOINT: golombs([]),
			WEIGHT: rows([3, 12]),
		}));
	}

	of(attribute) {
		return this.sets[attribute.set === 0 ? 1 : 0];
	}
}

const add = (a, b) => a + b;

class Skins {
	constructor(context, state, weightState) {
		this.streams = context.streams;
		this.models = context.models.skins.of(state.attribute);
		this.state = state; // of the joints
		this.weightState = weightState;
		this.wedges = state.wedges;
		this.sums = weightState.attribute.predictor;
		this.unitSum = unitSum(weightState.attribute) ?? 0;
	}

	bit(model) {
		return this.streams.bit(model);
	}

	decode() {
		for (const bundle of bundles(this.wedges, this.state.bundleOf)) {
			const { joints, weights, L } = this.tuple(bundle);
			this.state.finish(bundle, joints, L);
			this.weightState.finish(bundle, weights, L);
		}
	}

	tuple(bundle) {
		const neighbours = this.neighbours(bundle);
		return this.sameTuple(neighbours) ?? this.newTuple(neighbours);
	}

	tupleOf(w) {
		return { joints: this.state.value(w).slice(), weights: this.weightState.value(w).slice() };
	}

	// ---- Neighbours: { joints, weights, L, shared }

	neighbours(bundle) {
		const { surface } = this.wedges;
		const list = [];
		const ask = (h) => [next(h), prev(h)].forEach((g) => this.addCandidate(list, surface.tail(g)));
		bundle.halfEdges.slice(0, 3).forEach(ask);
		if (list.length === 0 && !bundle.isolated) {
			for (const h of this.wedges.run(bundle.first)) {
				if (list.length === 0) ask(h);
			}
		}
		if (list.length === 0) this.addCandidate(list, bundle.before);
		return list;
	}

	addCandidate(list, w) {
		if (!this.state.isCoded(w)) return;
		const { joints, weights } = this.tupleOf(w);
		const equal = list.find((other) => slots.every((k) => other.joints[k] === joints[k] && other.weights[k] === weights[k]));
		if (equal !== undefined) ++equal.shared;
		else if (list.length < 4) list.push({ joints, weights, L: this.state.L[w], shared: 0 });
	}

	sameTuple(neighbours) {
		for (let i = 0; i < neighbours.length; ++i) {
			const { joints, weights, shared } = neighbours[i];
			if (this.bit(this.models.SAME[i][Math.min(shared, 3)])) return { joints, weights, L: 0 };
		}
		return undefined;
	}

	// ---- A tuple of its own

	newTuple(neighbours) {
		const joints = this.readJoints(neighbours);
		return { joints: joints.joint, ...this.readWeights(neighbours, joints) };
	}

	// The entries { joint, count, weight } of joints that neighbours have with weight, in the order they are asked in.
	jointEntries(neighbours) {
		const entries = [];
		for (const { joints, weights, shared } of neighbours) {
			const u = 1 + shared;
			for (const k of slots.filter((slot) => weights[slot] !== 0)) {
				let entry = entries.find(({ joint }) => joint === joints[k]);
				if (entry === undefined) {
					entry = { joint: joints[k], count: 0, weight: 0 };
					entries.push(entry);
				}
				entry.count += u;
				entry.weight += weights[k] * u;
			}
		}
		return entries;
	}

	readJoints(neighbours) {
		const N = neighbours.length;
		const entries = this.jointEntries(neighbours);
		const uses = neighbours.map(({ shared }) => 1 + shared).reduce(add, 0);
		const typical = Math.trunc(entries.map(({ weight }) => weight).reduce(add, 0) / (8 * Math.max(uses, 1)));
		const m = this.typicalWeightCount(neighbours);
		const result = { joint: [0, 0, 0, 0], expected: [0, 0, 0, 0], weightless: [0, 0, 0, 0] };
		for (const k of slots) {
			result.weightless[k] = this.bit(this.models.WEIGHTLESS[k][m]);
			if (result.weightless[k]) {
				result.joint[k] = this.bit(this.models.IDLE) ? 0 : this.readJoint();
				continue;
			}
			const entry = this.readRank(entries, k, uses, N === 0 ? undefined : neighbours[0]);
			result.expected[k] = entry !== undefined ? Math.trunc(entry.weight / entry.count) : typical;
			result.joint[k] = entry !== undefined ? entry.joint : this.readJoint();
		}
		return result;
	}

	typicalWeightCount(neighbours) {
		const N = neighbours.length;
		if (N === 0) return 0;
		const m = neighbours.map(({ weights }) => weights.filter((x) => x !== 0).length).reduce(add, 0);
		return Math.floor((m + (N >> 1)) / N);
	}

	// The entry whose joint slot k has, if it is one of the first six that are left.
	readRank(entries, k, uses, neighbour) {
		const left = entries.filter((entry) => !entry.taken);
		for (let r = 0; r < Math.min(left.length, 6); ++r) {
			const entry = left[r];
			const kind = neighbour.joints[k] === entry.joint ? 0 : entry.count === uses ? 1 : 2;
			if (this.bit(this.models.RANK[k][r][kind])) {
				entry.taken = true;
				return entry;
			}
		}
		return undefined;
	}

	readJoint() {
		return this.streams.golomb(this.models.JOINT) | 0;
	}

	readWeights(neighbours, { expected, weightless }) {
		const context = this.weightContext(neighbours);
		const sum = this.readSum();
		const weights = [0, 0, 0, 0];
		const lastSlot = weightless.lastIndexOf(0);
		let rest = sum;
		let longest = 0;
		for (const k of slots.filter((slot) => !weightless[slot])) {
			if (sum !== 0 && k === lastSlot) {
				weights[k] = rest | 0;
				continue;
			}
			const c = k === 0 || context === NO_NEIGHBOUR ? context : Math.floor((context + longest + 1) / 2);
			const { residual, length } = readByLength(this.streams, 0, this.models.WEIGHT[Math.min(k, 2)][c]);
			weights[k] = (expected[k] + residual) | 0;
			longest = Math.max(longest, length);
			rest -= weights[k];
		}
		return { weights, L: longest };
	}

	weightContext(neighbours) {
		const N = neighbours.length;
		if (N === 0) return NO_NEIGHBOUR;
		return Math.min(Math.floor((neighbours.map(({ L }) => L).reduce(add, 0) + (N >> 1)) / N), 10);
	}

	readSum() {
		if (this.sums === 1) return this.unitSum;
		return this.sums === 2 && this.unitSum !== 0 && this.bit(this.models.HAS_SUM) ? this.unitSum : 0;
	}
}

export function decodeSkins(context, state, weightState) {
	new Skins(context, state, weightState).decode();
}
