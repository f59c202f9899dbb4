// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Seams: A.7 of the specification. The corners of a group become wedges.

import { fail } from './bytes.mjs';
import { golombs, models } from './entropy.mjs';
import { face, NONE } from './mesh.mjs';
import { cross32, dot32, f, scale32, sqrt32, sub32 } from './vectors.mjs';

// [A.7.1]
export class SeamModels {
	constructor() {
		this.HAS_SEAM = models([4, 2, 4]);
		this.EDGE = models([3, 3, 2, 4]);
		this.MERGE = models([2, 4]);
		this.MERGE_WITH = golombs([]);
	}
}

// [A.7.4] Creases of all half-edges. positions: those that predictions see, of groups.
export function findCreases(surface, positions) {
	const normals = [];
	for (let h = 0; h < surface.halfEdgeCount; h += 3) {
		const [a, b, c] = [h, h + 1, h + 2].map((g) => positions[surface.tail(g)]);
		normals.push(unitNormal(a, b, c));
	}
	const crease = new Uint8Array(surface.halfEdgeCount);
	for (let h = 0; h < surface.halfEdgeCount; ++h) {
		const t = surface.twin(h);
		if (t !== NONE) crease[h] = creaseClass(dot32(normals[face(h)], normals[face(t)]));
	}
	return crease;
}

function unitNormal(a, b, c) {
	const m = cross32(sub32(b, a), sub32(c, a));
	const s = dot32(m, m);
	return scale32(m, s > 0 ? f(1 / sqrt32(s)) : 0);
}

const creaseClass = (q) => Number(f(0.99) > q) + Number(f(0.9) > q) + Number(f(0.6) > q);

class Seams {
	constructor(streams, modelSet, piece, surface, umbrellas, crease) {
		this.streams = streams;
		this.models = modelSet;
		this.surface = surface;
		this.umbrellas = umbrellas;
		this.crease = crease;
		this.end = new Uint8Array(surface.halfEdgeCount);
		this.wedgeOf = new Int32Array(surface.halfEdgeCount).fill(NONE); // of corners
		this.limit = piece.wedgeCount - piece.isolatedCount;
		this.starts = []; // of each wedge
		this.groups = []; // of each wedge
	}

	// ---- [A.7.1] Groups and umbrellas

	decode(sequence) {
		for (const entry of sequence) {
			const g = this.surface.tail(entry);
			this.group = g;
			this.firstOfGroup = this.starts.length;
			this.umbrella(entry);
			if (this.umbrellas === undefined) continue;
			for (const s of this.umbrellas[g]) {
				if (this.wedgeOf[s] === NONE) this.umbrella(s);
			}
		}
		if (this.wedgeOf.includes(NONE)) fail('BadConnectivity', 'A.7.1', 'a corner without a wedge');
		if (this.starts.length !== this.limit) fail('BadAttribute', 'A.7.1', 'too few wedges');
		return { surface: this.surface.withTails(this.wedgeOf), starts: this.starts, groupOf: this.groups };
	}

	umbrella(h) {
		const { fan, open } = this.collectFan(h);
		if (fan.length < 2 || !this.hasSeam(fan, open)) {
			const w = this.wedge(fan[0], NONE, NONE, 1);
			for (const x of fan) this.wedgeOf[x] = w;
			return;
		}
		this.seamEnds(fan, open);
		this.runs(fan, open);
	}

	collectFan(h) {
		const { surface } = this;
		const fan = [h];
		let x = surface.ccw(h);
		for (; x !== NONE && x !== h; x = surface.ccw(x)) fan.push(x);
		if (x === h) return { fan, open: 0 };
		for (x = surface.cw(h); x !== NONE; x = surface.cw(x)) fan.unshift(x);
		return { fan, open: 1 };
	}

	hasSeam(fan, open) {
		const { surface } = this;
		const inside = fan.filter((x) => surface.twin(x) !== NONE);
		const farEnds = inside.filter((x) => this.end[surface.twin(x)]).length;
		const sharpest = inside.reduce((most, x) => Math.max(most, this.crease[x]), 0);
		return this.streams.bit(this.models.HAS_SEAM[Math.min(farEnds, 3)][open][sharpest]);
	}

	// ---- [A.7.2] Ends of seams

	seamEnds(fan, open) {
		const n = fan.length;
		const edges = open ? n - 1 : n;
		const needed = open ? 1 : 2;
		let ends = 0;
		for (let k = 1; k <= edges; ++k) {
			const x = fan[k % n];
			const mustBe = ends + edges - k + 1 === needed;
			const seam = mustBe ? 1 : this.streams.bit(this.models.EDGE[this.otherEnd(x)][Math.min(ends, 2)][open][this.crease[x]]);
			if (!seam) continue;
			++ends;
			this.end[x] = 1;
		}
	}

	otherEnd(x) {
		const t = this.surface.twin(x);
		return this.wedgeOf[t] === NONE ? 0 : 1 + this.end[t];
	}

	runs(fan, open) {
		const n = fan.length;
		const first = open ? 0 : fan.findIndex((x) => this.end[x]);
		const at = (i) => fan[(first + i) % n];
		let previous = NONE;
		let firstWedge = NONE;
		let i = 0;
		while (i < n) {
			let length = 1;
			while (i + length < n && !this.end[at(i + length)]) ++length;
			const isLast = i + length === n;
			const w = this.wedge(at(i), previous, isLast && !open ? firstWedge : NONE, i === 0 ? 1 : 0);
			for (let k = 0; k < length; ++k) this.wedgeOf[at(i + k)] = w;
			if (firstWedge === NONE) firstWedge = w;
			previous = w;
			i += length;
		}
	}

	// ---- [A.7.3] Wedges

	wedge(x, a, b, isFirst) {
		const earlier = this.mergedWedge(a, b, isFirst);
		if (earlier !== NONE) return earlier;
		if (this.starts.length === this.limit) fail('BadAttribute', 'A.7.3', 'too many wedges');
		this.starts.push(x);
		this.groups.push(this.group);
		return this.starts.length - 1;
	}

	// The wedges of the group but a and b are asked for, the latest first: their numbers are consecutive.
	mergedWedge(a, b, isFirst) {
		const excluded = [...new Set([a, b])].filter((w) => w !== NONE).sort((x, y) => y - x);
		const c = this.starts.length - this.firstOfGroup - excluded.length;
		if (c === 0 || !this.streams.bit(this.models.MERGE[isFirst][Math.min(c, 4) - 1])) return NONE;
		const rank = c > 1 ? this.streams.golomb(this.models.MERGE_WITH) : 0;
		if (rank >= c) fail('BadAttribute', 'A.7.3', 'a wedge that does not exist');
		let w = this.starts.length - 1 - rank;
		for (const x of excluded) {
			if (w <= x) --w;
		}
		return w;
	}
}

// The surface with wedges at its corners; the start and the group of each wedge.
export function decodeSeams(streams, modelSet, piece, surface, umbrellas, sequence, crease) {
	return new Seams(streams, modelSet, piece, surface, umbrellas, crease).decode(sequence);
}
