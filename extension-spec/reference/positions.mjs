// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Positions [A.6].

import { anchorModels } from './anchors.mjs';
import { FOLD, GRID, PALETTE, PLANES, SHEAR, SPLIT } from './attributeheader.mjs';
import { f, move } from './floats.mjs';
import { readTails } from './grids.mjs';
import { isolatedModels, readIsolated } from './isolated.mjs';
import {
	beginComponent, candidatesOf, createMates, findMates, lookedAt, magnitudeOfImage, mirrorModels, readImage, readMirrors,
} from './mirrors.mjs';
import { decodeInOrder } from './order.mjs';
import { codeWithPalettes, paletteModels, readPalettes } from './palettes.mjs';
import { codeWithPlanes, planeModels, readPlanes } from './planes.mjs';
import { contextOfSlot, residualOfSlot } from './positionresiduals.mjs';
import { residualModels } from './positionrows.mjs';
import { bitsOfPosition, readTables, tableModels } from './positiontables.mjs';
import { normalOfFan, predict, sortAxes, vector } from './prediction.mjs';
import { NONE, prev } from './surface.mjs';

const FILE_ORDER = [0, 1, 2];

export const positionModels = () => ({
	tables: tableModels(), ...residualModels(), isolated: isolatedModels(), palettes: paletteModels(),
	planes: planeModels(), mirrors: mirrorModels(), anchors: anchorModels(),
});

// [A.6] The coordinates q of every group, then of every isolated wedge, the sequence of the groups and, with mirrors
// or anchors, their mates.
export function decodePositions(coder, models, gridModels, piece, surface, groups) {
	const attribute = piece.attributes[0];
	const { predictor } = attribute;
	const P = bitsOfPosition(attribute);
	const p = {
		coder, models, piece, surface, predictor, degree: degreesOf(surface, groups.count), q: [], magnitude: [],
		...readTables(coder, models.tables, predictor),
		last: vector(() => 2 ** P / 2), farScale: vector(() => 8 * 2 ** P), nearScale: vector(() => 64),
	};
	const mirrors = piece.MIRRORS ? readMirrors(coder, P) : [];
	if (piece.MIRRORS || piece.ANCHORS) p.mates = createMates(mirrors, groups.count, piece.ANCHORS);
	if (predictor & PALETTE) p.palettes = readPalettes(coder, models.palettes, groups.count, mirrors);
	if (predictor & PLANES) p.planes = readPlanes(coder);
	const sequence = decodeInOrder(surface, piece, groups, {
		codeSeed: (h, neighbour) => codeSeed(p, h, neighbour),
		codeFan: (fan) => codeFan(p, fan),
	});
	for (const q of readIsolated(coder, models.isolated, piece.isolated_count)) p.q.push(q);
	if (attribute.coding === GRID) readTails(coder, gridModels, attribute, p.q);
	return { q: p.q, sequence, mates: p.mates };
}

// [A.6.3] The degrees of all groups.
function degreesOf(surface, groupCount) {
	const degree = new Int32Array(groupCount), boundary = new Uint8Array(groupCount);
	for (let h = 0; h < surface.tail.length; ++h) {
		++degree[surface.tail[h]];
		if (surface.twin[h] === NONE || surface.twin[prev(h)] === NONE) boundary[surface.tail[h]] = 1;
	}
	return degree.map((d, g) => (boundary[g] ? Math.min(12, 2 * d) : d));
}

// [A.6.3]
function codeFan(p, fan) {
	const prediction = predict(p, fan);
	if (p.mates === undefined) return codeFanAlone(p, fan, prediction);
	const axis = () => (p.predictor & SHEAR ? sortAxes([0, 1, 2], normalOfFan(p, fan)) : FILE_ORDER);
	const seen = { v: fan.v, start: fan.fan[0], neighbours: lookedAt(fan), prediction, axis };
	return codeWithMirrors(p, seen, () => codeFanAlone(p, fan, prediction));
}

function codeFanAlone(p, fan, prediction) {
	if (p.predictor & PLANES) return keep(p, fan.v, codeWithPlanes(p, fan, prediction, normalOfFan(p, fan)));
	if (p.predictor & SHEAR) return keep(p, fan.v, codeSheared(p, fan, prediction));
	return keep(p, fan.v, codeUnsheared(p, prediction, contextsOf(p, fan, prediction)));
}

// [A.6.14] A vertex that may be an image; codeAlone() codes one that is not. [A.6.15] `begins`: a component.
function codeWithMirrors(p, { v, start, neighbours, prediction, axis, begins }, codeAlone) {
	const { step, fraction } = prediction;
	const expected = vector((s) => (step[s] + ((fraction[s] + 128) >> 8)) | 0);
	const image = readImage(p, candidatesOf(p, neighbours, expected));
	if (image === undefined) codeAlone();
	else keep(p, v, { q: image.q, magnitude: magnitudeOfImage(image.q, expected, axis()) });
	p.mates.start[v] = start;
	findMates(p, v, begins && p.mates.hasAnchors ? beginComponent(p, v) : image?.candidate);
}

function keep(p, g, { q, magnitude }) {
	p.q[g] = q;
	p.magnitude[g] = magnitude;
}

// The scale and set of each slot.
function contextsOf(p, fan, { magnitudes, spread, third }) {
	const coefficients = p.coefficients[fan.plain ? 1 : 0], split = (p.predictor & SPLIT) !== 0;
	return coefficients.map((c, k) => contextOfSlot(c, magnitudes[k], spread[k], third[k], split));
}

const codeUnsheared = (p, prediction, contexts) =>
	(p.predictor & PALETTE ? codeWithPalettes(p, prediction, contexts) : codePlain(p, prediction, contexts));

const absolute = (residuals) => residuals.map(Math.abs);

// [A.6.3]
function codePlain(p, { step, fraction }, contexts) {
	const residuals = vector((s) => residualOfSlot(p, s, contexts[s], fraction[s]));
	const q = vector((s) => (step[s] + ((fraction[s] + 128) >> 8) + residuals[s]) | 0);
	return { q, magnitude: absolute(residuals) };
}

// [A.6.10]
function codeSheared(p, fan, prediction) {
	const normal = normalOfFan(p, fan), axis = sortAxes([0, 1, 2], normal);
	const bySlot = (v) => axis.map((s) => v[s]);
	const [step, fraction, spread, third] =
		[prediction.step, prediction.fraction, prediction.spread, prediction.third].map(bySlot);
	const contexts = contextsOf(p, fan, { magnitudes: prediction.magnitudes, spread, third });
	const shiftOf = shearOf(bySlot(normal), (p.predictor & FOLD) !== 0);
	const q = [], residuals = [], deviations = [];
	for (let k = 0; k < 3; ++k) {
		const predicted = step[k] + ((fraction[k] + 128 + shiftOf(k, deviations)) >> 8);
		residuals.push(residualOfSlot(p, k, contexts[k], fraction[k]));
		const value = (predicted + residuals[k]) | 0;
		q[axis[k]] = value;
		deviations.push(f(f((value - step[k]) | 0) - f(f(fraction[k]) / 256)));
	}
	return { q, magnitude: absolute(residuals) };
}

// [A.6.10] The shift of slot k by the deviations of the slots before; the normal is in the order of the slots.
function shearOf(normal, fold) {
	const largest = normal[2], inverse = f(1 / (largest === 0 ? 1 : largest));
	const t0 = f(normal[0] * inverse), t1 = f(normal[1] * inverse);
	const c20 = f(-256 * t0), c21 = f(-256 * t1), c10 = f(-256 * f(f(t0 * t1) / f(f(t1 * t1) + 1)));
	return (k, deviation) => {
		if (k === 0) return 0;
		const x = k === 1 ? f(c10 * deviation[0]) : f(f(c20 * deviation[0]) + f(c21 * deviation[1]));
		return fold ? (move(x) + 128) & ~255 : move(x);
	};
}

// [A.6.8]
function codeSeed(p, h, neighbour) {
	const g = p.surface.tail[h];
	if (p.mates === undefined) return codeSeedAlone(p, g, neighbour);
	// Without a neighbour there are no candidates, and what is expected has no effect.
	const neighbours = neighbour === NONE ? [] : [neighbour];
	const prediction = { step: neighbour === NONE ? [0, 0, 0] : p.q[neighbour], fraction: [0, 0, 0] };
	const seen = { v: g, start: h, neighbours, prediction, axis: () => FILE_ORDER, begins: neighbour === NONE };
	return codeWithMirrors(p, seen, () => codeSeedAlone(p, g, neighbour));
}

function codeSeedAlone(p, g, neighbour) {
	const alone = neighbour === NONE, scales = alone ? p.farScale : p.nearScale, zero = [0, 0, 0];
	const step = alone ? p.last.slice() : p.q[neighbour].slice();
	const prediction = { step, fraction: zero.slice(), spread: zero, third: zero, magnitudes: zero };
	const result = p.predictor & PLANES
		? codeWithPlanes(p, undefined, prediction, zero)
		: codeUnsheared(p, prediction, scales.map((x) => ({ scale: f(x), set: 0 })));
	if (!(p.predictor & PLANES)) adaptScales(p, scales, result.magnitude, alone);
	if (alone) p.last = result.q.slice();
	keep(p, g, result);
}

// [A.6.8] The scales stay below 2^32.
function adaptScales(p, scales, magnitude, alone) {
	for (let s = 0; s < 3; ++s) {
		scales[s] = Math.floor((scales[s] + 16 * Math.min(magnitude[s], 2 ** 24)) / 2);
		if (alone) magnitude[s] = Math.floor(p.nearScale[s] / 16);
	}
}
