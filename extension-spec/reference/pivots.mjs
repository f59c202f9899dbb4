// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Faces vertex by vertex: A.4.7 of the specification.

import { fail } from './bytes.mjs';
import { golombs, models } from './entropy.mjs';
import { NONE, Surface } from './mesh.mjs';

export class PivotModels {
	constructor() {
		this.MORE = models([16, 3, 3]);
		this.IS_SPOKE = models([16, 3, 3]);
		this.IS_THIS = models([16, 3, 3, 2]);
		this.TURNED = models([3, 3, 2]);
		this.IS_NEAR = models([16]);
		this.IS_NEW = models([]);
		this.ANOTHER_FAN = models([]);
		this.SKIPPED = golombs([]);
		this.FAR = golombs([]);
	}
}

class Spoke {
	constructor(vertex) {
		this.vertex = vertex;
		this.faces = 0;
		this.leaving = []; // half-edges from the pivot that are open
		this.arriving = []; // half-edges to it
	}

	get faceClass() {
		return Math.min(this.faces, 15);
	}

	get balance() {
		if (this.leaving.length !== 0) return 1;
		return this.arriving.length !== 0 ? 2 : 0;
	}
}

class Pivots {
	constructor(streams, modelSet, piece) {
		this.streams = streams;
		this.models = modelSet;
		this.piece = piece;
		this.tails = new Int32Array(3 * piece.faceCount);
		this.twins = new Int32Array(3 * piece.faceCount).fill(NONE);
		this.faces = 0;
		this.known = 0; // vertices
		this.middle = Array.from({ length: piece.vertexCount }, () => []); // faces, the latest first
	}

	bit(model) {
		return this.streams.bit(model);
	}

	allFaces() {
		return this.faces === this.piece.faceCount;
	}

	decode() {
		for (let p = 0; p < this.piece.vertexCount; ++p) this.pivot(p);
		if (!this.allFaces()) fail('BadConnectivity', 'A.4.7', 'too few faces');
		const corners = Array.from({ length: this.piece.vertexCount }, () => []);
		this.tails.forEach((v, h) => corners[v].push(h));
		return { surface: new Surface(this.tails, this.twins), corners };
	}

	pivot(p) {
		const begins = p === this.known;
		if (begins) ++this.known;
		this.spokes = [];
		this.spokeOf = new Map();
		for (const f of this.middle[p]) this.meetFace(p, f);
		let row = 0;
		let forced = false;
		for (;;) {
			for (; row < this.spokes.length; ++row) {
				this.row(p, row, forced);
				forced = false;
			}
			if (this.allFaces()) break;
			forced = (begins && row === 0) || this.bit(this.models.ANOTHER_FAN) === 1;
			if (!forced) break;
			this.meet(p);
		}
		if (begins && row === 0) fail('BadConnectivity', 'A.4.7', 'a vertex without a face');
	}

	// A face of an earlier pivot of which p is the second vertex by number
	meetFace(p, f) {
		const leaves = this.tails[3 * f + 1] === p;
		const w = this.tails[3 * f + (leaves ? 2 : 1)];
		if (!this.spokeOf.has(w)) this.addSpoke(w);
		this.join(this.spokes[this.spokeOf.get(w)], 3 * f + 1, leaves);
	}

	addSpoke(vertex) {
		this.spokeOf.set(vertex, this.spokes.length);
		this.spokes.push(new Spoke(vertex));
		return this.spokes.length - 1;
	}

	row(p, row, forced) {
		const { models: m } = this;
		const first = this.spokes[row];
		let place = row + 1;
		for (let count = 0; !this.allFaces(); ++count) {
			const asks = !forced || count !== 0;
			const { balance } = first;
			if (asks && !this.bit(m.MORE[first.faceClass][balance][Math.min(count, 2)])) return;
			const last = place;
			place = this.other(p, row, last);
			const second = this.spokes[place];
			const again = count !== 0 && place === last ? 1 : 0;
			const turned = this.bit(m.TURNED[balance][second.balance][again]);
			this.addFace(p, turned ? second : first, turned ? first : second);
		}
	}

	other(p, row, from) {
		const { models: m, spokes } = this;
		const first = spokes[row];
		const { balance } = first;
		const fitting = balance === 0 ? 2 : Math.min(spokes.filter((s) => s.balance === 3 - balance).length, 2);
		const none = from === spokes.length || !this.bit(m.IS_SPOKE[first.faceClass][balance][fitting]);
		if (none) return this.near(p, first.vertex);
		let place = from;
		for (; place + 1 < spokes.length; ++place) {
			if (place - from === 32) return this.skip(place);
			const s = spokes[place];
			const again = place === from && from !== row + 1 ? 1 : 0;
			if (this.bit(m.IS_THIS[s.faceClass][balance][s.balance][again])) break;
		}
		return place;
	}

	skip(place) {
		const skipped = this.streams.golomb(this.models.SKIPPED);
		if (skipped >= this.spokes.length - place) fail('BadConnectivity', 'A.4.7', 'a vertex that the face cannot have');
		return place + skipped;
	}

	near(p, w) {
		let asked = 0;
		for (const f of this.middle[w].slice(0, 16)) {
			const v = this.tails[3 * f + (this.tails[3 * f + 1] === w ? 2 : 1)];
			if (this.spokeOf.has(v)) continue;
			if (this.bit(this.models.IS_NEAR[asked++])) return this.addSpoke(v);
		}
		return this.meet(p);
	}

	meet(p) {
		const old = this.known - p - 1;
		const mayBeNew = this.known !== this.piece.vertexCount;
		if (mayBeNew && (old === 0 || this.bit(this.models.IS_NEW))) return this.addSpoke(this.known++);
		const distance = this.streams.golomb(this.models.FAR);
		const vertex = this.known - 1 - distance;
		if (distance >= old || this.spokeOf.has(vertex)) fail('BadConnectivity', 'A.4.7', 'a vertex that the face cannot have');
		return this.addSpoke(vertex);
	}

	addFace(p, a, b) {
		const h = 3 * this.faces;
		this.tails.set([p, a.vertex, b.vertex], h);
		this.middle[Math.min(a.vertex, b.vertex)].unshift(this.faces);
		++this.faces;
		this.join(a, h, true);
		this.join(b, h + 2, false);
	}

	// With the latest open half-edge of the other direction
	join(spoke, h, leaves) {
		++spoke.faces;
		const others = leaves ? spoke.arriving : spoke.leaving;
		if (others.length === 0) {
			(leaves ? spoke.leaving : spoke.arriving).push(h);
			return;
		}
		const t = others.pop();
		this.twins[h] = t;
		this.twins[t] = h;
	}
}

// The surface of a piece with pivots, with vertices at its corners, which are groups; all half-edges that leave each group.
export function decodePivots(streams, modelSet, piece) {
	return new Pivots(streams, modelSet, piece).decode();
}
