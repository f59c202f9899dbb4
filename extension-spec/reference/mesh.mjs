// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Faces and half-edges: A.1.5 of the specification.

export const NONE = -1;

export const face = (h) => Math.floor(h / 3);
export const corner = (h) => h % 3;
export const next = (h) => (h % 3 === 2 ? h - 2 : h + 1);
export const prev = (h) => (h % 3 === 0 ? h + 2 : h - 1);

// The surface of a piece. `tails` holds vertices, groups or wedges, by the stage.
export class Surface {
	constructor(tails, twins) {
		this.tails = tails;
		this.twins = twins;
		this.halfEdgeCount = tails.length;
		this.faceCount = tails.length / 3;
	}

	// The same faces with something else at their corners.
	withTails(tails) {
		return new Surface(tails, this.twins);
	}

	tail(h) {
		return this.tails[h];
	}

	head(h) {
		return this.tails[next(h)];
	}

	twin(h) {
		return this.twins[h];
	}

	ccw(h) {
		return this.twins[prev(h)];
	}

	cw(h) {
		return this.twins[h] === NONE ? NONE : next(this.twins[h]);
	}

	// [A.1.5] The half-edge that leaves the vertex beyond h.
	across(h) {
		return this.twins[h] === NONE ? NONE : prev(this.twins[h]);
	}
}
