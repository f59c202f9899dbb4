// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Sums of face normals [A.10.7], normals [A.10.8]. All floats are f32.

import { add32, cross32, dot32, f, max, min, scale32, subtract32 } from './floats.mjs';
import { mateModels, valuesOfMates } from './mates.mjs';
import {
	centreOf, frameAround, frameOfVector, gridPoint, turnedValue, octahedron, pointOfValue, readPoint, size, sumOf,
} from './octahedral.mjs';
import { NO_NEIGHBOURS, contextOf, contextRows } from './residuals.mjs';
import { NONE, forEachFace } from './surface.mjs';
import { codeBundles } from './wedges.mjs';

// The weight of faces, bits 0..1 of `predictor`.
export const AREA = 0, ANGLE = 1, SINE = 2;
export const BLEND = 4;
const PI = f(3.14159274);
export const normalModels = () => ({ ROW: [contextRows(), contextRows()], ...mateModels() });

// [A.10.7] Of a face with these positions at its corners.
export function faceOf(p0, p1, p2) {
	const e0 = subtract32(p1, p0), e1 = subtract32(p2, p0), normal = cross32(e0, e1);
	return { e0, e1, normal, nn: dot32(normal, normal) };
}

// [A.10.7] The angles at the corners of a face.
export function anglesOf({ e0, e1, nn }) {
	const length = f(Math.sqrt(nn)), d = dot32(e0, e1), a0 = cornerAngle(length, d);
	const a1 = cornerAngle(length, f(dot32(e0, e0) - d));
	return [a0, a1, f(f(PI - a0) - a1)];
}

function cornerAngle(y, x) {
	const ax = Math.abs(x), t = f(min(ax, y) / f(max(ax, y) + f(1e-30))), s = f(t * t);
	const p = f(f(f(f(f(-0.0464964749) * s) + f(0.15931422)) * s) - f(0.327622764));
	let r = f(f(f(p * s) * t) + t);
	if (y > ax) r = f(f(1.57079637) - r);
	return x < 0 ? f(PI - r) : r;
}

function weightsOf(faceAt, weight) {
	const { e0, e1, nn } = faceAt;
	if (weight === AREA) return [1, 1, 1];
	if (weight === ANGLE) {
		const i = nn > 0 ? f(1 / f(Math.sqrt(nn))) : 0;
		return anglesOf(faceAt).map((a) => f(a * i));
	}
	if (!(nn > 0)) return [0, 0, 0];
	const e2 = subtract32(e1, e0);
	const [q0, q1, q2] = [e0, e1, e2].map((e) => dot32(e, e));
	return [f(1 / f(q0 * q1)), f(1 / f(q0 * q2)), f(1 / f(q1 * q2))];
}

// [A.10.7] The sum of each wedge.
function sumsOfFaceNormals({ piece, surface }, positions, weight) {
	const sums = Array.from({ length: piece.wedge_count }, () => [0, 0, 0]);
	forEachFace(surface, (corners) => {
		const faceAt = faceOf(...corners.map((w) => positions[w]));
		const weights = weightsOf(faceAt, weight);
		corners.forEach((w, k) => { sums[w] = add32(sums[w], scale32(faceAt.normal, weights[k])); });
	});
	return sums;
}

// [A.10.8]
export function decodeNormals(coding, models, attribute, positions) {
	const C = centreOf(attribute.bits), blend = (attribute.predictor & BLEND) !== 0;
	const S = sumsOfFaceNormals(coding.wedges, positions, attribute.predictor & 3);
	const valueOfMate = valuesOfMates(coding, models, attribute, (value, turn) => turnedValue(C, value, turn));
	const readUsing = (used, context) => {
		const frame = size(used) > f(1e-30) ? frameOfVector(C, used) : frameAround(C, last);
		return readPoint(coding.coder, models.ROW, frame, context);
	};
	let last = [0, 0];
	codeBundles(coding, ({ w, members, entry, n, p }) => {
		let direction = sumOf(members.map((member) => S[member]));
		if (blend) direction = scale32(direction, size(direction) > f(1e-30) ? f(1 / size(direction)) : 0);
		let used = direction;
		if (blend && entry !== NONE) used = add32(direction, scale32(add32(S[n], S[p]), 0.25));
		const context = entry === NONE ? NO_NEIGHBOURS : contextOf(coding, n, p);
		const image = valueOfMate(w);
		const { point, length } = image === undefined
			? readUsing(used, context) : { point: pointOfValue(C, image), length: context };
		last = point;
		if (blend) {
			const i = f(1 / C);
			const missed = subtract32(octahedron(f(last[0] * i), f(last[1] * i)), direction);
			for (const member of members) S[member] = missed;
		}
		return { value: gridPoint(C, point), length };
	});
}
