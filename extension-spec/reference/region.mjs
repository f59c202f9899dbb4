// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The order of the groups and their fans: A.6.1 of the specification.

import { fail } from './bytes.mjs';
import { next, NONE, prev } from './mesh.mjs';

const KNOWN = 4; // the state of a group that is known; the others are its scores, 0 .. 3

// In a piece without attributes the groups are in the order of their first corners. [A.6]
export function orderOfFirstCorners(surface, groupCount) {
	const seen = new Uint8Array(groupCount);
	const sequence = [];
	for (let h = 0; h < surface.halfEdgeCount; ++h) {
		if (!seen[surface.tail(h)]) sequence.push(h);
		seen[surface.tail(h)] = 1;
	}
	return sequence;
}

// The region of known groups. `coder` has two functions, which read the position of a group: codeSeed(v, neighbour) and
// codeFan(fan).
export class Region {
	constructor(surface, groupCount, { umbrellas, corners }, coder) {
		this.surface = surface;
		this.groupCount = groupCount;
		this.umbrellas = umbrellas; // none in a piece without copies
		this.corners = corners; // in a piece with pivots
		this.coder = coder;
		this.state = new Uint8Array(groupCount);
		this.queues = [undefined, newQueue(), newQueue(), newQueue()];
		this.sequence = [];
		this.cursor = 0;
	}

	isKnown(v) {
		return this.state[v] === KNOWN;
	}

	tailIsKnown(h) {
		return this.isKnown(this.surface.tail(h));
	}

	order() {
		while (this.sequence.length < this.groupCount) {
			this.seed();
			this.grow();
		}
		return this.sequence;
	}

	push(h) {
		const v = this.surface.tail(h);
		if (this.state[v] < 3) ++this.state[v];
		this.queues[this.state[v]].entries.push(h);
	}

	enter(h) {
		this.state[this.surface.tail(h)] = KNOWN;
		this.sequence.push(h);
	}

	// ---- seed()

	seed() {
		const corners = this.nextFaceWithUnknown();
		const unknown = corners.filter((h) => !this.tailIsKnown(h));
		let c = 3 - unknown.length;
		if (c === 2) {
			for (const h of unknown) this.push(h);
			return;
		}
		for (const h of corners) {
			if (c >= 2) break;
			if (this.tailIsKnown(h)) continue;
			this.coder.codeSeed(this.surface.tail(h), this.seedNeighbour(h));
			this.enter(h);
			this.pushRing(h);
			this.pushOthers(h);
			++c;
		}
	}

	nextFaceWithUnknown() {
		for (;;) {
			if (this.cursor === this.surface.faceCount) fail('BadConnectivity', 'A.6.1', 'a group without a face');
			const corners = [0, 1, 2].map((k) => 3 * this.cursor + k);
			if (!corners.every((h) => this.tailIsKnown(h))) return corners;
			++this.cursor;
		}
	}

	seedNeighbour(h) {
		if (this.tailIsKnown(prev(h))) return this.surface.tail(prev(h));
		if (this.tailIsKnown(next(h))) return this.surface.tail(next(h));
		return NONE;
	}

	// ---- grow()

	grow() {
		for (let queue = this.fullQueue(); queue !== undefined; queue = this.fullQueue()) {
			const h = queue.entries[queue.first++];
			const v = this.surface.tail(h);
			if (this.isKnown(v) || this.queues[this.state[v]] !== queue) continue;
			const fan = this.fan(h);
			this.coder.codeFan(fan);
			this.enter(h);
			this.pushOthers(h);
		}
	}

	fullQueue() {
		return [this.queues[3], this.queues[2], this.queues[1]].find((queue) => queue.first < queue.entries.length);
	}

	// ---- pushRing() and pushOthers()

	// h0, ccw(h0), … and, unless that comes back to h0, cw(h0), …
	* ringOf(h0) {
		let h = h0;
		do {
			yield h;
			h = this.surface.ccw(h);
		} while (h !== NONE && h !== h0);
		if (h === h0) return;
		for (h = this.surface.cw(h0); h !== NONE; h = this.surface.cw(h)) yield h;
	}

	pushRing(h0) {
		for (const h of this.ringOf(h0)) this.pushFace(h);
	}

	pushFace(h) {
		const nextIsKnown = this.tailIsKnown(next(h));
		if (nextIsKnown !== this.tailIsKnown(prev(h))) this.push(nextIsKnown ? prev(h) : next(h));
	}

	pushOthers(h) {
		const corners = this.corners?.[this.surface.tail(h)] ?? [];
		if (corners.length > 1) corners.forEach((g) => this.pushFace(g));
		if (this.umbrellas === undefined) return;
		const others = this.umbrellas[this.surface.tail(h)];
		if (others.length < 2) return;
		for (const u of others) {
			if (![...this.ringOf(u)].includes(h)) this.pushRing(u);
		}
	}

	// ---- The fan of h

	fan(h) {
		const { surface } = this;
		const run = [h];
		const closed = this.growCounterclockwise(run);
		if (!closed) this.growClockwise(run);
		const neighbours = run.map((g) => surface.tail(next(g)));
		if (!closed) neighbours.push(surface.tail(prev(run[run.length - 1])));
		const tips = run.map((g) => this.tip(next(g)));
		const plain = run.length === 2 && !closed && !tips.includes(NONE);
		return { v: surface.tail(h), halfEdges: run, closed, neighbours, tips, plain };
	}

	growCounterclockwise(run) {
		while (run.length <= 8) {
			const g = this.surface.ccw(run[run.length - 1]);
			if (g === NONE) return false;
			if (g === run[0]) return true;
			if (!this.tailIsKnown(prev(g))) {
				this.push(prev(g));
				return false;
			}
			run.push(g);
		}
		return false;
	}

	growClockwise(run) {
		for (let i = 0; i < 8; ++i) {
			const t = this.surface.twin(run[0]);
			if (t === NONE) return;
			if (!this.tailIsKnown(prev(t))) {
				this.push(prev(t));
				return;
			}
			const g = next(t);
			if (g === run[run.length - 1]) return;
			run.unshift(g);
		}
	}

	// The vertex beyond a half-edge, if there is one and it is known.
	tip(h) {
		const beyond = this.surface.across(h);
		return beyond !== NONE && this.tailIsKnown(beyond) ? this.surface.tail(beyond) : NONE;
	}
}

function newQueue() {
	return { entries: [], first: 0 };
}
