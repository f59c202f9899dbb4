// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The octahedral grid and its frames [A.10.6]. All floats are f32.

import { turned } from './anchors.mjs';
import { add32, clamp, copysign, cross32, dot32, f, round32, scale32 } from './floats.mjs';
import { NO_NEIGHBOURS, contextAfter, smallSigned } from './residuals.mjs';

// [A.10.6] The centre of a grid of b bits.
export const centreOf = (b) => 2 ** (b - 1) - 1;

// [A.10.6] |v| of a vector.
export const size = (v) => f(f(Math.abs(v[0]) + Math.abs(v[1])) + Math.abs(v[2]));
export function octahedron(x, y) {
	const ax = Math.abs(x), ay = Math.abs(y), z = f(f(1 - ax) - ay);
	return z < 0 ? [copysign(f(1 - ay), x), copysign(f(1 - ax), y), z] : [x, y, z];
}

export function unitVector(C, [s, t]) {
	const i = f(1 / C), v = octahedron(f(f(s - C) * i), f(f(t - C) * i));
	return scale32(v, f(1 / f(Math.sqrt(dot32(v, v)))));
}

function turnOver(C, [x, y]) {
	const X = C - Math.abs(y), Y = C - Math.abs(x);
	return [x < 0 || (x === 0 && y < 0) ? -X : X, y < 0 || (y === 0 && x < 0) ? -Y : Y];
}

// The frame of project(v).
export function frameOfVector(C, v) {
	const scale = f(C / size(v));
	return frame(C, [round32(f(v[0] * scale)), round32(f(v[1] * scale))], v[2] < 0);
}

// The frame around a point.
export function frameAround(C, point) {
	const turned = Math.abs(point[0]) + Math.abs(point[1]) > C;
	return frame(C, turned ? turnOver(C, point) : point, turned);
}

function frame(C, [x, y], turned) {
	const [c, s] = rotationOf(x, y);
	return { C, c, s, turned, p: [c * x - s * y, s * x + c * y] };
}

function rotationOf(x, y) {
	if (y > 0 && x <= 0) return [0, 1];
	if (x > 0 && y >= 0) return [-1, 0];
	return y < 0 && x >= 0 ? [0, -1] : [1, 0];
}

// The point of a residual, relative to the centre. Adding 0 makes a 0 of -0, which integers do not have.
function pointOf({ C, c, s, turned, p }, residuals) {
	const [a, b] = residuals.map((r, i) => wrap(C, p[i] + clamp(r, -C, C)));
	const point = [c * a + s * b, c * b - s * a];
	return (turned ? turnOver(C, point) : point).map((x) => x + 0);
}
const wrap = (C, i) => (i < -C ? i + (2 * C + 1) : i);

// [A.10.19] How residuals in the frame of `direction` lie if the vectors lie in the plane with the normal N.
export function lineOfPlane({ c, s }, N, direction) {
	const turn = cross32(N, direction);
	const shrink = turn.reduce((sum, x, k) => f(sum + (direction[k] < 0 ? -x : x)), 0);
	const [x, y] = [0, 1].map((k) => f(f(turn[k] * size(direction)) - f(direction[k] * shrink)));
	const step = [c * x - s * y, s * x + c * y];
	const k = Math.abs(step[1]) > Math.abs(step[0]) ? 1 : 0;
	return { k, slope: Math.abs(step[k]) > 0 ? f(step[1 - k] / step[k]) : 0 };
}

// [A.10.8, A.10.19] A point in a frame, relative to the centre, and its length L; residuals are near a line, if there is one.
export function readPoint(coder, ROW, frameOfPoint, context, { k, slope } = { k: 0, slope: 0 }) {
	const first = smallSigned(coder, 0, ROW[0][context]);
	const row = ROW[1][context === NO_NEIGHBOURS ? first.length : contextAfter(context, first.length)];
	const second = smallSigned(coder, 1, row);
	const { C } = frameOfPoint, expected = round32(f(slope * clamp(first.residual, -C, C)));
	const other = (second.residual + expected) | 0;
	const point = pointOf(frameOfPoint, k === 0 ? [first.residual, other] : [other, first.residual]);
	return { point, length: Math.max(first.length, second.length) };
}

// [A.10.8] The value of a point: its place on the grid; and the point of a value.
export const gridPoint = (C, point) => [point[0] + C, point[1] + C];
export const pointOfValue = (C, value) => [value[0] - C, value[1] - C];

// [A.10.20] The image of a value, turned.
export function turnedValue(C, value, turn) {
	const from = pointOfValue(C, value), z = C - Math.abs(from[0]) - Math.abs(from[1]);
	const image = turned(turn, [...(z < 0 ? turnOver(C, from) : from), z]);
	return gridPoint(C, image[2] < 0 ? turnOver(C, image.slice(0, 2)) : image.slice(0, 2));
}
export const sumOf = (vectors) => vectors.reduce(add32);
