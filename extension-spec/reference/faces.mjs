// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Positions as predictions see them, and what is made of faces: A.10.7, A.10.7, A.6.13 and A.10.16 of the specification.

import { width } from './bytes.mjs';
import { finite } from './floats.mjs';
import { INTEGER, LATTICE } from './names.mjs';
import { add32, add64, cross32, cross64, dot32, dot64, f, max, min, scale32, scale64, sqrt32, sub32, sub64 } from './vectors.mjs';

// The weight of faces: bits 0..1 of the predictor byte of normals (A.10.8, A.10.16)
const AREA = 0, ANGLE = 1; // 2 is sine

const vectorsOf = (list) => Array.from({ length: list.length / 3 }, (_, i) => [list[3 * i], list[3 * i + 1], list[3 * i + 2]]);

// ---- [A.6.13] Positions as predictions see them

// The positions of all records, whose integers are q.
export function predictionPositions(attribute, q) {
	const ofIntegers = attribute.coding === LATTICE || attribute.coding === INTEGER;
	return ofIntegers ? rangeOfIntegers(vectorsOf(q)) : rangeOfFloats(vectorsOf(q).map((v) => v.map(finite)));
}

const largestDifference = (list) => list.reduce((most, v) => v.reduce((m, x, s) => Math.max(m, Math.abs(x - list[0][s])), most), 0);

function rangeOfIntegers(list) {
	const shift = Math.max(width(largestDifference(list)) - 22, 0);
	return list.map((v) => v.map((x, s) => f(Math.floor((x - list[0][s]) / 2 ** shift))));
}

// The range of floats that are finite.
function rangeOfFloats(list) {
	const reach = largestDifference(list);
	const E = exponent64(reach);
	const scale = E === undefined ? 1 : 2 ** (21 - E);
	return list.map((v) => v.map((x, s) => f(Math.trunc((x - list[0][s]) * scale))));
}

// E with 2^E <= x < 2^(E + 1); undefined if x is 0 or denormal.
function exponent64(x) {
	const view = new DataView(new ArrayBuffer(8));
	view.setFloat64(0, x);
	const field = (view.getUint16(0) >> 4) & 2047;
	return field === 0 ? undefined : field - 1023;
}

// Exact positions of all records.
export function exactPositions(attribute, q) {
	return vectorsOf(q).map((v) => v.map((x, s) => inRange(exactCoordinate(attribute, x, s))));
}

const inRange = (x) => (Math.abs(x) <= f(3e38) ? x : 0);

function exactCoordinate(attribute, q, s) {
	if (attribute.coding === LATTICE) return latticeFloat(attribute, q, s);
	return attribute.coding === INTEGER ? f(q) : finite(q);
}

// [A.10.18] The float of a lattice
export const latticeFloat = (attribute, q, c) => f(f(f(q) * attribute.step) + attribute.origin[c]);

// ---- [A.10.7] Angles at corners

function cornerAngle(y, x) {
	const ax = Math.abs(x);
	const t = f(min(ax, y) / f(max(ax, y) + f(1e-30)));
	const s = f(t * t);
	const p = f(f(f(f(f(-0.0464964749) * s) + f(0.15931422)) * s) - f(0.327622764));
	let r = f(f(f(p * s) * t) + t);
	if (y > ax) r = f(f(1.57079637) - r);
	if (x < 0) r = f(f(3.14159274) - r);
	return r;
}

function exactAngle(c, d) {
	const h = Math.sqrt(c * c + d * d);
	const t = c / (h + Math.abs(d));
	const u = t / (1 + Math.sqrt(1 + t * t));
	const s = u * u;
	let sum = 0;
	for (let k = 23; k >= 1; k -= 2) sum = 1 / k - s * sum;
	const acute = 4 * u * sum;
	return d < 0 ? 3.141592653589793 - acute : acute;
}

// The angles at the three corners of a face, and 1 / length of its normal. [A.10.7]
export function faceAngles(e0, e1, normal) {
	const length = sqrt32(dot32(normal, normal));
	const d = dot32(e0, e1);
	const a0 = cornerAngle(length, d);
	const a1 = cornerAngle(length, f(dot32(e0, e0) - d));
	return { length, angles: [a0, a1, f(f(f(3.14159274) - a0) - a1)] };
}

// ---- [A.10.7] Sums of face normals

// positions: of the wedges. The sums of all wedges.
export function faceNormalSums(surface, wedgeCount, positions, weight) {
	const sums = Array.from({ length: wedgeCount }, () => [0, 0, 0]);
	for (let h = 0; h < surface.halfEdgeCount; h += 3) {
		const wedges = [h, h + 1, h + 2].map((g) => surface.tail(g));
		const [p0, p1, p2] = wedges.map((w) => positions[w]);
		const e0 = sub32(p1, p0);
		const e1 = sub32(p2, p0);
		const normal = cross32(e0, e1);
		const weights = faceWeights(weight, e0, e1, normal);
		wedges.forEach((w, k) => { sums[w] = add32(sums[w], scale32(normal, weights[k])); });
	}
	return sums;
}

function faceWeights(weight, e0, e1, normal) {
	if (weight === AREA) return [1, 1, 1];
	const nn = dot32(normal, normal);
	if (weight === ANGLE) {
		const { length, angles } = faceAngles(e0, e1, normal);
		const i = nn > 0 ? f(1 / length) : 0;
		return angles.map((a) => f(a * i));
	}
	const e2 = sub32(e1, e0);
	const [q0, q1, q2] = [e0, e1, e2].map((e) => dot32(e, e));
	return [[q0, q1], [q0, q2], [q1, q2]].map(([a, b]) => (nn > 0 ? f(1 / f(a * b)) : 0));
}

// ---- [A.10.16] Exact sums of face normals

export function exactFaceNormalSums(surface, wedgeCount, positions, weight) {
	const sums = Array.from({ length: wedgeCount }, () => [0, 0, 0]);
	for (let h = 0; h < surface.halfEdgeCount; h += 3) {
		const wedges = [h, h + 1, h + 2].map((g) => surface.tail(g));
		const [p0, p1, p2] = wedges.map((w) => positions[w]);
		const sides = [sub64(p1, p0), sub64(p2, p1), sub64(p0, p2)];
		const normal = cross64(sides[0], sides[1]);
		const weights = exactFaceWeights(weight, sides, normal);
		if (weights === undefined) continue;
		wedges.forEach((w, k) => { sums[w] = add64(sums[w], scale64(normal, weights[k])); });
	}
	return sums;
}

// undefined for a face without an area
function exactFaceWeights(weight, sides, normal) {
	if (weight === AREA) return [1, 1, 1];
	const square = dot64(normal, normal);
	if (!(square > 1e-290)) return undefined;
	const length = Math.sqrt(square);
	const i = 1 / length;
	if (weight === ANGLE) {
		const a0 = exactAngle(length, -dot64(sides[0], sides[2]));
		const a1 = exactAngle(length, -dot64(sides[1], sides[0]));
		return [a0 * i, a1 * i, (3.141592653589793 - a0 - a1) * i];
	}
	const [q0, q1, q2] = sides.map((side) => dot64(side, side));
	return [1 / (q0 * q2), 1 / (q1 * q0), 1 / (q2 * q1)];
}
