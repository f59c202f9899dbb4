// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Positions on and between planes: B.2.9 of the specification. All floats are binary32.

import { fail } from './bytes.mjs';
import { POSITIONS, Row, rows } from './entropy.mjs';
import { axesByNormal, floatOf } from './prediction.mjs';
import { readFoldedResidual, readResidual } from './residuals.mjs';
import { clamp, dot32, f, max, min, sqrt32 } from './vectors.mjs';

const xyz = [0, 1, 2];

export class PlanesModels {
	constructor() {
		this.BETWEEN = rows([513]);
		this.DIAGONAL = rows([8]);
		this.PLANE = rows([2, 4, 4]);
		this.REST = new Row();
	}
}

function floorOf(x) {
	const y = x > -(2 ** 20) ? (x < 2 ** 20 ? x : 2 ** 20) : -(2 ** 20);
	const i = Math.trunc(y);
	return i - (i > y ? 1 : 0);
}

const direction = (d, first, s) => (s !== first && ((d - 1) >> (s - 1)) & 1 ? -1 : 1);

// One axis: its planes in units of 2^-32 of a lattice step, and as floats O, D and I.
class Axis {
	constructor(streams) {
		this.step = readNumberOf49Bits(streams);
		this.origin = readNumberOf49Bits(streams);
		if (this.step < 1n << 34n || this.origin >= this.step) fail('BadAttribute', 'B.2.9', 'step or origin of planes');
		this.O = f(f(Number(this.origin)) / 2 ** 32);
		this.D = f(f(Number(this.step)) / 2 ** 32);
		this.I = f(1 / this.D);
	}

	coordinate(p) {
		const position = BigInt.asIntN(64, this.origin + (1n << 31n) + BigInt(p) * this.step);
		return Number(BigInt.asIntN(32, position >> 32n));
	}
}

function readNumberOf49Bits(streams) {
	const low = BigInt(streams.raw(24));
	return low + (BigInt(streams.raw(25)) << 24n);
}

export class Planes {
	constructor(streams, models, positionRows, records) {
		this.streams = streams;
		this.models = models;
		this.rows = positionRows;
		this.records = records;
		this.axes = xyz.map(() => new Axis(streams));
	}

	codeFan(fan, predicted, normal) {
		const { neighbours } = fan;
		const N = neighbours.length;
		const [A, B, C] = [0, N >> 1, N - 1].map((i) => this.records.magnitude[3 * neighbours[i] + 1] & 7);
		const between = predicted.between ?? [0, 0, 0];
		this.code(fan.v, 64 * A + 8 * B + C, { ...predicted, between, normal });
	}

	codeSeed(v, at) {
		this.code(v, 512, { at, normal: [0, 0, 0], spread: [0, 0, 0], magnitudes: [0, 0, 0], between: [0, 0, 0] });
	}

	code(v, context, fanState) {
		const vertex = new Vertex(this, fanState);
		vertex.read(context);
		this.records.q.set(vertex.q, 3 * v);
		this.records.magnitude.set(vertex.magnitudes(), 3 * v);
	}

	alongDiagonal(first, s, t) {
		const ratio = f(this.axes[s].D * this.axes[first].I);
		return floorOf(f(f(f(t) * ratio) + 0.5));
	}
}

// The state of one vertex, and its code.
class Vertex {
	constructor(planes, { at, normal, spread, magnitudes, between }) {
		this.planes = planes;
		this.streams = planes.streams;
		this.models = planes.models;
		this.predicted = at.map(floatOf);
		this.spread = spread;
		const size = sqrt32(dot32(normal, normal));
		const unit = size > 0 ? f(1 / size) : 0;
		this.normal = normal.map((x) => f(x * unit));
		this.left = 0;
		for (const s of xyz) this.left = f(this.left + this.square(s));
		const disagreement = Math.abs(dot32(between.map(f), normal));
		const [m0, , m2] = magnitudes;
		this.reachAcross = f(f(f(m0 * 0.25) + f(f(disagreement * unit) * 2)) + 16);
		this.reachAlong = f(f(m2 * 0.25) + 16);
		this.distance = 0;
		this.q = new Int32Array(3);
	}

	square(s) {
		return f(this.normal[s] * this.normal[s]);
	}

	slope(s) {
		return f(this.normal[s] / f(this.left + f(0.1)));
	}

	learn(s, x) {
		this.q[s] = x;
		this.left = f(this.left - this.square(s));
		this.distance = f(this.distance + f(this.normal[s] * f(f(this.q[s]) - this.predicted[s])));
	}

	// predicted[s] - distance * slope
	moved(s, slope) {
		return f(this.predicted[s] - f(this.distance * slope));
	}

	// ---- Its code

	read(context) {
		this.between = this.streams.token(0, this.models.BETWEEN[context], POSITIONS) & 7;
		const axes = xyz.filter((s) => (this.between >> s) & 1);
		const diagonal = axes.length > 1 ? this.readDiagonalNumber() : 0;
		for (const s of xyz) {
			if (!axes.includes(s)) this.readOnPlane(s);
		}
		if (diagonal !== 0) this.readDiagonal(axes, diagonal);
		else this.readCoordinates(axes);
	}

	readDiagonalNumber() {
		const diagonal = this.streams.token(1, this.models.DIAGONAL[this.between], POSITIONS);
		return diagonal >= 5 ? 0 : diagonal;
	}

	readOnPlane(s) {
		const axis = this.planes.axes[s];
		const x = f(f(this.moved(s, this.slope(s)) - axis.O) * axis.I);
		this.learn(s, axis.coordinate(this.readPlane(s, f(x + 0.5), 0)));
	}

	magnitudes() {
		let sum = 0;
		for (const s of xyz) sum = f(sum + Math.abs(f(f(this.q[s]) - this.predicted[s])));
		const across = Math.trunc(min(f(16 * Math.abs(this.distance)), 2 ** 22));
		return [across, this.between, Math.trunc(min(f(8 * sum), 2 ** 22))];
	}

	readPlane(s, x, kind) {
		const near = floorOf(x);
		const off = f(f(x - near) - 0.5);
		const y = f(f(this.spread[s] + f(this.reachAlong / 16)) * this.planes.axes[s].I);
		const j = Number(y >= 0.25) + Number(y >= 0.5) + Number(y >= 0.75);
		const k = Math.trunc(min(f(Math.abs(off) * 8), 3));
		return (near + readResidual(this.streams, 2, this.models.PLANE[kind][j][k], 0, off < 0 ? 1 : 0)) | 0;
	}

	readCoordinates(axes) {
		const order = axesByNormal(this.normal).filter((s) => axes.includes(s));
		order.forEach((s, i) => {
			const slope = this.slope(s);
			const others = max(f(this.left - this.square(s)), 0);
			const freedom = f(others / f(f(others + this.square(s)) + f(1e-6)));
			const x = this.moved(s, slope);
			const alongScale = f(freedom * f(this.reachAlong + f(2 * this.spread[s])));
			const scale = f(f(this.reachAcross * Math.abs(slope)) + alongScale);
			this.learn(s, this.readNumber(order.length - 1 - i, x, scale));
		});
	}

	readNumber(slot, x, scale) {
		const r = Math.trunc(f(clamp(x, -(2 ** 22), 2 ** 22) * 256)) + 128;
		const u = scale > 0 ? min(scale, 2 ** 22) : 0;
		return ((r >> 8) + readFoldedResidual(this.streams, this.planes.rows, slot, 0, u, r)) | 0;
	}

	readDiagonal(axes, diagonal) {
		const first = axes[0];
		const dir = xyz.map((s) => direction(diagonal, first, s));
		const base = [0, 0, 0];
		let height = -this.distance;
		let rise = 0;
		for (const s of axes) {
			const axis = this.planes.axes[s];
			const p = (this.readPlane(s, f(f(this.predicted[s] - axis.O) * axis.I), 1) + (dir[s] < 0 ? 1 : 0)) | 0;
			base[s] = axis.coordinate(p);
			height = f(height + f(this.normal[s] * f(this.predicted[s] - f(base[s]))));
			rise = f(rise + f(f(this.normal[s] * dir[s]) * axis.D));
		}
		const moved = this.readMove(first, height, f(rise * this.planes.axes[first].I));
		for (const s of axes) {
			const x = s === first ? moved : dir[s] * this.planes.alongDiagonal(first, s, moved) + this.readRest();
			this.learn(s, base[s] + x);
		}
	}

	readMove(first, height, rise) {
		const { D } = this.planes.axes[first];
		const steep = max(Math.abs(rise), 1 / 64);
		const t = steep > 1 / 64 ? clamp(f(height / rise), 0, D) : f(D / 2);
		return this.readNumber(0, t, min(f(this.reachAcross / steep), f(4 * D)));
	}

	readRest() {
		return readResidual(this.streams, 1, this.models.REST, 0, 0);
	}
}
