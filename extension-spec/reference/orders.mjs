// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Orders of the triangles and of the wedges: A.9 of the specification.

import { fail } from './bytes.mjs';
import { models, trees, uniform } from './entropy.mjs';
import { corner, face, next, NONE, prev } from './mesh.mjs';

const NEAR = 0, FAR = 1, NEXT = 2, ANY = 3;
const CLOSED = -1; // the place in `open` of an element that is placed, or of none

class SequenceModels {
	constructor() {
		this.IS_NEXT = models([8, 4]);
		this.IS_NEAR = models([2, 4, 3]);
		this.IS_FAR = models([2, 4]);
		this.RANK = trees(5, [2, 4, 2]);
	}
}

export class OrderModels {
	constructor() {
		this.triangles = new SequenceModels();
		this.wedges = new SequenceModels();
		this.CORNER = models([4, 3, 2]);
	}
}

// [A.9.1] Sequences. `lists` is near and far: [element, note], latest first.
class Sequence {
	constructor(streams, modelSet, elementCount) {
		this.streams = streams;
		this.models = modelSet;
		this.open = [];
		this.placeInOpen = new Int32Array(elementCount).fill(CLOSED);
		this.lists = [[], []];
		this.history = 0;
		this.class = [0, 0];
		this.way = ANY;
	}

	// Begins with another list of expected elements.
	expect(list) {
		this.lists = [[], []];
		this.expected = list;
		this.cursor = 0;
		for (const x of list) {
			this.placeInOpen[x] = this.open.length;
			this.open.push(x);
		}
	}

	isOpen(x) {
		return this.placeInOpen[x] !== CLOSED;
	}

	place(x) {
		const i = this.placeInOpen[x];
		const last = this.open.pop();
		if (last !== x) {
			this.open[i] = last;
			this.placeInOpen[last] = i;
		}
		this.placeInOpen[x] = CLOSED;
		this.remove(NEAR, x);
		this.remove(FAR, x);
	}

	remove(way, x) {
		this.lists[way] = this.lists[way].filter(([y]) => y !== x);
	}

	putInFront(way, x, note) {
		this.lists[way].unshift([x, note]);
		if (this.lists[way].length > 32) this.lists[way].pop();
	}

	touchNear(x, note) {
		if (!this.isOpen(x)) return;
		this.remove(FAR, x);
		this.remove(NEAR, x);
		this.putInFront(NEAR, x, note);
	}

	touchFar(x, note) {
		if (!this.isOpen(x) || this.lists[NEAR].some(([y]) => y === x)) return;
		this.remove(FAR, x);
		this.putInFront(FAR, x, note);
	}

	firstExpected() {
		while (!this.isOpen(this.expected[this.cursor])) ++this.cursor;
		return this.expected[this.cursor];
	}

	following() {
		const { streams, models: m } = this;
		const expected = this.firstExpected();
		const w = this.way;
		const yes = streams.bit(m.IS_NEXT[this.history][w]);
		this.history = (2 * this.history + yes) % 8;
		const hopeful = this.history !== 0 ? 1 : 0;
		this.way = yes ? NEXT : this.askWay(hopeful, w);
		const [x, note] = this.element(expected, w);
		this.place(x);
		return { x, note, way: this.way };
	}

	askWay(hopeful, w) {
		const { streams, models: m } = this;
		const [near, far] = this.lists;
		if (near.length !== 0 && streams.bit(m.IS_NEAR[hopeful][w][Math.min(this.class[NEAR], 2)])) return NEAR;
		if (far.length !== 0 && streams.bit(m.IS_FAR[hopeful][w])) return FAR;
		return ANY;
	}

	element(expected, w) {
		if (this.way === NEXT) return [expected, 0];
		if (this.way === ANY) return [this.open[uniform(this.streams, this.open.length)], 0];
		return this.ranked(w);
	}

	ranked(w) {
		const list = this.lists[this.way];
		const rank = this.streams.tree(this.models.RANK[this.way][this.class[this.way]][w === this.way ? 1 : 0]);
		if (rank >= list.length) fail('BadAttribute', 'A.9.1', 'a rank beyond its list');
		this.class[this.way] = rank < 2 ? rank : rank < 4 ? 2 : 3;
		return list[rank];
	}
}

// [A.9.2] Order of the triangles: for each part a list of triangles, each of which has its wedges from the corner it begins with.
export function decodeTriangleOrder(streams, m, piece, surface, table) {
	const sequence = new Sequence(streams, m.triangles, table.length);
	const touch = new TriangleTouch(sequence, surface);
	let turn = 0;
	return partition(piece, table).map((expected) => {
		sequence.expect(expected);
		return expected.map(() => {
			const { x, note, way } = sequence.following();
			turn = readTurn(streams, m.CORNER[way][turn]);
			const begin = (note + turn) % 3;
			touch.around(x, begin);
			return rotated(table[x].wedges, begin);
		});
	});
}

function readTurn(streams, [IS_TURNED, IS_TWO]) {
	if (!streams.bit(IS_TURNED)) return 0;
	return streams.bit(IS_TWO) ? 2 : 1;
}

const rotated = (wedges, begin) => [0, 1, 2].map((k) => wedges[(begin + k) % 3]);

class TriangleTouch {
	constructor(sequence, surface) {
		this.sequence = sequence;
		this.surface = surface;
	}

	around(x, begin) {
		const { sequence, surface } = this;
		if (x >= surface.faceCount) return;
		for (let i = 0; i < 3; ++i) {
			const t = surface.twin(3 * x + (begin + i) % 3);
			if (t === NONE || !sequence.isOpen(face(t))) continue;
			for (const s of [next(t), prev(t)]) this.far(surface.twin(s));
			sequence.touchNear(face(t), corner(t));
		}
	}

	far(y) {
		if (y !== NONE) this.sequence.touchFar(face(y), corner(y));
	}
}

// The triangles of each part, by their numbers.
function partition(piece, table) {
	const lists = piece.partSizes.map(() => []);
	table.forEach(({ part }, x) => lists[part].push(x));
	return lists;
}

// [A.9.4] Without TRIANGLE_ORDER
export function trianglesOfParts(piece, table) {
	return partition(piece, table).map((list) => list.map((x) => table[x].wedges));
}

// [A.9.4]
export function checkParts(piece, parts) {
	if (parts.some((list, i) => list.length !== piece.partSizes[i])) {
		fail('BadAttribute', 'A.9.4', 'a part has another number of triangles than its header says');
	}
}

// [A.9.3] Order of the wedges: the wedge at every place. `parts` are ordered triangles, or undefined.
export function decodeWedgeOrder(streams, m, piece, table, parts) {
	const sequence = new Sequence(streams, m.wedges, piece.wedgeCount);
	const expected = expectedWedges(piece, parts);
	const corners = cornersOfWedges(piece, table);
	sequence.expect(expected);
	return expected.map(() => {
		const { x } = sequence.following();
		for (const { triangle, k } of corners[x]) touchWedges(sequence, table[triangle].wedges, k);
		return x;
	});
}

function expectedWedges(piece, parts) {
	const order = new Set(parts === undefined ? [] : parts.flat(2));
	for (let w = 0; w < piece.wedgeCount; ++w) order.add(w);
	return [...order];
}

// The first 32 corners of each wedge in the table.
function cornersOfWedges(piece, table) {
	const corners = Array.from({ length: piece.wedgeCount }, () => []);
	table.forEach(({ wedges }, triangle) => wedges.forEach((w, k) => {
		if (corners[w].length < 32) corners[w].push({ triangle, k });
	}));
	return corners;
}

function touchWedges(sequence, wedges, k) {
	const [a, b] = [wedges[(k + 1) % 3], wedges[(k + 2) % 3]];
	const touch = sequence.isOpen(a) && sequence.isOpen(b) ? 'touchFar' : 'touchNear';
	sequence[touch](b, 0);
	sequence[touch](a, 0);
}
