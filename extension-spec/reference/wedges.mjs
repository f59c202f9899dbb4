// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Wedges, their order, and bundles of wedges with equal values: A.10.1 and A.10.3 of the specification.

import { models } from './entropy.mjs';
import { exactPositions } from './faces.mjs';
import { next, NONE, prev } from './mesh.mjs';
import { dot32, sub32 } from './vectors.mjs';

// The wedges of a piece. The isolated ones come after those on the surface.
export class Wedges {
	constructor({ piece, groupCount, wedges, positions }) {
		this.surface = wedges.surface;
		this.crease = wedges.crease ?? new Uint8Array(this.surface.halfEdgeCount);
		this.hasSeams = piece.flags.SEAMS;
		this.count = piece.wedgeCount;
		this.surfaceCount = piece.wedgeCount - piece.isolatedCount;
		this.groupCount = groupCount;
		this.groupOf = wedges.groupOf;
		this.starts = wedges.starts;
		this.rank = this.findRanks(positions.sequence);
		this.completed = this.findCompleted();
		this.integers = positions.positions;
		this.positions = this.perWedge(positions.seen);
		this.exactPositions = this.perWedge(exactPositions(piece.attributes[0], positions.positions));
	}

	// [A.10.1] The places of the wedges on the surface in their coding order
	findRanks(sequence) {
		const rank = new Uint32Array(this.surfaceCount);
		if (this.hasSeams) return rank.map((_, w) => w);
		sequence.forEach((h, i) => { rank[this.surface.tail(h)] = i; });
		return rank;
	}

	// [A.10.1] The half-edges that each wedge completes
	findCompleted() {
		const completed = Array.from({ length: this.count }, () => []);
		for (let f = 0; f < this.surface.faceCount; ++f) {
			let last = 3 * f;
			for (const h of [3 * f + 1, 3 * f + 2]) {
				if (this.rank[this.surface.tail(h)] > this.rank[this.surface.tail(last)]) last = h;
			}
			completed[this.surface.tail(last)].push(last);
		}
		return completed;
	}

	isOnSurface(w) {
		return w < this.surfaceCount;
	}

	// The record of a wedge's position: of its group, or after those of all groups.
	recordOf(w) {
		return this.isOnSurface(w) ? this.groupOf[w] : this.groupCount + w - this.surfaceCount;
	}

	perWedge(ofRecords) {
		return Array.from({ length: this.count }, (_, w) => ofRecords[this.recordOf(w)]);
	}

	// [A.6.13] D(a, b)
	squaredDistance(a, b) {
		const d = sub32(this.positions[b], this.positions[a]);
		return dot32(d, d);
	}

	// [A.10.1] All wedges in the order in which they are coded
	codingOrder() {
		const order = new Array(this.count);
		for (let w = 0; w < this.count; ++w) order[this.isOnSurface(w) ? this.rank[w] : w] = w;
		return order;
	}

	// [A.10.1] The run of a wedge on the surface
	run(w) {
		const { surface } = this;
		const list = [this.starts[w]];
		let h = surface.ccw(list[0]);
		for (; this.leaves(h, w) && h !== list[0] && list.length < 16; h = surface.ccw(h)) list.push(h);
		if (h === list[0]) return list;
		for (h = surface.cw(list[0]); this.leaves(h, w) && list.length < 16; h = surface.cw(h)) list.push(h);
		return list;
	}

	leaves(h, w) {
		return h !== NONE && this.surface.tail(h) === w;
	}

	// The wedge beyond the edge opposite to the corner of h, if the face there has the same wedges at that edge; else NONE.
	beyond(h) {
		const { surface } = this;
		const t = surface.twin(next(h));
		if (t === NONE || surface.tail(t) !== surface.tail(prev(h)) || surface.tail(next(t)) !== surface.tail(next(h))) return NONE;
		return surface.tail(prev(t));
	}
}

// ---- [A.10.3] Equal values

export class EqualityModels {
	constructor() {
		this.PREVIOUS = models([8, 4, 3, 4]);
		this.FIRST = models([8, 4]);
	}
}

// The members of the bundle of each wedge, ascending; bundles share an array.
export function readBundles(streams, m, wedges, attribute) {
	const bundleOf = Array.from({ length: wedges.count }, (_, w) => [w]);
	const equal = (attribute.predictor & 128) !== 0 && wedges.hasSeams;
	if (equal) new EqualityReader(streams, m, wedges, attribute.semantic, bundleOf).read();
	return bundleOf;
}

class EqualityReader {
	constructor(streams, m, wedges, semantic, bundleOf) {
		this.streams = streams;
		this.PREVIOUS = m.PREVIOUS[semantic];
		this.FIRST = m.FIRST[semantic];
		this.wedges = wedges;
		this.bundleOf = bundleOf;
	}

	read() {
		const { groupOf, surfaceCount } = this.wedges;
		let lead = 0;
		let answer = 0;
		for (let w = 0; w < surfaceCount; ++w) {
			if (w === 0 || groupOf[w] !== groupOf[w - 1]) {
				lead = w;
				answer = 0;
			} else {
				answer = this.wedge(w, lead, answer);
			}
		}
	}

	// The answer for a wedge that is not the first of its group.
	wedge(w, lead, answer) {
		const h = this.wedges.starts[w];
		const other = this.otherEnd(h, w);
		if (this.streams.bit(this.PREVIOUS[other][answer][this.wedges.crease[h]])) {
			this.join(w, w - 1);
			return 2;
		}
		if (this.bundleOf[w - 1] !== this.bundleOf[lead] && this.streams.bit(this.FIRST[other])) this.join(w, lead);
		return 1;
	}

	otherEnd(h, w) {
		const { surface } = this.wedges;
		const t = surface.twin(h);
		if (t === NONE) return 0;
		const a = surface.head(h);
		const b = surface.tail(t);
		if (a >= w || b >= w) return 0;
		if (a === b) return 1;
		return this.bundleOf[a] === this.bundleOf[b] ? 2 : 3;
	}

	join(w, other) {
		this.bundleOf[other].push(w);
		this.bundleOf[w] = this.bundleOf[other];
	}
}

// ---- [A.10.1] Bundles

// The bundles in the order in which they are coded: members, first, halfEdges (those it completes), n and p (its neighbours;
// NONE without an entry), before (the first wedge of the bundle before, or NONE).
export function* bundles(wedges, bundleOf) {
	let before = NONE;
	for (const first of wedges.codingOrder()) {
		const members = bundleOf[first];
		if (members[0] !== first) continue;
		const halfEdges = members.flatMap((w) => wedges.completed[w]);
		const hasEntry = halfEdges.length !== 0;
		const n = hasEntry ? wedges.surface.tail(next(halfEdges[0])) : NONE;
		const p = hasEntry ? wedges.surface.tail(prev(halfEdges[0])) : NONE;
		yield { members, first, halfEdges, hasEntry, n, p, before, isolated: !wedges.isOnSurface(first) };
		before = first;
	}
}
