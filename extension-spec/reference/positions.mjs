// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Positions: A.6 of the specification.

import { fail } from './bytes.mjs';
import { golombs, models } from './entropy.mjs';
import { BelowGrid, TailModels } from './grids.mjs';
import { decodeIsolated, IsolatedModels } from './isolated.mjs';
import { NONE } from './mesh.mjs';
import { BYTES_OF_TYPE, EXACT_FLOAT, GRID, INTEGER } from './names.mjs';
import { PaletteModels, readPalettes } from './palettes.mjs';
import { Planes, PlanesModels } from './planes.mjs';
import { axesByNormal, movement, Prediction, universalWeights, zeroWeights } from './prediction.mjs';
import { Region } from './region.mjs';
import { PositionRows, readFoldedResidual, readScaledResidual } from './residuals.mjs';
import { f } from './vectors.mjs';

// [A.6.6] The coefficients U[weighted][shear][plain fan][slot]
const U = [
	[
		[[[196, 12, 1662], [216, 12, 1638], [208, 13, 1749]], [[138, 155, 1222, 52], [143, 158, 1186, 52], [140, 151, 1299, 52]]],
		[[[183, 9, 1774], [170, 13, 1780], [147, 17, 1437]], [[112, 154, 1364, 49], [110, 155, 1382, 49], [140, 65, 1151, 7]]],
	],
	[
		[[[200, 17, 1672], [207, 19, 1672], [188, 18, 1766]], [[136, 90, 1207, 25], [142, 93, 1185, 25], [136, 91, 1292, 25]]],
		[[[169, 13, 1818], [160, 16, 1786], [157, 14, 1446]], [[113, 87, 1386, 21], [108, 91, 1378, 24], [123, 49, 1121, 6]]],
	],
];
const COEFFICIENT_LIMIT = 65535;

// What belongs to the payload: models, fitted weights and changes of coefficients.
export class PositionModels {
	constructor() {
		this.PRESENT = models([]);
		this.WEIGHT = golombs([]);
		this.SELECTING_WEIGHT = golombs([]);
		this.COEFFICIENT = golombs([4]);
		this.rows = new PositionRows();
		this.palettes = new PaletteModels();
		this.planes = new PlanesModels();
		this.isolated = new IsolatedModels();
		this.below = new TailModels();
		this.weights = zeroWeights();
		this.weightsWereRead = false;
		this.selectingWeightsWereRead = false;
		this.changes = models([2, 3, 4], () => 0);
		this.changesWereRead = false;
	}
}

// ---- [A.6.2] Parameters and tables

// The predictor byte
function parameters(byte) {
	const bit = (i) => ((byte >> i) & 1) === 1;
	return {
		weighted: bit(0),
		select: bit(1),
		shear: bit(2),
		palette: bit(3),
		planes: bit(4),
		fold: bit(5),
		ownScale: bit(6),
		split: bit(7),
	};
}

// P
function bitsOfCoordinates(attribute) {
	if (attribute.coding === INTEGER) return Math.min(8 * BYTES_OF_TYPE[attribute.type], 26);
	if (attribute.coding === EXACT_FLOAT) return 26;
	return Math.min(attribute.bits, 26);
}

function readTables(streams, m, { weighted, select, ownScale }, coefficients) {
	if (weighted) {
		if (!m.weightsWereRead) {
			for (let c = 0; c <= 12; ++c) readWeights(streams, m, c, m.WEIGHT);
			m.weightsWereRead = true;
		}
		if (select && !m.selectingWeightsWereRead) {
			for (let c = 13; c <= 21; ++c) readWeights(streams, m, c, m.SELECTING_WEIGHT);
			m.selectingWeightsWereRead = true;
		}
	}
	return ownScale ? changedCoefficients(streams, m, coefficients) : coefficients;
}

function readWeights(streams, m, c, model) {
	if (!streams.bit(m.PRESENT)) return;
	m.weights[c] = universalWeights()[c].map((universal) => {
		const w = universal + streams.signedGolomb(model);
		if (w < -1023 || w > 1023) fail('BadAttribute', 'A.6.2', 'a weight out of range');
		return w;
	});
}

function changedCoefficients(streams, m, coefficients) {
	const mustRead = !m.changesWereRead;
	m.changesWereRead = true;
	return coefficients.map((ofFan, fan) => ofFan.map((ofSlot, slot) => ofSlot.map((u, i) => {
		if (mustRead) m.changes[fan][slot][i] = streams.signedGolomb(m.COEFFICIENT[i]);
		const scale = u + m.changes[fan][slot][i];
		if (scale < 0 || scale > COEFFICIENT_LIMIT) fail('BadAttribute', 'A.6.2', 'a coefficient out of range');
		return scale;
	})));
}

// ---- [A.6.3] What is kept of a vertex: groups, and isolated vertices after them

class Records {
	constructor(surface, groupCount, count) {
		this.count = count;
		this.q = new Int32Array(3 * count);
		this.magnitude = new Uint32Array(3 * count);
		this.degree = degreesOf(surface, groupCount);
	}
}

function degreesOf(surface, groupCount) {
	const degree = new Uint32Array(groupCount);
	const onBoundary = new Uint8Array(groupCount);
	for (let h = 0; h < surface.halfEdgeCount; ++h) {
		++degree[surface.tail(h)];
		if (surface.twin(h) !== NONE) continue;
		onBoundary[surface.tail(h)] = 1;
		onBoundary[surface.head(h)] = 1;
	}
	return degree.map((d, v) => (onBoundary[v] ? Math.min(12, 2 * d) : d));
}

// ---- The stage

class Positions {
	constructor(streams, m, piece, groups, groupCount) {
		const { surface } = groups;
		const attribute = piece.attributes[0];
		this.streams = streams;
		this.models = m;
		Object.assign(this, parameters(attribute.predictor));
		this.attribute = attribute;
		this.P = bitsOfCoordinates(attribute);
		this.groupCount = groupCount;
		this.records = new Records(surface, groupCount, groupCount + piece.isolatedCount);
		this.region = new Region(surface, groupCount, groups, this);
		this.seeds = newSeeds(this.P);
		this.prepare(surface, groupCount);
	}

	prepare(surface, groupCount) {
		const { streams, models: m } = this;
		this.coefficients = readTables(streams, m, this, U[this.weighted ? 1 : 0][this.shear ? 1 : 0]);
		const weights = this.weighted ? m.weights : zeroWeights();
		this.prediction = new Prediction(surface, this.region, this.records, this.select, weights);
		if (this.palette) this.palettes = readPalettes(streams, m.palettes, groupCount);
		if (this.planes) this.plane = new Planes(streams, m.planes, m.rows, this.records);
	}

	decode() {
		const sequence = this.region.order();
		this.records.q.set(decodeIsolated(this.streams, this.models.isolated, this.records.count - this.groupCount), 3 * this.groupCount);
		if (this.attribute.coding === GRID) this.readBelowGrid();
		return { sequence, positions: this.records.q };
	}

	// [A.10.5]
	readBelowGrid() {
		const below = new BelowGrid(this.streams, this.attribute, this.models.below);
		this.records.q = this.records.q.map((q, i) => below.read(q, i % 3));
	}

	// ---- [A.6.3] One vertex

	codeFan(fan) {
		const predicted = this.prediction.predict(fan);
		if (this.planes) {
			this.plane.codeFan(fan, predicted, this.prediction.normal(fan));
			return;
		}
		const slots = this.scalesAndSets(fan, predicted);
		if (this.palette) this.codePalette(fan.v, predicted.at, slots);
		else if (this.shear) this.codeSheared(fan, predicted, slots);
		else this.codePlain(fan.v, predicted.at, slots);
	}

	// The order of the components by slot, and [A.6.6] the scale and set of each slot.
	scalesAndSets(fan, predicted) {
		const normal = this.shear ? this.prediction.normal(fan) : [0, 0, 0];
		const axis = axesByNormal(normal);
		const coefficients = this.coefficients[fan.plain ? 1 : 0];
		const inOrder = (list) => axis.map((s) => list[s]);
		return { normal, axis, ...this.scalesOf(coefficients, predicted.magnitudes, inOrder(predicted.spread), inOrder(predicted.third)) };
	}

	// [A.6.6]
	scalesOf(coefficients, magnitudes, spread, third) {
		const scale = [];
		const set = [];
		for (let k = 0; k < 3; ++k) {
			const [c0, c1, c2, c3 = 0] = coefficients[k].map((c) => c / 64);
			const N = f(c0 * magnitudes[k]);
			const S = f(f(c1 * spread[k]) + f(c3 * third[k]));
			scale.push(f(f(N + S) + c2));
			set.push(this.split ? Number(S > 2 * N) + 2 * Number(N > 2 * S) : 0);
		}
		return { scale, set };
	}

	// [A.6.6] `fraction` is that of the prediction.
	readResidual(slot, set, scale, fraction) {
		const { rows } = this.models;
		if (this.fold) return readFoldedResidual(this.streams, rows, slot, set, scale, fraction + 128);
		return readScaledResidual(this.streams, slot, rows.ROW[slot][set], scale);
	}

	// The coordinate of slot k, which is component s; `shift` is what normal shear adds.
	codeComponent(v, s, k, { step, fraction }, shift, scale, set) {
		const { records } = this;
		const residual = this.readResidual(k, set, scale, fraction);
		records.q[3 * v + s] = step + ((fraction + 128 + shift) >> 8) + residual;
		records.magnitude[3 * v + k] = Math.abs(residual);
	}

	codePlain(v, at, { scale, set }) {
		for (let s = 0; s < 3; ++s) this.codeComponent(v, s, s, at[s], 0, scale[s], set[s]);
	}

	// [A.6.10] Normal shear
	codeSheared(fan, predicted, { normal, axis, scale, set }) {
		const { q } = this.records;
		const { c10, c20, c21 } = shearOf(normal, axis);
		const at = axis.map((s) => predicted.at[s]);
		const deviation = (k) => f(f((q[3 * fan.v + axis[k]] - at[k].step) | 0) - f(f(at[k].fraction) / 256));
		const shifts = [
			() => 0,
			() => movement(f(c10 * deviation(0))),
			() => movement(f(f(c20 * deviation(0)) + f(c21 * deviation(1)))),
		];
		for (let k = 0; k < 3; ++k) {
			const shift = this.fold ? (shifts[k]() + 128) & ~255 : shifts[k]();
			this.codeComponent(fan.v, axis[k], k, at[k], shift, scale[k], set[k]);
		}
	}

	// [A.6.11] A vertex with palettes
	codePalette(v, at, { scale, set }) {
		const { records } = this;
		for (let s = 0; s < 3; ++s) {
			const palette = this.palettes[s];
			const from = at[s].step + ((at[s].fraction + 128) >> 8);
			const ranked = palette === undefined ? { at: at[s], scale: scale[s] } : palette.ranked(at[s], scale[s]);
			const { step, fraction } = ranked.at;
			const rank = (step + ((fraction + 128) >> 8) + this.readResidual(s, set[s], ranked.scale, fraction)) | 0;
			const q = palette === undefined ? rank : palette.valueOf(rank);
			records.q[3 * v + s] = q;
			records.magnitude[3 * v + s] = Math.abs((q - from) | 0);
		}
	}

	// ---- [A.6.8] Seeds

	codeSeed(v, neighbour) {
		const { seeds, records } = this;
		const from = neighbour === NONE ? seeds.last : [...records.q.subarray(3 * neighbour, 3 * neighbour + 3)];
		const at = from.map((step) => ({ step, fraction: 0 }));
		if (this.planes) {
			this.plane.codeSeed(v, at);
		} else {
			const scales = neighbour === NONE ? seeds.far : seeds.near;
			const slots = { scale: scales.map(f), set: [0, 0, 0] };
			if (this.palette) this.codePalette(v, at, slots);
			else this.codePlain(v, at, slots);
			this.learnSeed(v, scales);
		}
		if (neighbour === NONE) this.noteLast(v);
	}

	learnSeed(v, scales) {
		for (let s = 0; s < 3; ++s) {
			scales[s] = Math.floor((scales[s] + 16 * Math.min(this.records.magnitude[3 * v + s], 2 ** 24)) / 2);
		}
	}

	noteLast(v) {
		const { seeds, records } = this;
		for (let s = 0; s < 3; ++s) {
			seeds.last[s] = records.q[3 * v + s];
			if (!this.planes) records.magnitude[3 * v + s] = Math.floor(seeds.near[s] / 16);
		}
	}
}

// [A.6.8]
function newSeeds(P) {
	return {
		last: [0, 1, 2].map(() => 2 ** P / 2),
		far: [0, 1, 2].map(() => 8 * 2 ** P),
		near: [0, 1, 2].map(() => 64),
	};
}

// [A.6.10]
function shearOf(normal, axis) {
	const largest = normal[axis[2]];
	const inverse = f(1 / (largest === 0 ? 1 : largest));
	const t0 = f(normal[axis[0]] * inverse);
	const t1 = f(normal[axis[1]] * inverse);
	return { c20: -256 * t0, c21: -256 * t1, c10: -256 * f(f(t0 * t1) / f(f(t1 * t1) + 1)) };
}

// The positions of all groups and isolated wedges, and the half-edges by which the groups were entered, in their order.
export function decodePositions(streams, m, piece, groups, groupCount) {
	return new Positions(streams, m, piece, groups, groupCount).decode();
}
