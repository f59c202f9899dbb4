// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Stitching: A.5 of the specification. Vertices that are one point of the source become one group.

import { fail, unzigzag } from './bytes.mjs';
import { BinaryModel, golombs, models, trees, update } from './entropy.mjs';
import { NONE, prev } from './mesh.mjs';

const OUT = 0, INNER = 1, IN = 2;

// [A.5.2]
export class StitchModels {
	constructor() {
		this.COPY = models([2, 4, 20]);
		this.COPY_SHAPE = models([2, 4, 1024]);
		this.CANDIDATE = models([12, 16, 2, 2]);
		this.ON_LOOP = models([64]);
		this.LOOP_STEP = models([17, 4]);
		this.NEAR_RING = models([3, 8]);
		this.NEAR_PLACE = models([3, 15]);
		this.IS_RECENT = models([]);
		this.SAME_CLASS = models([2]);
		this.RECENT = golombs([]);
		this.FAR = trees(6, [2]);
	}
}

// [A.5.1] Shape
class Shape {
	constructor(surface, vertexCount) {
		this.surface = surface;
		this.vertexCount = vertexCount;
		this.start = new Int32Array(vertexCount).fill(NONE);
		this.ahead = new Int32Array(vertexCount).fill(NONE);
		this.behind = new Int32Array(vertexCount).fill(NONE);
		this.findStarts();
		this.loop = this.findLoops();
		this.degree = this.findDegrees();
		this.highest = this.findHighest();
	}

	findStarts() {
		const { surface } = this;
		for (let h = 0; h < surface.halfEdgeCount; ++h) {
			const v = surface.tail(h);
			if (surface.twin(h) === NONE) {
				this.start[v] = h;
				this.ahead[v] = surface.head(h);
				this.behind[surface.head(h)] = v;
			} else if (this.ahead[v] === NONE) {
				this.start[v] = h;
			}
		}
		if (this.start.includes(NONE)) fail('BadConnectivity', 'A.5.1', 'a vertex without a face');
	}

	findLoops() {
		const loop = new Uint8Array(this.vertexCount);
		const visited = new Uint8Array(this.vertexCount);
		for (let v = 0; v < this.vertexCount; ++v) {
			if (!this.isOnBoundary(v) || visited[v]) continue;
			const walk = [];
			for (let u = v; u !== NONE && !visited[u]; u = this.ahead[u]) {
				visited[u] = 1;
				walk.push(u);
			}
			for (const u of walk) loop[u] = Math.min(walk.length, 63);
		}
		return loop;
	}

	findDegrees() {
		const degree = new Uint8Array(this.vertexCount);
		for (const v of this.surface.tails) degree[v] = Math.min(degree[v] + 1, 31);
		return degree;
	}

	isOnBoundary(v) {
		return this.ahead[v] !== NONE;
	}

	// The maximum of degree(head(h)) over all half-edges h that leave a vertex, for all vertices.
	findHighest() {
		const { surface } = this;
		const highest = new Uint8Array(this.vertexCount);
		for (let h = 0; h < surface.halfEdgeCount; ++h) {
			highest[surface.tail(h)] = Math.max(highest[surface.tail(h)], this.degree[surface.head(h)]);
		}
		return highest;
	}

	boundaryDegree(v) {
		let count = 0;
		for (let h = this.start[v]; h !== NONE && count < 15; h = this.surface.ccw(h)) ++count;
		return count;
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

	// The first 64 of the ring.
	* firstOfRing(v) {
		let count = 0;
		for (const neighbour of this.ring(v)) {
			if (count++ === 64) return;
			yield neighbour;
		}
	}
}

class Stitching {
	constructor(streams, modelSet, piece, surface) {
		this.streams = streams;
		this.models = modelSet;
		this.interiorCopies = piece.flags.INTERIOR_COPIES;
		this.surface = surface;
		this.shape = new Shape(surface, piece.vertexCount);
		this.vertexCount = piece.vertexCount;
		this.groupOf = new Int32Array(this.vertexCount).fill(NONE);
		this.members = []; // of each group
		this.used = []; // of each group
		this.place = []; // of each group, in founded
		this.founded = Array.from({ length: 64 }, () => []);
		this.time = 0;
		this.misses = 0;
		this.lastReference = 0;
		this.lastPlace = new Array(64).fill(0);
		this.recent = [];
		this.glued = new Uint8Array(this.vertexCount);
		this.nearGlued = new Uint8Array(this.vertexCount);
	}

	bit(model) {
		return this.streams.bit(model);
	}

	isDone(v) {
		return this.groupOf[v] !== NONE;
	}

	loopOf(g) {
		return this.shape.loop[this.members[g][0]];
	}

	// ---- [A.5.2] Is it a copy?

	decode() {
		for (let v = 0; v < this.vertexCount; ++v) {
			if (this.shape.isOnBoundary(v) || this.interiorCopies) this.vertex(v);
		}
		return this.numberGroups();
	}

	vertex(v) {
		this.excluded = new Set();
		this.collectCandidates(v);
		if (this.members.length === 0 || !this.isCopy(v)) {
			this.found(v);
			return;
		}
		const g = this.reference(v);
		this.noteUse(g);
		this.members[g].push(v);
		this.groupOf[v] = g;
		if (this.members[g].length === 2) this.markNeighbours(this.members[g][0]);
		this.markNeighbours(v);
	}

	found(v) {
		const list = this.founded[this.shape.loop[v]];
		this.groupOf[v] = this.members.length;
		this.place.push(list.length);
		list.push(this.members.length);
		this.members.push([v]);
		this.used.push(0);
	}

	isCopy(v) {
		const { shape } = this;
		const highestScore = Math.max(...this.candidates.values());
		const best = this.candidates.size === 0 ? 0 : 1 + Math.min(18, highestScore);
		const level = Math.min(3, Math.floor((best + 2) / 3));
		const e = shape.isOnBoundary(v) ? 1 : 0;
		const form = e === 1
			? 16 * shape.loop[v] + shape.boundaryDegree(v)
			: 16 * shape.highest[v] + Math.min(shape.degree[v], 15);
		return this.mixedBit(this.models.COPY[e][this.glued[v]][best], this.models.COPY_SHAPE[e][level][form]);
	}

	mixedBit(A, B) {
		const wa = Math.min(A.n + 1, 8);
		const wb = Math.min(B.n + 1, 8);
		const M = new BinaryModel();
		M.p = Math.floor((A.p * wa + B.p * wb) / (wa + wb));
		const outcome = this.bit(M);
		update(A, outcome);
		update(B, outcome);
		return outcome;
	}

	markNeighbours(v) {
		const { shape } = this;
		for (const { u } of shape.ring(v)) this.glued[u] = Math.min(this.glued[u] + 1, 3);
		if (!shape.isOnBoundary(v)) return;
		for (const step of [shape.ahead, shape.behind]) {
			let u = v;
			for (let i = 0; i < 4; ++i) {
				u = step[u];
				if (u === NONE) break;
				this.nearGlued[u] = 1;
			}
		}
	}

	noteUse(g) {
		this.used[g] = ++this.time;
		this.lastReference = g;
		this.lastPlace[this.loopOf(g)] = this.place[g];
		this.recent = [g, ...this.recent.filter((other) => other !== g)].slice(0, 16);
	}

	// The groups in the order of their leaders; every vertex that is not done is a group of its own.
	numberGroups() {
		const leaders = [];
		for (let v = 0; v < this.vertexCount; ++v) {
			if (!this.isDone(v)) this.found(v);
			if (this.members[this.groupOf[v]][0] === v) leaders.push(v);
		}
		const umbrellas = leaders.map((v) => this.members[this.groupOf[v]].map((u) => this.shape.start[u]));
		const numbers = new Int32Array(this.members.length);
		leaders.forEach((v, number) => { numbers[this.groupOf[v]] = number; });
		const groups = this.surface.tails.map((v) => numbers[this.groupOf[v]]);
		return { surface: this.surface.withTails(groups), umbrellas };
	}

	// ---- [A.5.3] Candidates

	multi(u) {
		return this.isDone(u) && this.members[this.groupOf[u]].length >= 2;
	}

	collectCandidates(v) {
		const { shape } = this;
		this.candidates = new Map(); // group to score
		this.work = 0;
		this.limit = Math.max(128 >> (this.misses >> 4), 8);
		if (this.glued[v] !== 0) {
			this.excludeRing(v);
			for (const { u, side } of shape.firstOfRing(v)) {
				if (this.multi(u)) this.lookAcross(u, side);
				if (this.work >= this.limit) break;
			}
		}
		if (this.nearGlued[v]) {
			for (const step of [shape.ahead, shape.behind]) this.lookAlong(v, step);
		}
	}

	excludeRing(v) {
		for (const { u } of this.shape.firstOfRing(v)) {
			if (this.isDone(u)) this.excluded.add(this.groupOf[u]);
		}
	}

	// At most 24 other members of the group of u, while there is work left.
	* otherMembers(u) {
		let seen = 0;
		for (const other of this.members[this.groupOf[u]]) {
			if (other === u) continue;
			if (seen === 24 || this.work >= this.limit) return;
			++seen;
			yield other;
		}
	}

	lookAcross(u, side) {
		for (const u2 of this.otherMembers(u)) {
			for (const { u: w, side: other } of this.shape.ring(u2)) {
				if (this.isDone(w)) this.addCandidate(this.groupOf[w], scoreOfSides(side, other));
				++this.work;
				if (this.work >= this.limit) break;
			}
		}
	}

	lookAlong(v, step) {
		let p = v;
		for (let hops = 1; hops <= 4; ++hops) {
			p = step[p];
			if (p === NONE) return;
			if (!this.multi(p)) continue;
			for (const p2 of this.otherMembers(p)) {
				if (this.shape.isOnBoundary(p2)) this.lookNear(p2, hops);
			}
			return;
		}
	}

	lookNear(p2, hops) {
		for (const step of [this.shape.ahead, this.shape.behind]) {
			let w = p2;
			for (let k = 1; k <= 4; ++k) {
				w = step[w];
				if (w === NONE) break;
				++this.work;
				if (!this.isDone(w) || (hops === 1 && k === 1)) continue;
				this.addCandidate(this.groupOf[w], Math.max(3 - Math.abs(k - hops), 1));
			}
		}
	}

	addCandidate(g, score) {
		if (this.candidates.has(g)) this.candidates.set(g, this.candidates.get(g) + score);
		else if (!this.excluded.has(g) && this.candidates.size < 64) this.candidates.set(g, score);
	}

	// ---- [A.5.4] Which group?

	// The first 13 candidates: by score, by used, by number, the greater first.
	orderedCandidates() {
		const list = [...this.candidates].map(([g, score]) => ({ g, score }));
		list.sort((a, b) => b.score - a.score || this.used[b.g] - this.used[a.g] || b.g - a.g);
		return list.slice(0, 13);
	}

	reference(v) {
		const candidate = this.askCandidates();
		if (candidate !== NONE) {
			this.misses = 0;
			return candidate;
		}
		this.misses = Math.min(this.misses + 1, 128);
		if (this.glued[v] === 0) this.excludeRing(v);
		const g = this.shape.isOnBoundary(v) ? this.onLoop(v) : this.nearby(v);
		if (g !== NONE) return g;
		if (this.recent.length !== 0 && this.bit(this.models.IS_RECENT)) return this.recentGroup();
		return this.anyGroup(v);
	}

	askCandidates() {
		const list = this.orderedCandidates();
		for (let i = 0; i < Math.min(list.length, 12); ++i) {
			const { g, score } = list[i];
			const tied = i + 1 < list.length && list[i + 1].score === score ? 1 : 0;
			const multi = this.members[g].length >= 2 ? 1 : 0;
			if (this.bit(this.models.CANDIDATE[i][Math.min(score, 15)][multi][tied])) return g;
			this.excluded.add(g);
		}
		return NONE;
	}

	recentGroup() {
		const rank = this.streams.golomb(this.models.RECENT);
		if (rank >= this.recent.length) fail('BadStitch', 'A.5.4', 'a recent group that does not exist');
		return this.recent[rank];
	}

	anyGroup(v) {
		const loopClass = this.shape.loop[v];
		const list = this.founded[loopClass];
		if (list.length !== 0 && this.bit(this.models.SAME_CLASS[Math.min(loopClass, 1)])) {
			return list[this.far(this.models.FAR[1], this.lastPlace[loopClass], list.length)];
		}
		return this.far(this.models.FAR[0], this.lastReference, this.members.length);
	}

	onLoop(v) {
		const { ahead, behind, loop } = this.shape;
		const places = [];
		let a = v;
		let b = v;
		for (let steps = 1; steps <= 16 && 2 * steps <= loop[v]; ++steps) {
			a = ahead[a];
			b = behind[b];
			if (a === NONE || b === NONE) break;
			for (const w of [a, b]) {
				if (this.claim(w)) places.push({ g: this.groupOf[w], steps });
			}
		}
		if (places.length === 0 || !this.bit(this.models.ON_LOOP[loop[v]])) return NONE;
		for (const { g, steps } of places.slice(0, -1)) {
			if (this.bit(this.models.LOOP_STEP[steps][Math.min(loop[v] - 2 * steps, 3)])) return g;
		}
		return places[places.length - 1].g;
	}

	// Whether w is in a group that is not excluded; it is from now on.
	claim(w) {
		if (!this.isDone(w) || this.excluded.has(this.groupOf[w])) return false;
		this.excluded.add(this.groupOf[w]);
		return true;
	}

	nearby(v) {
		const visited = new Set([v]);
		let frontier = [v];
		for (let distance = 1; distance <= 4 && frontier.length !== 0; ++distance) {
			frontier = this.nextFrontier(frontier, visited);
			if (distance === 1) continue;
			const eligible = frontier.filter((w) => this.claim(w)).map((w) => this.groupOf[w]);
			const n = eligible.length;
			if (n === 0 || !this.bit(this.models.NEAR_RING[distance - 2][Math.min(n, 8) - 1])) continue;
			return this.nearPlace(eligible, distance);
		}
		return NONE;
	}

	nextFrontier(frontier, visited) {
		const found = [];
		for (const x of frontier) {
			if (visited.size >= 96) break;
			for (const { u: w } of this.shape.firstOfRing(x)) {
				if (visited.has(w)) continue;
				visited.add(w);
				found.push(w);
			}
		}
		return found;
	}

	nearPlace(eligible, distance) {
		const n = eligible.length;
		for (let i = 0; i < n - 1; ++i) {
			if (this.bit(this.models.NEAR_PLACE[distance - 2][Math.min(n - i, 16) - 2])) return eligible[i];
		}
		return eligible[n - 1];
	}

	// A number below n, told by its distance from `last`, the shorter way around.
	far(M, last, n) {
		const length = this.streams.tree(M);
		if (length > 30) fail('BadStitch', 'A.5.4', 'a distance that is too long');
		const distance = length > 1 ? 2 ** (length - 1) + this.streams.raw(length - 1) : length;
		let i = (last + unzigzag(distance)) >>> 0;
		if (i >= n && i < 2 * n) i -= n;
		else if (i >= n) i = (i + n) >>> 0;
		if (i >= n) fail('BadStitch', 'A.5.4', 'a group that does not exist');
		return i;
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
