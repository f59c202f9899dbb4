// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Faces and half-edges [A.1.5].
//
// A surface has `tail`, which holds a vertex, later a group, later a wedge for each half-edge, and `twin`.
// `none` is -1, and so none of these functions may be called with it unless its comment says so.

export const NONE = -1;
export const createSurface = (faceCount) => ({
	tail: new Int32Array(3 * faceCount),
	twin: new Int32Array(3 * faceCount).fill(NONE),
});

export const face = (h) => Math.floor(h / 3);
export const next = (h) => (h % 3 === 2 ? h - 2 : h + 1);
export const prev = (h) => (h % 3 === 0 ? h + 2 : h - 1);
export const head = (surface, h) => surface.tail[next(h)];
export const twin = (surface, h) => surface.twin[h];
export const ccw = (surface, h) => surface.twin[prev(h)];
export const cw = (surface, h) => (surface.twin[h] === NONE ? NONE : next(surface.twin[h]));
export const across = (surface, h) => (surface.twin[h] === NONE ? NONE : prev(surface.twin[h]));

// The half-edges of the umbrella at h: from h counterclockwise, and, if the umbrella is open, those clockwise of h, in
// the order in which they are met.
export function umbrellaAt(surface, h) {
	const counterclockwise = [], clockwise = [];
	let x = h;
	do {
		counterclockwise.push(x);
		x = ccw(surface, x);
	} while (x !== h && x !== NONE);
	const closed = x === h;
	if (!closed) for (x = cw(surface, h); x !== NONE; x = cw(surface, x)) clockwise.push(x);
	return { counterclockwise, clockwise, closed };
}

// Calls visit(corners, first half-edge) for each face, ascending.
export function forEachFace({ tail }, visit) {
	for (let h = 0; h < tail.length; h += 3) visit([tail[h], tail[h + 1], tail[h + 2]], h);
}
