// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Further triangles and parts: A.8 of the specification, and the table of triangles of A.9.

import { fail } from './bytes.mjs';
import { golombs, models, trees } from './entropy.mjs';
import { face, NONE } from './mesh.mjs';

const ANY = 7; // shape of a listed triangle that refers to no face

// [A.8]
export class TriangleModels {
	constructor() {
		this.SAME_PART = models([4]);
		this.PART = golombs([]);
		this.LIST_SHAPE = trees(3, [8]);
		this.LIST_GAP = golombs([2]);
		this.LIST_WEDGE = golombs([3]);
		this.LIST_PART = golombs([]);
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

	// The table of triangles: { wedges, part }; that of a face has its number.
	decode() {
		const parts = this.partsOfFaces();
		this.listed(parts);
		const faces = Array.from(parts, (part, f) => ({ wedges: [0, 1, 2].map((k) => this.surface.tail(3 * f + k)), part }));
		return [...faces, ...this.further];
	}

	// [A.8.1] Parts of the faces
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
		if (distance >= partCount - 1) fail('BadAttribute', 'A.8.1', 'a part that does not exist');
		return (guess + 1 + distance) % partCount;
	}

	// [A.8.2] Listed triangles
	listed(parts) {
		let last = { shape: 0, face: 0, wedges: [0, 0, 0], part: 0 };
		for (let i = 0; i < this.piece.listedCount; ++i) {
			last = this.listedTriangle(last, parts);
			this.further.push({ wedges: last.wedges, part: last.part });
		}
	}

	listedTriangle(last, parts) {
		const { streams, models: m } = this;
		const shape = streams.tree(m.LIST_SHAPE[last.shape]);
		if (shape === ANY) {
			const wedges = this.anyWedges(last.wedges[0]);
			return { shape, face: last.face, wedges, part: this.listedPart(last.part) };
		}
		const f = last.face + streams.golomb(m.LIST_GAP[Math.min(shape, 1)]);
		if (f >= this.piece.faceCount) fail('BadAttribute', 'A.8.2', 'a face that does not exist');
		return { shape, face: f, wedges: this.wedgesOfShape(shape, f), part: this.listedPart(parts[f]) };
	}

	// The face again, or two ends of an edge, the first of them twice
	wedgesOfShape(shape, f) {
		const { surface } = this;
		if (shape === 0) return [0, 1, 2].map((k) => surface.tail(3 * f + k));
		const h = 3 * f + Math.floor((shape - 1) / 2);
		const [a, b] = shape % 2 === 1 ? [surface.tail(h), surface.head(h)] : [surface.head(h), surface.tail(h)];
		return [a, a, b];
	}

	anyWedges(last) {
		const near = (from, k) => {
			const w = (from + this.streams.signedGolomb(this.models.LIST_WEDGE[k])) >>> 0;
			if (w >= this.piece.wedgeCount) fail('BadAttribute', 'A.8.2', 'a wedge that does not exist');
			return w;
		};
		const w0 = near(last, 0);
		return [w0, near(w0, 1), near(w0, 2)];
	}

	listedPart(guess) {
		const { partCount } = this.piece;
		if (partCount === 1) return 0;
		const distance = this.streams.golomb(this.models.LIST_PART);
		if (distance >= partCount) fail('BadAttribute', 'A.8.2', 'a part that does not exist');
		return (guess + distance) % partCount;
	}
}

export function decodeTriangles(streams, modelSet, piece, surface) {
	return new FurtherTriangles(streams, modelSet, piece, surface).decode();
}
