// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Tangents as angles and as points: A.10.13 of the specification. What they are predicted from: A.10.12.

import { models, rows } from './entropy.mjs';
import { faceAngles } from './faces.mjs';
import { finite } from './floats.mjs';
import { readSmallSigned } from './lengths.mjs';
import { EXACT_FLOAT, GRID } from './names.mjs';
import { centreOf, Frame, NO_NEIGHBOUR, readPoint, unitVector } from './octahedral.mjs';
import { add32, cross32, dot32, f, length1, max, min, round32, scale32, sqrt32, sub32 } from './vectors.mjs';
import { bundles } from './wedges.mjs';

export class TangentModels {
	constructor() {
		this.angles = { ROW: rows([12]), NEGATIVE: models([3]) };
		this.points = { ROW: rows([2, 12]), NEGATIVE: models([3]) };
	}
}

// ---- [A.10.12] A frame beside a normal

function frameBeside(n) {
	const [ax, ay, az] = n.map(Math.abs);
	let e1 = [-n[1], n[0], 0];
	if (ax <= ay && ax <= az) e1 = [0, -n[2], n[1]];
	else if (ay <= az) e1 = [n[2], 0, -n[0]];
	e1 = scale32(e1, f(1 / sqrt32(dot32(e1, e1))));
	return [e1, cross32(n, e1)];
}

// ---- [A.10.12] Angle in a plane

function planeAngle(y, x) {
	const ax = Math.abs(x);
	const ay = Math.abs(y);
	const t = f(min(ax, ay) / f(max(ax, ay) + f(1e-30)));
	const s = f(t * t);
	let r = f(f(f(-0.01172120) * s) + f(0.05265332));
	for (const c of [-0.11643287, 0.19354346, -0.33262347]) r = f(f(r * s) + f(c));
	r = f(f(f(r * s) + f(0.99997726)) * t);
	if (ay > ax) r = f(f(1.57079637) - r);
	if (x < 0) r = f(f(3.14159274) - r);
	return y < 0 ? -r : r;
}

// ---- [A.10.12] The vector of an angle

const SINE = [-1 / 6, 1 / 120, -1 / 5040, 1 / 362880, -1 / 39916800].map(f);
const COSINE = [-0.5, 1 / 24, -1 / 720, 1 / 40320, -1 / 3628800, 1 / 479001600].map(f);

const horner = (xx, coefficients) => coefficients.reduceRight((y, c) => (y === undefined ? c : f(f(xx * y) + c)), undefined);

export function vectorOfAngle(B, angle, normal) {
	const a = angle % 2 ** B;
	const quarter = Math.floor(a / 2 ** (B - 2));
	const rest = a % 2 ** (B - 2);
	const x = f(f(rest) * f(f(1.57079637) / 2 ** (B - 2)));
	const xx = f(x * x);
	const sine = f(x + f(x * f(xx * horner(xx, SINE))));
	const cosine = f(1 + f(xx * horner(xx, COSINE)));
	const [along, across] = [[cosine, sine], [-sine, cosine], [-cosine, -sine], [sine, -cosine]][quarter];
	const [e1, e2] = frameBeside(normal);
	return add32(scale32(e1, along), scale32(e2, across));
}

// ---- [A.10.12] Chart coordinates of all wedges

export function chartCoordinates(state) {
	const { coding } = state.attribute;
	const coordinate = coding === EXACT_FLOAT || coding === GRID ? floatCoordinate : f;
	return Array.from({ length: state.wedges.count }, (_, w) => [...state.value(w)].map((x) => coordinate(x)));
}

function floatCoordinate(i) {
	const x = finite(i);
	return Math.abs(x) >= f(1e-9) && Math.abs(x) <= 1e9 ? x : 0;
}

// ---- [A.10.12] Sums of face tangents: four numbers for each wedge

function faceTangentSums(wedges, chart) {
	const { surface, positions } = wedges;
	const T = Array.from({ length: wedges.count }, () => [0, 0, 0, 0]);
	if (chart === undefined) return T;
	for (let h = 0; h < surface.halfEdgeCount; h += 3) {
		const corners = [h, h + 1, h + 2].map((g) => surface.tail(g));
		const { t, side, factors } = faceTangent(corners.map((w) => positions[w]), corners.map((w) => chart[w]));
		corners.forEach((w, k) => { T[w] = [...add32(T[w], scale32(t, factors[k])), f(T[w][3] + side)]; });
	}
	return T;
}

function faceTangent([p0, p1, p2], [c0, c1, c2]) {
	const e0 = sub32(p1, p0);
	const e1 = sub32(p2, p0);
	const [u0, v0] = [f(c1[0] - c0[0]), f(c1[1] - c0[1])];
	const [u1, v1] = [f(c2[0] - c0[0]), f(c2[1] - c0[1])];
	const determinant = f(f(u0 * v1) - f(u1 * v0));
	const side = determinant < 0 ? -1 : 1;
	const t = [0, 1, 2].map((s) => f(side * f(f(e0[s] * v1) - f(e1[s] * v0))));
	const tt = dot32(t, t);
	if (!(Math.abs(determinant) > 0 && tt > 0)) return { t: [0, 0, 0], side: 0, factors: [0, 0, 0] };
	const i = f(1 / sqrt32(tt));
	const { angles } = faceAngles(e0, e1, cross32(e0, e1));
	return { t, side, factors: angles.map((a) => f(a * i)) };
}

// The sums of all members of a bundle, at its first wedge.
function bundleSums(wedges, bundleOf, chart) {
	const T = faceTangentSums(wedges, chart);
	for (let w = 0; w < wedges.surfaceCount; ++w) {
		const first = bundleOf[w][0];
		if (first !== w) T[first] = T[first].map((x, k) => f(x + T[w][k]));
	}
	return T;
}

// ---- [A.10.12] Projection on a plane

function projectOnPlane(n, v) {
	const q = dot32(n, n);
	if (!(q > f(1e-12) && q < f(1e12))) return v;
	return sub32(v, scale32(n, f(dot32(n, v) / q)));
}

// ---- [A.10.13]

class Tangents {
	constructor(context, state, tangentModels) {
		this.streams = context.streams;
		this.context = context;
		this.models = tangentModels;
		this.state = state;
		this.wedges = state.wedges;
		this.T = bundleSums(state.wedges, state.bundleOf, context.chart());
		state.negative = new Uint8Array(state.wedges.count);
	}

	decode() {
		for (const bundle of bundles(this.wedges, this.state.bundleOf)) this.bundle(bundle);
	}

	// The expected sign: 1 positive, 2 negative, 0 unknown
	sign(bundle) {
		const sum = bundle.isolated ? 0 : this.T[bundle.first][3];
		if (sum > 0) return 1;
		return sum < 0 ? 2 : 0;
	}

	readNegative(bundle) {
		const negative = this.streams.bit(this.models.NEGATIVE[this.sign(bundle)]);
		for (const w of bundle.members) this.state.negative[w] = negative;
	}
}

class TangentAngles extends Tangents {
	constructor(context, state) {
		super(context, state, context.models.tangents.angles);
		this.B = state.attribute.bits;
		this.last = 0;
		this.normals = context.octahedralNormals();
	}

	bundle(bundle) {
		const { predicted, context } = this.predict(bundle);
		const { residual, length } = readSmallSigned(this.streams, 0, this.models.ROW[context]);
		const size = 2 ** this.B;
		this.last = (((predicted + residual) % size) + size) % size;
		this.readNegative(bundle);
		this.state.finish(bundle, [this.last], length);
	}

	predict(bundle) {
		const { state } = this;
		if (bundle.isolated) return { predicted: this.last, context: NO_NEIGHBOUR };
		let predicted = this.last;
		let context = NO_NEIGHBOUR;
		if (bundle.hasEntry) {
			context = state.meanLength(bundle);
			if (state.isCoded(bundle.n)) predicted = state.value(bundle.n)[0];
		}
		const sum = this.T[bundle.first];
		const [x, y] = frameBeside(this.normals[bundle.first]).map((e) => dot32(sum, e));
		if (f(Math.abs(x) + Math.abs(y)) > f(1e-6)) predicted = round32(f(f(2 ** this.B * f(0.159154943)) * planeAngle(y, x)));
		return { predicted, context };
	}
}

class TangentPoints extends Tangents {
	constructor(context, state) {
		super(context, state, context.models.tangents.points);
		this.C = centreOf(state.attribute.bits);
		this.last = [0, 0];
		this.normals = context.unitNormals();
	}

	bundle(bundle) {
		const { frame, context } = this.frameOf(bundle);
		const { point, L } = readPoint(this.streams, this.models.ROW, frame, context);
		this.last = point;
		this.readNegative(bundle);
		this.state.finish(bundle, point.map((x) => x + this.C), L);
	}

	frameOf(bundle) {
		const { C, last } = this;
		if (bundle.isolated) return { frame: Frame.around(C, last), context: NO_NEIGHBOUR };
		let direction = this.projected(this.T[bundle.first].slice(0, 3), bundle.first);
		let context = NO_NEIGHBOUR;
		if (bundle.hasEntry) {
			context = this.state.meanLength(bundle);
			if (!(length1(direction) > f(1e-6))) direction = this.fromNeighbours(direction, bundle);
		}
		const length = length1(direction);
		const known = length > f(1e-6) && length < f(1e30);
		return { frame: known ? Frame.ofDirection(C, direction) : Frame.around(C, last), context };
	}

	fromNeighbours(direction, { first, n, p }) {
		for (const w of [n, p]) {
			if (this.state.isCoded(w)) direction = add32(direction, unitVector(this.C, this.state.value(w)));
		}
		return this.projected(direction, first);
	}

	projected(v, w) {
		return this.normals === undefined ? v : projectOnPlane(this.normals[w], v);
	}
}

export function decodeTangentAngles(context, state) {
	new TangentAngles(context, state).decode();
}

export function decodeTangentPoints(context, state) {
	new TangentPoints(context, state).decode();
}
