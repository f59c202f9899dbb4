// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Stitching: A.5 of the specification. Vertices that are one point of the source become one group.

import { fail } from './bytes.mjs';
import { golombs, models } from './entropy.mjs';
import { NONE, prev } from './mesh.mjs';

const OUT = 0, INNER = 1, IN = 2;

// [A.5.1]
export class StitchModels {
	constructor() {
		this.COPY = models([2, 16]);
		this.CANDIDATE = models([4, 16]);
		this.IS_NEAR = models([]);
		this.NEAR = models([8]);
		this.FAR = golombs([]);
	}
}

class Stitching {
	constructor(streams, modelSet, piece, surface) {
		this.streams = streams;
		this.models = modelSet;
		this.interiorCopies = piece.flags.INTERIOR_COPIES;
		this.surface = surface;
		this.vertexCount = piece.vertexCount;
		this.start = this.findStarts();
		this.leader = new Int32Array(this.vertexCount).fill(NONE);
		this.copies = Array.from({ length: this.vertexCount }, () => []); // of each leader
		this.glued = new Uint8Array(this.vertexCount);
		this.lastFar = 0;
	}

	// [A.5.1]
	findStarts() {
		const { surface } = this;
		const start = new Int32Array(this.vertexCount).fill(NONE);
		for (let h = 0; h < surface.halfEdgeCount; ++h) {
			const v = surface.tail(h);
			if (surface.twin(h) === NONE || start[v] === NONE || surface.twin(start[v]) !== NONE) start[v] = h;
		}
		if (start.includes(NONE)) fail('BadConnectivity', 'A.5.1', 'a vertex without a face');
		return start;
	}

	isOnBoundary(v) {
		return this.surface.twin(this.start[v]) === NONE;
	}

	isDone(v) {
		return this.leader[v] !== NONE;
	}

	// The neighbours of v with their sides.
	* ring(v) {
		const { surface } = this;
		let h = this.start[v];
		yield { u: surface.head(h), side: surface.twin(h) === NONE ? OUT : INNER };
		for (;;) {
			const last = prev(h);
			h = surface.twin(last);
			if (h === NONE) {
				yield { u: surface.tail(last), side: IN };
				return;
			}
			if (h === this.start[v]) return;
			yield { u: surface.head(h), side: INNER };
		}
	}

	decode() {
		for (let v = 0; v < this.vertexCount; ++v) {
			if (this.interiorCopies || this.isOnBoundary(v)) this.vertex(v);
		}
		return this.numberGroups();
	}

	vertex(v) {
		this.asked = new Set(); // leaders
		this.candidates = new Map(); // leader to score
		if (this.glued[v]) this.collectCandidates(v);
		const best = Math.max(0, ...this.candidates.values());
		if (!this.streams.bit(this.models.COPY[this.isOnBoundary(v) ? 1 : 0][Math.min(best, 15)])) {
			this.leader[v] = v;
			return;
		}
		const w = this.findLeader(v);
		if (this.copies[w].length === 0) this.markNeighbours(w);
		this.markNeighbours(v);
		this.leader[v] = w;
		this.copies[w].push(v);
	}

	// The members of the group with the leader w: first w, then the others, the latest first.
	* members(w) {
		yield w;
		for (let i = this.copies[w].length; i-- !== 0;) yield this.copies[w][i];
	}

	markNeighbours(v) {
		for (const { u } of this.ring(v)) this.glued[u] = 1;
	}

	// The groups in the order of their leaders; every vertex that is not done is a group of its own.
	numberGroups() {
		const { leader, start, surface } = this;
		const number = new Int32Array(this.vertexCount);
		const umbrellas = [];
		for (let v = 0; v < this.vertexCount; ++v) {
			if (!this.isDone(v)) leader[v] = v;
			if (leader[v] !== v) continue;
			number[v] = umbrellas.length;
			umbrellas.push([...this.members(v)].map((u) => start[u]));
		}
		return { surface: surface.withTails(surface.tails.map((v) => number[leader[v]])), umbrellas };
	}

	// ---- [A.5.2] Candidates

	collectCandidates(v) {
		for (const { u } of this.ring(v)) {
			if (this.isDone(u)) this.asked.add(this.leader[u]);
		}
		let work = 0;
		for (const { u, side } of this.ring(v)) {
			const first = this.leader[u];
			if (first === NONE || this.copies[first].length === 0) continue;
			for (const u2 of this.members(first)) {
				if (u2 === u) continue;
				for (const { u: w, side: other } of this.ring(u2)) {
					if (work === 64) return;
					++work;
					if (this.isDone(w)) this.addCandidate(this.leader[w], scoreOfSides(side, other));
				}
			}
		}
	}

	addCandidate(w, score) {
		if (!this.asked.has(w)) this.candidates.set(w, (this.candidates.get(w) ?? 0) + score);
	}

	// ---- [A.5.3] Which group?

	findLeader(v) {
		const candidate = this.askCandidates();
		if (candidate !== NONE) return candidate;
		return this.streams.bit(this.models.IS_NEAR) ? this.nearLeader(v) : this.farLeader();
	}

	askCandidates() {
		const list = [...this.candidates].map(([w, score]) => ({ w, score }));
		for (let i = 0; i < list.length; ++i) {
			let k = i;
			for (let j = i + 1; j < list.length; ++j) {
				if (list[j].score > list[k].score) k = j;
			}
			[list[i], list[k]] = [list[k], list[i]];
			const { w, score } = list[i];
			if (this.streams.bit(this.models.CANDIDATE[Math.min(i, 3)][Math.min(score, 15)])) return w;
			this.asked.add(w);
		}
		return NONE;
	}

	nearLeader(v) {
		const list = this.leadersNear(v);
		if (list.length === 0) fail('BadStitch', 'A.5.3', 'no group is near');
		for (let i = 0; i < list.length - 1; ++i) {
			if (this.streams.bit(this.models.NEAR[Math.min(i, 7)])) return list[i];
		}
		return list[list.length - 1];
	}

	// The leaders of the vertices around v, breadth first, except its neighbours' and those that were asked for.
	leadersNear(v) {
		const around = new Set([v]); // in the order in which they are added, also while one walks over it
		let work = 0;
		let neighbours = 0;
		for (const x of around) {
			for (const { u: w } of this.ring(x)) {
				if (work === 288) break;
				++work;
				around.add(w);
			}
			if (x === v) neighbours = around.size - 1;
		}
		const list = [];
		[...around].slice(1).forEach((w, i) => {
			if (!this.isDone(w) || this.asked.has(this.leader[w])) return;
			this.asked.add(this.leader[w]);
			if (i >= neighbours) list.push(this.leader[w]);
		});
		return list;
	}

	farLeader() {
		const w = (this.lastFar + this.streams.signedGolomb(this.models.FAR)) >>> 0;
		if (w >= this.vertexCount || this.leader[w] !== w) fail('BadStitch', 'A.5.3', 'a group that does not exist');
		this.lastFar = w;
		return w;
	}
}

function scoreOfSides(side, other) {
	if (side === INNER || other === INNER) return 1;
	return side === other ? 6 : 5;
}

// The surface with groups at its corners, and the umbrellas of each group: `start` of its members.
export function stitch(streams, modelSet, piece, surface) {
	return new Stitching(streams, modelSet, piece, surface).decode();
}
