// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Further triangles and parts: A.9 of the specification, and the table of triangles of A.10.

import { fail } from './bytes.mjs';
import { golombs, models } from './entropy.mjs';
import { face, NONE } from './mesh.mjs';

// [A.9]
export class TriangleModels {
	constructor() {
		this.SAME_PART = models([4]);
		this.DUPLICATE = models([4, 4, 2]);
		this.MORE_DUPLICATES = models([]);
		this.DEGENERATE = models([2, 3, 2, 2, 2]);
		this.MORE_DEGENERATES = models([]);
		this.PART = golombs([]);
		this.LIST = golombs([3]);
	}
}

class FurtherTriangles {
	constructor(streams, modelSet, piece, surface) {
		this.streams = streams;
		this.models = modelSet;
		this.piece = piece;
		this.surface = surface;
		this.further = []; // { wedges, part }
	}

	bit(model) {
		return this.streams.bit(model);
	}

	// The table of triangles: { wedges, part, face }, face for the first of each face only. And the first triangle of each face.
	decode() {
		const { flags } = this.piece;
		const parts = this.partsOfFaces();
		const copies = flags.DUPLICATES ? this.duplicates() : new Uint32Array(this.piece.faceCount);
		if (flags.EDGE_DEGENERATES) this.edgeDegenerates(parts);
		if (flags.LISTED) this.listed();
		return this.table(parts, copies);
	}

	table(parts, copies) {
		const table = [];
		const first = [];
		for (let f = 0; f < this.piece.faceCount; ++f) {
			const wedges = [0, 1, 2].map((k) => this.surface.tail(3 * f + k));
			first.push(table.length);
			for (let i = 0; i <= copies[f]; ++i) table.push({ wedges, part: parts[f], face: i === 0 ? f : NONE });
		}
		for (const triangle of this.further) table.push({ ...triangle, face: NONE });
		return { table, first };
	}

	// [A.9.1] Parts of the faces
	partsOfFaces() {
		const { faceCount, partCount } = this.piece;
		const parts = new Uint32Array(faceCount);
		if (partCount === 1) return parts;
		let previous = 0;
		for (let f = 0; f < faceCount; ++f) {
			parts[f] = this.partOfFace(parts, f, previous);
			previous = parts[f];
		}
		return parts;
	}

	partOfFace(parts, f, previous) {
		const { partCount } = this.piece;
		const t = this.surface.twin(3 * f + 1);
		const entered = t !== NONE && face(t) < f ? 1 : 0;
		const guess = entered ? parts[face(t)] : previous;
		if (this.bit(this.models.SAME_PART[guess === previous ? entered + 2 : entered])) return guess;
		const distance = this.streams.golomb(this.models.PART);
		if (distance >= partCount - 1) fail('BadAttribute', 'A.9.1', 'a part that does not exist');
		return (guess + 1 + distance) % partCount;
	}

	// [A.9.2] Duplicates: the number of further copies of each face
	duplicates() {
		const { faceCount, duplicateCount } = this.piece;
		const copies = new Uint32Array(faceCount);
		let total = 0;
		let previous = 0;
		for (let f = 0; f < faceCount; ++f) {
			copies[f] = this.copiesOfFace(copies, f, previous, duplicateCount - total);
			total += copies[f];
			if (total > duplicateCount) fail('BadAttribute', 'A.9.2', 'too many duplicates');
			previous = Math.min(copies[f], 1);
		}
		if (total !== duplicateCount) fail('BadAttribute', 'A.9.2', 'too few duplicates');
		return copies;
	}

	copiesOfFace(copies, f, previous, left) {
		const neighbours = [0, 1, 2].map((k) => this.surface.twin(3 * f + k)).filter((t) => t !== NONE && face(t) < f);
		const duplicated = neighbours.filter((t) => copies[face(t)] !== 0);
		let count = this.bit(this.models.DUPLICATE[neighbours.length][duplicated.length][previous]);
		if (count === 0) return 0;
		while (count < left && this.bit(this.models.MORE_DUPLICATES)) ++count;
		return count;
	}

	// [A.9.3] Degenerate triangles on edges
	edgeDegenerates(parts) {
		const { surface, piece } = this;
		this.doubled = new Uint8Array(piece.wedgeCount);
		this.single = new Uint8Array(piece.wedgeCount);
		this.degenerates = 0;
		for (let h = 0; h < surface.halfEdgeCount; ++h) {
			if (!this.wasAsked(h)) this.degeneratesOfEdge(h, parts[face(h)]);
		}
		if (this.degenerates !== piece.edgeDegenerateCount) fail('BadAttribute', 'A.9.3', 'too few degenerate triangles');
		if (piece.partCount > 1) this.partsOfDegenerates();
	}

	// Whether the edge was asked at its other half-edge, which has the same wedges.
	wasAsked(h) {
		const { surface } = this;
		const t = surface.twin(h);
		return t !== NONE && t < h && surface.tail(t) === surface.head(h) && surface.head(t) === surface.tail(h);
	}

	degeneratesOfEdge(h, part) {
		const [tail, head] = [this.surface.tail(h), this.surface.head(h)];
		let first = 0;
		for (const side of [0, 1]) {
			const [a, b] = side === 0 ? [tail, head] : [head, tail];
			const context = this.models.DEGENERATE[side][this.doubled[a]][this.single[b]][this.single[a]];
			const count = this.countDegenerates(context[first]);
			if (count !== 0) {
				this.doubled[a] = Math.min(this.doubled[a] + 1, 2);
				this.single[b] = 1;
			}
			for (let i = 0; i < count; ++i) this.further.push({ wedges: [a, a, b], part });
			first = Math.min(count, 1);
		}
	}

	countDegenerates(model) {
		const left = this.piece.edgeDegenerateCount - this.degenerates;
		let count = this.bit(model);
		if (count !== 0) {
			while (count < left && this.bit(this.models.MORE_DEGENERATES)) ++count;
		}
		this.degenerates += count;
		if (count > left) fail('BadAttribute', 'A.9.3', 'too many degenerate triangles');
		return count;
	}

	partsOfDegenerates() {
		const { partCount } = this.piece;
		for (const triangle of this.further) {
			const distance = this.streams.golomb(this.models.PART);
			if (distance >= partCount) fail('BadAttribute', 'A.9.3', 'a part that does not exist');
			triangle.part = (triangle.part + distance) % partCount;
		}
	}

	// [A.9.4] Listed triangles
	listed() {
		const { wedgeCount, listedCount, partCount } = this.piece;
		let last = 0;
		const near = (from, k) => {
			const w = (from + this.streams.signedGolomb(this.models.LIST[k])) >>> 0;
			if (w >= wedgeCount) fail('BadAttribute', 'A.9.4', 'a wedge that does not exist');
			return w;
		};
		for (let i = 0; i < listedCount; ++i) {
			const w0 = near(last, 0);
			const wedges = [w0, near(w0, 1), near(w0, 2)];
			const part = partCount > 1 ? this.streams.golomb(this.models.PART) : 0;
			if (part >= partCount) fail('BadAttribute', 'A.9.4', 'a part that does not exist');
			this.further.push({ wedges, part });
			last = w0;
		}
	}
}

export function decodeTriangles(streams, modelSet, piece, surface) {
	return new FurtherTriangles(streams, modelSet, piece, surface).decode();
}
