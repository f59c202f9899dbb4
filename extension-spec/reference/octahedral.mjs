// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The octahedral grid and frames of predictions: A.10.6, A.10.6 and A.10.6 of the specification; points of A.10.8.

import { following, readSmallSigned } from './lengths.mjs';
import { copysign, f, length1, round32, scale32, sqrt32 } from './vectors.mjs';

export const NO_NEIGHBOUR = 11; // the context

export const centreOf = (bits) => 2 ** (bits - 1) - 1; // C

// ---- [A.10.6] Octahedral grid

export function fold(x, y) {
	const ax = Math.abs(x);
	const ay = Math.abs(y);
	const z = f(f(1 - ax) - ay);
	return z < 0 ? [copysign(f(1 - ay), x), copysign(f(1 - ax), y), z] : [x, y, z];
}

// The unit vector of a point, whose coordinates are 0 .. 2 C
export function unitVector(C, [s, t]) {
	const i = f(1 / f(C));
	const [x, y, z] = fold(f(f(f(s) - f(C)) * i), f(f(f(t) - f(C)) * i));
	const j = f(1 / sqrt32(f(f(f(x * x) + f(y * y)) + f(z * z))));
	return scale32([x, y, z], j);
}

// ---- [A.10.6] Projection to the grid: a point relative to the centre

function project(C, v) {
	const scale = f(f(C) / length1(v));
	return [round32(f(v[0] * scale)), round32(f(v[1] * scale))];
}

// ---- [A.10.6] The frame of a prediction

function turnOver(C, [x, y]) {
	const X = C - Math.abs(y);
	const Y = C - Math.abs(x);
	return [x < 0 || (x === 0 && y < 0) ? -X : X, y < 0 || (y === 0 && x < 0) ? -Y : Y];
}

export class Frame {
	constructor(C, p, turnedOver) {
		this.C = C;
		this.turnedOver = turnedOver;
		[this.c, this.s] = rotationOf(p);
		this.p = [this.c * p[0] - this.s * p[1], this.s * p[0] + this.c * p[1]];
	}

	static around(C, point) {
		const turned = Math.abs(point[0]) + Math.abs(point[1]) > C;
		return new Frame(C, turned ? turnOver(C, point) : point, turned);
	}

	static ofDirection(C, v) {
		return new Frame(C, project(C, v), v[2] < 0);
	}

	pointOf(residual) {
		const { C, c, s } = this;
		const [a, b] = this.p.map((x, k) => wrap(C, x + Math.min(Math.max(residual[k], -C), C)));
		const point = [c * a + s * b, c * b - s * a];
		return this.turnedOver ? turnOver(C, point) : point;
	}
}

function rotationOf([x, y]) {
	if (y > 0 && x <= 0) return [0, 1];
	if (x > 0 && y >= 0) return [-1, 0];
	if (y < 0 && x >= 0) return [0, -1];
	return [1, 0];
}

function wrap(C, i) {
	return i < -C ? i + (2 * C + 1) : i;
}

// ---- [A.10.8] A point in a frame: relative to the centre, and its length in context

export function readPoint(streams, ROW, frame, context) {
	const first = readSmallSigned(streams, 0, ROW[0][context]);
	const secondContext = context === NO_NEIGHBOUR ? first.length : following(context, first.length);
	const second = readSmallSigned(streams, 1, ROW[1][secondContext]);
	return { point: frame.pointOf([first.residual, second.residual]), L: Math.max(first.length, second.length) };
}
