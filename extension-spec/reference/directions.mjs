// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Directions in a plane, and sums of face tangents [A.10.12]. All floats are f32.

import { INTEGER, LATTICE } from './attributeheader.mjs';
import { add32, cross32, dot32, f, finite, max, min, scale32 } from './floats.mjs';
import { anglesOf, faceOf } from './normals.mjs';
import { forEachFace } from './surface.mjs';

const PI = f(3.14159274), HALF_PI = f(1.57079637);

// [A.10.12] Two axes beside a normal.
export function axesOf(n) {
	const [ax, ay, az] = n.map(Math.abs);
	let e = [-n[1], n[0], 0];
	if (ax <= ay && ax <= az) e = [0, -n[2], n[1]];
	else if (ay <= az) e = [n[2], 0, -n[0]];
	const e1 = scale32(e, f(1 / f(Math.sqrt(dot32(e, e)))));
	return [e1, cross32(n, e1)];
}

// The value of a polynomial; the coefficients begin with that of the highest power.
const polynomial = (x, coefficients) => coefficients.map(f).reduce((y, c) => f(f(y * x) + c));
const ARC_TANGENT = [-0.01172120, 0.05265332, -0.11643287, 0.19354346, -0.33262347, 0.99997726];
export function planeAngle(y, x) {
	const ax = Math.abs(x), ay = Math.abs(y), t = f(min(ax, ay) / f(max(ax, ay) + f(1e-30)));
	let r = f(polynomial(f(t * t), ARC_TANGENT) * t);
	if (ay > ax) r = f(HALF_PI - r);
	if (x < 0) r = f(PI - r);
	return y < 0 ? -r : r;
}

const SINE = [-1 / 39916800, 1 / 362880, -1 / 5040, 1 / 120, -1 / 6];
const COSINE = [1 / 479001600, -1 / 3628800, 1 / 40320, -1 / 720, 1 / 24, -0.5];

// [A.10.12] The vector of an angle of B bits in the plane of the normal n.
export function vectorOfAngle(angle, B, n) {
	const quarters = 2 ** (B - 2), a = angle & (4 * quarters - 1);
	const x = f((a % quarters) * f(HALF_PI / quarters)), xx = f(x * x);
	const sine = f(x + f(x * f(xx * polynomial(xx, SINE))));
	const cosine = f(1 + f(xx * polynomial(xx, COSINE)));
	const [m1, m2] = [[cosine, sine], [-sine, cosine], [-cosine, -sine], [sine, -cosine]][a >> (B - 2)];
	const [e1, e2] = axesOf(n);
	return add32(scale32(e1, m1), scale32(e2, m2));
}

export function projectOnPlane(v, n) {
	const q = dot32(n, n);
	if (!(q > f(1e-12) && q < f(1e12))) return v;
	const a = f(dot32(n, v) / q);
	return v.map((x, s) => f(x - f(a * n[s])));
}

// [A.10.12] The function that yields the chart coordinates of a wedge.
export function chartCoordinates(chart, values) {
	if (chart.coding === LATTICE || chart.coding === INTEGER) return (w) => values[w].map(f);
	return (w) => values[w].map((i) => {
		const x = finite(i), size = Math.abs(x);
		return size >= f(1e-9) && size <= f(1e9) ? x : 0;
	});
}

// [A.10.12] Sums of face tangents: four numbers of each wedge. Without a chart, chartOf is undefined, and they are 0.
export function sumsOfFaceTangents({ piece, surface }, positions, chartOf) {
	const T = Array.from({ length: piece.wedge_count }, () => [0, 0, 0, 0]);
	if (chartOf === undefined) return T;
	forEachFace(surface, (corners) => {
		const faceAt = faceOf(...corners.map((w) => positions[w]));
		const { t, i, side } = tangentOf(faceAt, corners.map(chartOf));
		anglesOf(faceAt).forEach((a, k) => addTo(T[corners[k]], [...scale32(t, f(a * i)), side]));
	});
	return T;
}

// Adds four components.
export function addTo(sum, addend) {
	for (let c = 0; c < 4; ++c) sum[c] = f(sum[c] + addend[c]);
}

function tangentOf({ e0, e1 }, [uv0, uv1, uv2]) {
	const u0 = f(uv1[0] - uv0[0]), v0 = f(uv1[1] - uv0[1]);
	const u1 = f(uv2[0] - uv0[0]), v1 = f(uv2[1] - uv0[1]), determinant = f(f(u0 * v1) - f(u1 * v0));
	const side = determinant < 0 ? -1 : 1;
	const t = e0.map((x, s) => side * f(f(x * v1) - f(e1[s] * v0)));
	const tt = dot32(t, t);
	if (Math.abs(determinant) > 0 && tt > 0) return { t, i: f(1 / f(Math.sqrt(tt))), side };
	return { t: [0, 0, 0], i: 0, side: 0 };
}
